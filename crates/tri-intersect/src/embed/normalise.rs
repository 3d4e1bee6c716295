//! Curve points as canonical addresses: one name for each place, nothing nearer to a vertex or an edge than the snap.

use super::curve::{EmbedParams, SurfaceCurve};
use super::error::EmbedError;
use mesh_core::{Adjacency, HalfedgeId, Positions, SurfacePoint};

/// Snap of points that must stay where they are: below it the new edge would vanish in rounding.
const LEAST_SNAP: f64 = 1e-11;
/// How many nodes back a chain may return to be cut short.
const EXCURSION: usize = 16;

/// A point of a chain and the run of input points merged into it (counted around the end of a closed curve).
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub at: SurfacePoint,
    pub first: usize,
    pub count: usize,
    /// Whether the element differs from that of the input point, or several points were merged.
    pub moved: bool,
    /// How far the first point has moved.
    shift: f64,
    /// The share in force here.
    snap: f64,
}

pub(super) struct Chain {
    pub nodes: Vec<Node>,
    pub closed: bool,
}

/// Canonical nodes of one curve, repeats merged.
pub(super) fn normalise<M: Adjacency + Positions>(
    mesh: &M,
    curve_id: usize,
    curve: &SurfaceCurve,
    exact: &[bool],
    params: &EmbedParams,
) -> Result<Chain, EmbedError> {
    let mut nodes: Vec<Node> = Vec::with_capacity(curve.points.len());
    let closed = curve.closed;
    for (first, (point, &exact)) in curve.points.iter().zip(exact).enumerate() {
        let params = if exact { &EmbedParams { snap: LEAST_SNAP, ..*params } } else { params };
        let bad = EmbedError::BadPoint { curve: curve_id, point: first };
        let (at, snap) = canonical(mesh, point, params).ok_or(bad)?;
        let moved = std::mem::discriminant(point) != std::mem::discriminant(&at);
        let shift = if moved { point.position(mesh).distance(at.position(mesh)) } else { 0.0 };
        push(mesh, &mut nodes, Node { at, first, count: 1, moved, shift, snap });
    }
    if closed {
        // Repeats across the seam: once more from a point half way round, then back again.
        let half = nodes.len() / 2;
        nodes.rotate_left(half);
        let mut again = Vec::with_capacity(nodes.len());
        for node in nodes {
            push(mesh, &mut again, node);
        }
        nodes = again;
        let start = (0..nodes.len()).min_by_key(|&k| nodes[k].first).unwrap_or(0);
        nodes.rotate_left(start);
        while let [a, .., b] = nodes[..]
            && nearly_same(&a, &b)
        {
            nodes.pop();
            nodes[0] = Node { first: b.first, count: a.count + b.count, moved: true, ..a };
        }
    }
    if nodes.len() < if closed { 3 } else { 2 } {
        return Err(EmbedError::Collapsed { curve: curve_id });
    }
    Ok(Chain { nodes, closed })
}

/// Appends a node. One that repeats the last, or is back at an earlier one only because both were moved there, is merged
/// with it and with what lies between.
fn push<M: Adjacency + Positions>(mesh: &M, nodes: &mut Vec<Node>, node: Node) {
    let repeats = nodes.last().is_some_and(|last| nearly_same(last, &node));
    let back = if repeats { Some(0) } else { nodes.iter().rev().take(EXCURSION).position(|n| n.at == node.at) };
    if let Some(back) = back {
        let k = nodes.len() - 1 - back;
        let (center, reach) = (node.at.position(mesh), 4.0 * node.shift.max(nodes[k].shift));
        if nodes[k + 1..].iter().all(|n| n.at.position(mesh).distance(center) <= reach) {
            let count = nodes[k..].iter().map(|n| n.count).sum::<usize>() + node.count;
            nodes.truncate(k + 1);
            nodes[k] = Node { count, moved: true, ..nodes[k] };
            return;
        }
    }
    nodes.push(node);
}

/// Whether two consecutive nodes are one but for rounding or, on an edge, which a curve may run along in one step, for the snap.
fn nearly_same(a: &Node, b: &Node) -> bool {
    match (a.at, b.at) {
        (SurfacePoint::Edge { halfedge: h, t: s }, SurfacePoint::Edge { halfedge: g, t }) => {
            h == g && (s - t).abs() <= a.snap.min(b.snap)
        }
        (SurfacePoint::Face { face: f, barycentric: s }, SurfacePoint::Face { face: g, barycentric: t }) => {
            f == g && s.iter().zip(t).all(|(s, t)| (s - t).abs() <= LEAST_SNAP)
        }
        (a, b) => a == b,
    }
}

/// The address with its edge named by the lower halfedge and with shares below the snap set to zero, and the snap used;
/// `None` if it is not on the mesh.
fn canonical<M: Adjacency + Positions>(
    mesh: &M,
    point: &SurfacePoint,
    params: &EmbedParams,
) -> Option<(SurfacePoint, f64)> {
    if !point.is_on(mesh) || !point.position(mesh).is_finite() {
        return None;
    }
    match *point {
        SurfacePoint::Vertex(_) => Some((*point, LEAST_SNAP)),
        SurfacePoint::Edge { halfedge, t } => (0.0..=1.0).contains(&t).then(|| on_edge(mesh, halfedge, t, params)),
        SurfacePoint::Face { face, barycentric } => {
            // Sums to 1 and is positive but for rounding, or it is no point of this face.
            let slack = 1e-6;
            let sum: f64 = barycentric.iter().sum();
            if (sum - 1.0).abs() > slack || barycentric.iter().any(|&x| x < -slack) {
                return None;
            }
            let corners = mesh.corners(face);
            let [a, b, c] = corners.map(|v| mesh.position(v));
            // A share of a height is at most that share of the longest side.
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let snap = share(params, longest);
            let inside = barycentric.map(|x| x / sum > snap);
            Some(match inside {
                [true, true, true] => (SurfacePoint::Face { face, barycentric: barycentric.map(|x| x / sum) }, snap),
                [true, false, false] => (SurfacePoint::Vertex(corners[0]), snap),
                [false, true, false] => (SurfacePoint::Vertex(corners[1]), snap),
                [false, false, true] => (SurfacePoint::Vertex(corners[2]), snap),
                _ => {
                    let k = (inside.iter().position(|&x| !x).unwrap_or(0) + 1) % 3;
                    let (a, b) = (barycentric[k], barycentric[(k + 1) % 3]);
                    on_edge(mesh, HalfedgeId::new(face, k), b / (a + b), params)
                }
            })
        }
    }
}

fn on_edge<M: Adjacency + Positions>(
    mesh: &M,
    halfedge: HalfedgeId,
    t: f64,
    params: &EmbedParams,
) -> (SurfacePoint, f64) {
    let lower = HalfedgeId(mesh.edge(halfedge).0);
    let (tail, head) = (mesh.tail(lower), mesh.head(lower));
    let t = if lower == halfedge { t } else { 1.0 - t };
    let snap = share(params, mesh.position(tail).distance(mesh.position(head)));
    let at = if t <= snap {
        SurfacePoint::Vertex(tail)
    } else if t >= 1.0 - snap {
        SurfacePoint::Vertex(head)
    } else {
        SurfacePoint::Edge { halfedge: lower, t }
    };
    (at, snap)
}

/// The share of `length` that points may be moved by.
fn share(params: &EmbedParams, length: f64) -> f64 {
    params.snap.min(params.reach / length).clamp(LEAST_SNAP, 0.25)
}
