//! The faces at every edge of any mesh.

use mesh_core::{Faces, HalfedgeId, TriMesh, VertexId};
use rayon::prelude::*;

/// One side of an edge: the edge as (lower, higher) vertex, and the halfedge of a face along it.
pub(crate) type Side = ([VertexId; 2], HalfedgeId);

/// An edge, lower vertex first.
pub(crate) fn edge(a: VertexId, b: VertexId) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

/// All sides in order of their edges. Faces that use a vertex twice have none.
pub(crate) fn sides(mesh: &TriMesh) -> Vec<Side> {
    let of = |f: mesh_core::FaceId| {
        let [a, b, c] = mesh.corners(f);
        let distinct = a != b && b != c && c != a;
        let sides = [
            (edge(a, b), HalfedgeId::new(f, 0)),
            (edge(b, c), HalfedgeId::new(f, 1)),
            (edge(c, a), HalfedgeId::new(f, 2)),
        ];
        sides.into_iter().filter(move |_| distinct)
    };
    let mut all: Vec<Side> = mesh.face_ids().flat_map(of).collect();
    all.par_sort_unstable();
    all
}

/// The sides of one edge.
pub(crate) fn around(sides: &[Side], edge: [VertexId; 2]) -> &[Side] {
    let start = sides.partition_point(|s| s.0 < edge);
    let end = start + sides[start..].partition_point(|s| s.0 == edge);
    &sides[start..end]
}

/// The sides of edges with one face.
pub(crate) fn boundary(sides: &[Side]) -> Vec<Side> {
    sides.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0]).collect()
}
