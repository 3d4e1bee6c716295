//! What every step returns.

use mesh_core::{FaceId, FaceOrigin, Faces, Origins, TriMesh};

/// A mesh after one step of repair.
#[derive(Clone, Debug, PartialEq)]
pub struct Mended {
    /// The mesh.
    pub mesh: TriMesh,
    /// Where its vertices and faces came from; part 0 is the mesh before the step.
    pub origins: Origins,
    /// How many defects were mended; each step says what it counts.
    pub count: usize,
}

impl Mended {
    /// The mesh as it was.
    pub(crate) fn unchanged(mesh: &TriMesh) -> Self {
        Self { mesh: mesh.clone(), origins: Origins::identity(0, mesh.vertex_count(), mesh.face_count()), count: 0 }
    }

    /// The faces for which `keep` says so, on all vertices. Counts those that went.
    pub(crate) fn kept(mesh: &TriMesh, keep: impl Fn(FaceId) -> bool) -> Self {
        let kept: Vec<FaceId> = mesh.face_ids().filter(|&f| keep(f)).collect();
        let count = mesh.face_count() - kept.len();
        let origins = Origins {
            faces: kept.iter().map(|&face| FaceOrigin::Input { part: 0, face }).collect::<Vec<_>>().into(),
            ..Origins::identity(0, mesh.vertex_count(), 0)
        };
        let faces = kept.into_iter().map(|f| mesh.corners(f)).collect();
        Self { mesh: TriMesh { positions: mesh.positions.clone(), faces }, origins, count }
    }
}
