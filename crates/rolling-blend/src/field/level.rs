//! The closed curves on a mesh where a scalar on a refined copy of it changes sign.

use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, Positions, SurfacePoint, TriMesh, VertexId,
};
use tri_intersect::SurfaceCurve;

/// The curves, as points of the mesh that `origins` speaks of, with the negative side on the right. They cannot meet.
pub(crate) fn level_curves<M: Faces + Positions>(
    mesh: &M,
    fine: &Connected<TriMesh>,
    origins: &Origins,
    value: &[f64],
    window: f64,
) -> Vec<SurfaceCurve> {
    let negative = |v: VertexId| value[v.index()] < 0.0;
    // A curve leaves a face through the side that runs from inside to outside.
    let leaves = |h: HalfedgeId| negative(fine.tail(h)) && !negative(fine.head(h));
    let mut seen = vec![false; 3 * fine.face_count()];
    let mut curves = vec![];
    for start in fine.halfedge_ids() {
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
        let points = thinned(mesh, smoothed(mesh, &points, window), 0.4 * window);
        curves.push(SurfaceCurve { points, closed: true });
    }
    curves
}

/// The points drawn towards the mean of the curve over `window` to both sides, each within its face or edge: the scalar
/// is linear on triangles of any shape, so its level sets zigzag where they pass close by vertices.
fn smoothed<M: Faces + Positions>(mesh: &M, points: &[SurfacePoint], window: f64) -> Vec<SurfacePoint> {
    let n = points.len();
    let places: Vec<DVec3> = points.iter().map(|p| p.position(mesh)).collect();
    let lengths: Vec<f64> = (0..n).map(|i| places[i].distance(places[(i + 1) % n])).collect();
    let mean = |i: usize| {
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        let mut add = |j: usize, away: f64| {
            let fade = 1.0 - (away / window).powi(2);
            let share = fade * fade * (lengths[j] + lengths[(j + n - 1) % n]);
            sum += share * places[j];
            total += share;
        };
        add(i, 0.0);
        for forwards in [true, false] {
            let (mut away, mut j) = (0.0, i);
            for _ in 1..n / 2 {
                let next = if forwards { (j + 1) % n } else { (j + n - 1) % n };
                away += lengths[if forwards { j } else { next }];
                if away >= window {
                    break;
                }
                add(next, away);
                j = next;
            }
        }
        if total > 0.0 { sum / total } else { places[i] }
    };
    (0..n).map(|i| moved(mesh, points[i], mean(i) - places[i])).collect()
}

/// A point of an edge or face moved within it, as near to where `by` leads as it gets.
fn moved<M: Faces + Positions>(mesh: &M, point: SurfacePoint, by: DVec3) -> SurfacePoint {
    const MARGIN: f64 = 0.02;
    match point {
        SurfacePoint::Edge { halfedge, t } => {
            let [a, b] = [0, 1].map(|k| mesh.position(mesh.corners(halfedge.face())[(halfedge.corner() + k) % 3]));
            let along = by.dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
            SurfacePoint::Edge { halfedge, t: (t + along).clamp(MARGIN.min(t), (1.0 - MARGIN).max(t)) }
        }
        SurfacePoint::Face { face, barycentric } => {
            let [a, b, c] = mesh.triangle(face);
            let normal = (b - a).cross(c - a);
            let area = normal.length_squared().max(f64::MIN_POSITIVE);
            // Side k of these runs from one to the next, opposite corner k.
            let change = [b, c, a];
            let step = [0, 1, 2].map(|k| normal.cross(change[(k + 1) % 3] - change[k]).dot(by) / area);
            // Only as far as the face reaches.
            let mut share = 1.0f64;
            for k in 0..3 {
                let least = (0.5 * barycentric[k]).min(MARGIN);
                if barycentric[k] + step[k] < least {
                    share = share.min((barycentric[k] - least) / -step[k]);
                }
            }
            SurfacePoint::Face { face, barycentric: [0, 1, 2].map(|k| barycentric[k] + share * step[k]) }
        }
        vertex @ SurfacePoint::Vertex(_) => vertex,
    }
}

/// Without points within faces that are nearer than `spacing` to the one before: edges must be crossed, faces need not be
/// marked.
fn thinned<M: Faces + Positions>(mesh: &M, points: Vec<SurfacePoint>, spacing: f64) -> Vec<SurfacePoint> {
    let n = points.len();
    let mut kept: Vec<SurfacePoint> = Vec::with_capacity(n);
    let mut last: Option<DVec3> = None;
    for (i, &point) in points.iter().enumerate() {
        let place = point.position(mesh);
        let next = points[(i + 1) % n].position(mesh);
        let crowded = last.is_some_and(|l| l.distance(place) < spacing)
            || matches!(points[(i + 1) % n], SurfacePoint::Edge { .. }) && next.distance(place) < spacing;
        // Between two crossings of one edge the curve must not lie on it.
        let turns = edge_of(mesh, kept.last()).is_some_and(|e| edge_of(mesh, points.get(i + 1)) == Some(e));
        if matches!(point, SurfacePoint::Face { .. }) && crowded && !turns {
            continue;
        }
        kept.push(point);
        last = Some(place);
    }
    if kept.len() >= 3 { kept } else { points }
}

/// The ends of the edge that a point is on, low first.
fn edge_of<M: Faces>(mesh: &M, point: Option<&SurfacePoint>) -> Option<[VertexId; 2]> {
    let Some(SurfacePoint::Edge { halfedge, .. }) = point else { return None };
    let corners = mesh.corners(halfedge.face());
    let [a, b] = [corners[halfedge.corner()], corners[(halfedge.corner() + 1) % 3]];
    Some([a.min(b), a.max(b)])
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
    let [a, b] =
        [fine.tail(h), fine.head(h)].map(|v| origins.vertices[v].barycentric(corners).unwrap_or([1.0 / 3.0; 3]));
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
