//! The parts into which embedded curves divide a mesh.

use mesh_core::{Adjacency, FaceId, FaceMap, HalfedgeId, VertexId};

/// The edges of a chain of vertices, in order.
pub fn curve_edges(chain: &[VertexId], closed: bool) -> impl Iterator<Item = [VertexId; 2]> + '_ {
    let back = (closed && chain.len() > 1).then(|| [chain[chain.len() - 1], chain[0]]);
    chain.windows(2).map(|w| [w[0], w[1]]).chain(back)
}

/// The faces that lie left of a chain's edges, seen from outside, in order: one per edge, none where the mesh ends.
pub fn faces_left_of<M: Adjacency>(mesh: &M, chain: &[VertexId], closed: bool) -> Vec<FaceId> {
    curve_edges(chain, closed).filter_map(|[a, b]| halfedge(mesh, a, b)).map(HalfedgeId::face).collect()
}

/// All faces reached from `seeds` without crossing a barrier edge. Barriers that are not edges of the mesh and seeds beyond its
/// last face are passed over. Cost ∝ faces reached, plus one byte per face.
pub fn flood<M: Adjacency>(
    mesh: &M,
    barriers: impl IntoIterator<Item = [VertexId; 2]>,
    seeds: &[FaceId],
) -> FaceMap<bool> {
    let mut walls: Vec<_> = barriers
        .into_iter()
        .filter_map(|[a, b]| halfedge(mesh, a, b).or_else(|| halfedge(mesh, b, a)))
        .map(|h| mesh.edge(h))
        .collect();
    walls.sort_unstable();
    let mut reached = FaceMap::filled(mesh.face_count(), false);
    let mut stack: Vec<FaceId> = vec![];
    for &seed in seeds.iter().filter(|f| f.index() < mesh.face_count()) {
        stack.push(seed);
        while let Some(f) = stack.pop() {
            if std::mem::replace(&mut reached[f], true) {
                continue;
            }
            for h in f.halfedges() {
                if let Some(t) = mesh.twin(h)
                    && !reached[t.face()]
                    && walls.binary_search(&mesh.edge(h)).is_err()
                {
                    stack.push(t.face());
                }
            }
        }
    }
    reached
}

/// The halfedge from `a` to `b`, also where the mesh has no such vertices.
fn halfedge<M: Adjacency>(mesh: &M, a: VertexId, b: VertexId) -> Option<HalfedgeId> {
    if a.index() < mesh.vertex_count() { mesh.halfedge(a, b) } else { None }
}
