//! Faces that are no triangles, and vertices that no face uses.

use crate::mended::Mended;
use mesh_core::{Faces, Origins, TriMesh, VertexId, VertexOrigin};

/// Drops faces that name a missing vertex or one vertex twice, or have a corner that is no point in space. Counts them. O(n).
///
/// ```
/// use glam::DVec3;
/// use mesh_core::TriMesh;
/// let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NAN];
/// let soup = TriMesh::from_arrays(points, [[0, 1, 2], [0, 1, 9], [0, 0, 1], [0, 1, 3]]);
/// assert_eq!(mesh_repair::drop_unusable(&soup).count, 3);
/// ```
pub fn drop_unusable(mesh: &TriMesh) -> Mended {
    let sound = |v: &VertexId| mesh.positions.get(v.index()).is_some_and(|p| p.is_finite());
    Mended::kept(mesh, |f| {
        let [a, b, c] = mesh.corners(f);
        a != b && b != c && c != a && [a, b, c].iter().all(sound)
    })
}

/// Drops vertices that no face uses. Counts them. O(n).
pub fn drop_unused_vertices(mesh: &TriMesh) -> Mended {
    let mut used = vec![false; mesh.vertex_count()];
    for v in mesh.faces.iter().flatten() {
        if let Some(used) = used.get_mut(v.index()) {
            *used = true;
        }
    }
    let kept: Vec<VertexId> = mesh.vertex_ids().filter(|v| used[v.index()]).collect();
    let mut names = vec![VertexId(u32::MAX); mesh.vertex_count()];
    kept.iter().enumerate().for_each(|(name, v)| names[v.index()] = VertexId::from(name));
    // A missing vertex stays missing.
    let name = |v: VertexId| names.get(v.index()).copied().unwrap_or(VertexId(u32::MAX));
    let origins = Origins {
        vertices: kept.iter().map(|&vertex| VertexOrigin::Input { part: 0, vertex }).collect::<Vec<_>>().into(),
        ..Origins::identity(0, 0, mesh.face_count())
    };
    Mended {
        count: mesh.vertex_count() - kept.len(),
        mesh: TriMesh {
            positions: kept.iter().map(|v| mesh.positions[v.index()]).collect(),
            faces: mesh.faces.iter().map(|f| f.map(name)).collect(),
        },
        origins,
    }
}
