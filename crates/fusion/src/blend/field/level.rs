//! The closed curves on a mesh where a scalar on a refined copy of it changes sign.

use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, SurfacePoint, TriMesh, VertexOrigin,
};
use tri_intersect::SurfaceCurve;

/// The curves, as points of the mesh that `origins` speaks of, with the negative side on the right. They cannot meet.
pub(crate) fn level_curves<M: Faces>(
    mesh: &M,
    fine: &Connected<TriMesh>,
    origins: &Origins,
    value: &[f64],
) -> Vec<SurfaceCurve> {
    let negative = |v: mesh_core::VertexId| value[v.index()] < 0.0;
    // A curve leaves a face through the side that runs from inside to outside.
    let leaves = |h: HalfedgeId| negative(fine.tail(h)) && !negative(fine.head(h));
    let mut seen = vec![false; 3 * fine.face_count()];
    let mut curves = vec![];
    for start in (0..3 * fine.face_count() as u32).map(HalfedgeId) {
        if seen[start.index()] || !leaves(start) {
            continue;
        }
        let (mut points, mut h) = (vec![], start);
        while !std::mem::replace(&mut seen[h.index()], true) {
            points.push(on_parent(mesh, fine, origins, h, crossing(value, fine, h)));
            // The neighbour is entered here and left through one of its other two sides.
            let Some(t) = fine.twin(h) else { break };
            let Some(out) = [t.next(), t.prev()].into_iter().find(|&s| leaves(s)) else { break };
            h = out;
        }
        curves.push(SurfaceCurve { points, closed: true });
    }
    curves
}

/// Where along `h` the scalar vanishes; away from the ends, so that no two crossings coincide.
fn crossing(value: &[f64], fine: &Connected<TriMesh>, h: HalfedgeId) -> f64 {
    let (a, b) = (value[fine.tail(h).index()], value[fine.head(h).index()]);
    if b.is_finite() { (a / (a - b)).clamp(0.02, 0.98) } else { 0.5 }
}

/// The point at `t` along an edge of the refined mesh, by its address in the mesh itself.
fn on_parent<M: Faces>(mesh: &M, fine: &Connected<TriMesh>, origins: &Origins, h: HalfedgeId, t: f64) -> SurfacePoint {
    let (FaceOrigin::Input { face, .. } | FaceOrigin::Piece { face, .. }) = origins.faces[h.face()] else {
        return SurfacePoint::Edge { halfedge: h, t };
    };
    let corners = mesh.corners(face);
    let [a, b] = [fine.tail(h), fine.head(h)].map(|v| weights(origins.vertices[v], corners));
    let w = [0, 1, 2].map(|k| (1.0 - t) * a[k] + t * b[k]);
    address(face, w)
}

fn address(face: FaceId, w: [f64; 3]) -> SurfacePoint {
    match w.iter().position(|&x| x == 0.0) {
        Some(k) => {
            let halfedge = HalfedgeId::new(face, (k + 1) % 3);
            SurfacePoint::Edge { halfedge, t: w[(k + 2) % 3] / (w[(k + 1) % 3] + w[(k + 2) % 3]) }
        }
        None => SurfacePoint::Face { face, barycentric: w },
    }
}

/// Barycentric coordinates, in the face with these corners, of a vertex on it.
fn weights(origin: VertexOrigin, corners: [mesh_core::VertexId; 3]) -> [f64; 3] {
    let at = |v: mesh_core::VertexId, w: f64| corners.map(|c| if c == v { w } else { 0.0 });
    match origin {
        VertexOrigin::Input { vertex, .. } => at(vertex, 1.0),
        VertexOrigin::Edge { ends, t, .. } => {
            let (a, b) = (at(ends[0], 1.0 - t), at(ends[1], t));
            [0, 1, 2].map(|k| a[k] + b[k])
        }
        VertexOrigin::Face { barycentric, .. } => barycentric,
        VertexOrigin::New { .. } => [1.0 / 3.0; 3],
    }
}
