//! Curve points as canonical addresses: one name for each place, nothing nearer to a vertex or an edge than the snap.

use super::{EmbedError, SurfaceCurve};
use mesh_core::{Adjacency, HalfedgeId, Positions, SurfacePoint};

/// Snap of points that must stay where they are: below it the new edge would vanish in rounding.
const LEAST_SNAP: f64 = 1e-11;
/// How many points an excursion from a vertex and back to it, within the faces around it, may have to be cut short.
const EXCURSION: usize = 16;

/// A point of a chain and the run of input points merged into it (counted around the end of a closed curve).
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub at: SurfacePoint,
    pub first: usize,
    pub count: usize,
    /// Whether the address differs from that of the input point, or several were merged.
    pub moved: bool,
    /// The snap in force here.
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
    snap: f64,
) -> Result<Chain, EmbedError> {
    let mut nodes: Vec<Node> = Vec::with_capacity(curve.points.len());
    let closed = curve.closed;
    for (first, (point, &exact)) in curve.points.iter().zip(exact).enumerate() {
        let snap = if exact { LEAST_SNAP } else { snap.clamp(LEAST_SNAP, 0.25) };
        let at = canonical(mesh, point, snap).ok_or(EmbedError::BadPoint { curve: curve_id, point: first })?;
        let moved = std::mem::discriminant(point) != std::mem::discriminant(&at);
        push(mesh, &mut nodes, Node { at, first, count: 1, moved, snap });
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

/// Appends a node; if it is back at a recent one without having left the neighbourhood, what lies between is merged.
fn push<M: Adjacency>(mesh: &M, nodes: &mut Vec<Node>, node: Node) {
    let repeats = nodes.last().is_some_and(|last| nearly_same(last, &node));
    let back = if repeats { Some(0) } else { nodes.iter().rev().take(EXCURSION).position(|n| n.at == node.at) };
    if let Some(back) = back {
        let k = nodes.len() - 1 - back;
        let near = match node.at {
            SurfacePoint::Vertex(_) => nodes[k + 1..].iter().all(|n| in_star(mesh, n.at, node.at)),
            // There and back again, or the same point twice.
            _ => back <= 1,
        };
        if near {
            let count = nodes[k..].iter().map(|n| n.count).sum::<usize>() + node.count;
            nodes.truncate(k + 1);
            nodes[k] = Node { count, moved: true, ..nodes[k] };
            return;
        }
    }
    nodes.push(node);
}

/// Whether two nodes of the same edge or face differ by no more than the snap.
fn nearly_same(a: &Node, b: &Node) -> bool {
    let snap = a.snap.min(b.snap);
    match (a.at, b.at) {
        (SurfacePoint::Edge { halfedge: h, t: s }, SurfacePoint::Edge { halfedge: g, t }) => {
            h == g && (s - t).abs() <= snap
        }
        (SurfacePoint::Face { face: f, barycentric: s }, SurfacePoint::Face { face: g, barycentric: t }) => {
            f == g && s.iter().zip(t).all(|(s, t)| (s - t).abs() <= snap)
        }
        (a, b) => a == b,
    }
}

/// Whether `point` lies in the closure of a face around the vertex `center`.
fn in_star<M: Adjacency>(mesh: &M, point: SurfacePoint, center: SurfacePoint) -> bool {
    match point {
        SurfacePoint::Vertex(_) => center.faces(mesh).any(|f| point.lies_in(mesh, f)),
        _ => point.faces(mesh).any(|f| center.lies_in(mesh, f)),
    }
}

/// The address with its edge named by the lower halfedge and with shares of at most `snap` set to zero; `None` if it is not
/// on the mesh.
fn canonical<M: Adjacency + Positions>(mesh: &M, point: &SurfacePoint, snap: f64) -> Option<SurfacePoint> {
    if !point.is_on(mesh) || !point.position(mesh).is_finite() {
        return None;
    }
    match *point {
        SurfacePoint::Vertex(_) => Some(*point),
        SurfacePoint::Edge { halfedge, t } => (0.0..=1.0).contains(&t).then(|| on_edge(mesh, halfedge, t, snap)),
        SurfacePoint::Face { face, barycentric } => {
            // Sums to 1 and is positive but for rounding, or it is no point of this face.
            let slack = 1e-6;
            let sum: f64 = barycentric.iter().sum();
            if (sum - 1.0).abs() > slack || barycentric.iter().any(|&x| x < -slack) {
                return None;
            }
            let inside = barycentric.map(|x| x / sum > snap);
            let corners = mesh.corners(face);
            Some(match inside {
                [true, true, true] => SurfacePoint::Face { face, barycentric: barycentric.map(|x| x / sum) },
                [true, false, false] => SurfacePoint::Vertex(corners[0]),
                [false, true, false] => SurfacePoint::Vertex(corners[1]),
                [false, false, true] => SurfacePoint::Vertex(corners[2]),
                _ => {
                    let k = (inside.iter().position(|&x| !x).unwrap_or(0) + 1) % 3;
                    let (a, b) = (barycentric[k], barycentric[(k + 1) % 3]);
                    on_edge(mesh, HalfedgeId::new(face, k), b / (a + b), snap)
                }
            })
        }
    }
}

fn on_edge<M: Adjacency>(mesh: &M, halfedge: HalfedgeId, t: f64, snap: f64) -> SurfacePoint {
    let lower = HalfedgeId(mesh.edge(halfedge).0);
    let t = if lower == halfedge { t } else { 1.0 - t };
    if t <= snap {
        SurfacePoint::Vertex(mesh.tail(lower))
    } else if t >= 1.0 - snap {
        SurfacePoint::Vertex(mesh.head(lower))
    } else {
        SurfacePoint::Edge { halfedge: lower, t }
    }
}
