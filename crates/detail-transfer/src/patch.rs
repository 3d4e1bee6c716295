//! A region and what lies around it, as a mesh of its own.

use crate::Error;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, Faces, FloodParams, HalfedgeId, Seed, Source, SurfacePoint, TriMesh,
    VertexId, flood,
};
use mesh_operators::Submesh;

/// Some faces of a mesh, with their own numbers.
pub(crate) struct Patch {
    pub mesh: Connected<TriMesh>,
    /// The vertices' and faces' names in the mesh, ascending.
    pub vertices: Vec<VertexId>,
    pub faces: Vec<FaceId>,
    /// Faces of the region itself.
    pub inside: Vec<bool>,
    /// Vertices on the patch's boundary.
    pub rim: Vec<bool>,
}

/// The region `inside` and all within `margin` of it, over the surface.
pub(crate) fn patch(
    mesh: &Connected<TriMesh>,
    inside: &FaceMap<bool>,
    margin: f64,
    which: &'static str,
) -> Result<Patch, Error> {
    let region = |f: FaceId| inside.get(f) == Some(&true);
    if !mesh.face_ids().any(region) {
        return Err(Error::Empty { which });
    }
    let mut taken: FaceMap<bool> = mesh.face_ids().map(region).collect::<Vec<_>>().into();
    let start = |v: VertexId| Seed { source: Source::At(SurfacePoint::Vertex(v)), distance: 0.0 };
    let seeds: Vec<Seed> = mesh
        .vertex_ids()
        .filter(|&v| mesh.ring(v).any(|h| taken[h.face()]) && mesh.ring(v).any(|h| !taken[h.face()]))
        .map(start)
        .collect();
    let around = flood(mesh, &seeds, &FloodParams { max_distance: margin, ..FloodParams::default() });
    for f in around.faces() {
        taken[f] = true;
    }
    unpinch(mesh, &mut taken);
    let Submesh { mesh: own, vertices, faces } = Submesh::new(mesh, |f| taken[f]);
    for (&v, &at) in vertices.iter().zip(&own.positions) {
        if !at.is_finite() || at.abs().max_element() > 1e100 {
            return Err(Error::NotFinite { vertex: v, at });
        }
    }
    let at = own.positions[0];
    // Faces of a manifold with all pinches filled are a manifold.
    let own = Connected::new(own).map_err(|_| Error::Singular { at })?;
    let rim = own.vertex_ids().map(|v| own.outgoing(v).is_none_or(|h| own.twin(h).is_none())).collect();
    let inside = faces.iter().map(|&f| region(f)).collect();
    Ok(Patch { mesh: own, vertices, faces, inside, rim })
}

/// Adds all faces around vertices where the taken ones form more than one fan.
fn unpinch(mesh: &Connected<TriMesh>, taken: &mut FaceMap<bool>) {
    let fans = |taken: &FaceMap<bool>, v: VertexId| {
        let begins = |h: &HalfedgeId| taken[h.face()] && mesh.twin(*h).is_none_or(|t| !taken[t.face()]);
        mesh.ring(v).filter(begins).count()
    };
    let mut suspects: Vec<VertexId> = mesh.vertex_ids().collect();
    while !suspects.is_empty() {
        let pinched: Vec<VertexId> = suspects.into_iter().filter(|&v| fans(taken, v) > 1).collect();
        suspects = vec![];
        for &v in &pinched {
            for h in mesh.ring(v).filter(|h| !taken[h.face()]).collect::<Vec<_>>() {
                taken[h.face()] = true;
                suspects.extend(mesh.corners(h.face()));
            }
        }
        suspects.sort_unstable();
        suspects.dedup();
    }
}
