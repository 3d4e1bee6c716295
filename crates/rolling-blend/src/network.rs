//! How blend curves hang together: the nodes at which open ones meet or end, and what is done there.

use crate::cap::{Cap, Caps};
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, EdgeId, FaceId, Faces, HalfedgeId, Positions, TriMesh, VertexId, dihedral_angle,
};
use spine::BlendCurve;
use std::collections::BTreeMap;

/// An open curve as seen from the node that it leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Dart {
    /// Index of the curve.
    pub curve: usize,
    /// 0 leaves along the curve's direction, 1 against it; also the side of the rail that is on the dart's left.
    pub end: usize,
}

impl Dart {
    /// The same curve as seen from its other end.
    pub fn twin(self) -> Self {
        Self { end: 1 - self.end, ..self }
    }

    /// The rail's side on the dart's right.
    pub fn right(self) -> usize {
        1 - self.end
    }

    /// Its first halfedge, leaving the node.
    pub fn halfedge(self, mesh: &Connected<TriMesh>, curves: &[BlendCurve]) -> Option<HalfedgeId> {
        let chain = &curves[self.curve].halfedges;
        if self.end == 0 { chain.first().copied() } else { chain.last().and_then(|&h| mesh.twin(h)) }
    }
}

/// What becomes of the blends at a node.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    /// They meet in a corner patch.
    Corner,
    /// The only one stops at the surface that bounds both its sides.
    Stop {
        /// The creases that bound its left and its right side, outwards from the node.
        creases: [Vec<HalfedgeId>; 2],
        /// Faces of the surface, next to the node.
        beyond: Vec<FaceId>,
    },
    /// The only one ends at a cap.
    Cap(Cap),
    /// The only one, or each of two unlike ones, narrows to nothing.
    RunOut {
        /// Edges on from the node, which part its left side from its right.
        onwards: Vec<EdgeId>,
    },
}

/// A vertex at which open curves meet or end.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    pub vertex: VertexId,
    /// The curves' ends, counter-clockwise.
    pub darts: Vec<Dart>,
    pub kind: Kind,
}

/// The nodes of a set of curves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Network {
    pub nodes: Vec<Node>,
    /// For each curve, the nodes at its beginning and its end.
    pub ends: Vec<[Option<usize>; 2]>,
    /// Edges that end the sides of curves with a cap.
    border: Vec<EdgeId>,
}

/// Least turn of an edge at which a side of a blend ends, in degrees. Lower than that of features: a face that is not
/// rounded must not be rolled round either.
const CREASE: f64 = 25.0;
/// Least share of the way that goes into the surface at which a blend is to stop.
const HEAD_ON: f64 = 0.25;

impl Network {
    /// Finds the nodes of `curves`. A blend that stops or runs out looks `reach` ahead, in model units.
    pub fn of(mesh: &Connected<TriMesh>, curves: &[BlendCurve], caps: &Caps, reach: f64) -> Self {
        let mut darts: BTreeMap<VertexId, Vec<Dart>> = BTreeMap::new();
        for (curve, chain) in curves.iter().enumerate().filter(|(_, c)| !c.closed) {
            let (Some(&first), Some(&last)) = (chain.halfedges.first(), chain.halfedges.last()) else { continue };
            darts.entry(mesh.tail(first)).or_default().push(Dart { curve, end: 0 });
            darts.entry(mesh.head(last)).or_default().push(Dart { curve, end: 1 });
        }
        let mut network = Self { nodes: Vec::new(), ends: vec![[None; 2]; curves.len()], border: caps.border.clone() };
        for (vertex, mut darts) in darts {
            let place = |d: &Dart| mesh.ring(vertex).position(|h| Some(h) == d.halfedge(mesh, curves));
            darts.sort_by_key(place);
            let groups = if darts.len() > 2 { vec![darts] } else { darts.into_iter().map(|d| vec![d]).collect() };
            for darts in groups {
                let kind = match darts[..] {
                    [dart] => match caps.at.get(&vertex) {
                        Some(cap) => Kind::Cap(cap.clone()),
                        None => ending(mesh, curves, vertex, dart, reach),
                    },
                    _ => Kind::Corner,
                };
                for d in &darts {
                    network.ends[d.curve][d.end] = Some(network.nodes.len());
                }
                network.nodes.push(Node { vertex, darts, kind });
            }
        }
        network
    }

    /// Makes the curve that ends alone at a node run out there instead of stopping.
    pub fn run_out(&mut self, mesh: &Connected<TriMesh>, curves: &[BlendCurve], node: usize, reach: f64) {
        let node = &mut self.nodes[node];
        let ring = node.darts[0].halfedge(mesh, curves).map_or(vec![], |own| around(mesh, own));
        node.kind = onwards(mesh, &ring, reach);
    }

    /// The ends at which the ball dwindles to nothing.
    pub fn run_outs(&self) -> impl Iterator<Item = VertexId> {
        self.nodes.iter().filter(|n| matches!(n.kind, Kind::RunOut { .. })).map(|n| n.vertex)
    }

    /// Edges that end the sides of `curve`.
    pub fn walls(&self, mesh: &Connected<TriMesh>, curve: usize) -> Vec<EdgeId> {
        let nodes = self.ends[curve].iter().flatten().map(|&n| &self.nodes[n]);
        nodes
            .flat_map(|node| match &node.kind {
                Kind::Corner => Vec::new(),
                Kind::Cap(cap) => {
                    let edge = |w: &[VertexId]| mesh.halfedge(w[0], w[1]).map(|h| mesh.edge(h));
                    cap.section.windows(2).filter_map(edge).chain(self.border.iter().copied()).collect()
                }
                Kind::Stop { creases, .. } => creases.iter().flatten().map(|&h| mesh.edge(h)).collect(),
                Kind::RunOut { onwards } => onwards.clone(),
            })
            .collect()
    }

    /// The dart after which a walk that keeps the curves on its right goes on, having come along `dart`.
    pub fn next(&self, dart: Dart) -> Dart {
        let back = dart.twin();
        let Some(node) = self.ends[back.curve][back.end] else { return dart };
        let darts = &self.nodes[node].darts;
        let place = darts.iter().position(|&d| d == back).unwrap_or(0);
        darts[(place + darts.len() - 1) % darts.len()]
    }
}

/// How a curve that meets no other ends.
fn ending(mesh: &Connected<TriMesh>, curves: &[BlendCurve], vertex: VertexId, dart: Dart, reach: f64) -> Kind {
    let Some(own) = dart.halfedge(mesh, curves) else { return Kind::RunOut { onwards: vec![] } };
    let ring = around(mesh, own);
    let out = (mesh.position(vertex) - mesh.position(mesh.head(own))).normalize_or_zero();
    let sharp = |h: HalfedgeId| dihedral_angle(mesh, h).is_some_and(|a| a.abs().to_degrees() >= CREASE);
    let creases: Vec<usize> = (1..ring.len()).filter(|&i| sharp(ring[i])).collect();
    if let [left, .., right] = creases[..] {
        let beyond: Vec<FaceId> = ring[left..right].iter().map(|h| h.face()).collect();
        let normal = beyond.iter().map(|&f| area_vector(mesh, f)).sum::<DVec3>().normalize_or_zero();
        if normal.dot(out).abs() > HEAD_ON {
            return Kind::Stop { creases: [left, right].map(|i| follow(mesh, ring[i], reach, &sharp)), beyond };
        }
    }
    onwards(mesh, &ring, reach)
}

/// The halfedges that leave the tail of `own`, counter-clockwise from that.
fn around(mesh: &Connected<TriMesh>, own: HalfedgeId) -> Vec<HalfedgeId> {
    let mut ring: Vec<HalfedgeId> = mesh.ring(mesh.tail(own)).collect();
    let at = ring.iter().position(|&h| h == own).unwrap_or(0);
    ring.rotate_left(at);
    ring
}

/// A run-out of the curve along the first halfedge of `ring`.
fn onwards(mesh: &Connected<TriMesh>, ring: &[HalfedgeId], reach: f64) -> Kind {
    let along = |h: HalfedgeId| (mesh.position(mesh.head(h)) - mesh.position(mesh.tail(h))).normalize_or_zero();
    let ahead = |h: &&HalfedgeId| -along(**h).dot(ring.first().map_or(DVec3::ZERO, |&own| along(own)));
    let straightest = ring.iter().skip(1).max_by(|a, b| ahead(a).total_cmp(&ahead(b)));
    let onwards = straightest.map_or(vec![], |&h| follow(mesh, h, reach, &|_| true));
    Kind::RunOut { onwards: onwards.into_iter().map(|h| mesh.edge(h)).collect() }
}

fn area_vector(mesh: &Connected<TriMesh>, face: FaceId) -> DVec3 {
    let [a, b, c] = mesh.triangle(face);
    (b - a).cross(c - a)
}

/// The chain of `allowed` edges that goes on from `first` as straight as it can, for `reach`; it ends where it would turn
/// by more than 60 degrees.
fn follow(
    mesh: &Connected<TriMesh>,
    first: HalfedgeId,
    reach: f64,
    allowed: &dyn Fn(HalfedgeId) -> bool,
) -> Vec<HalfedgeId> {
    let along = |h: HalfedgeId| mesh.position(mesh.head(h)) - mesh.position(mesh.tail(h));
    let (mut chain, mut length, mut here) = (vec![first], along(first).length(), first);
    while length < reach {
        let direction = along(here).normalize_or_zero();
        let turn = |h: HalfedgeId| along(h).normalize_or_zero().dot(direction);
        let onwards = mesh.ring(mesh.head(here)).filter(|&h| allowed(h) && turn(h) > 0.5);
        let Some(next) = onwards.max_by(|&a, &b| turn(a).total_cmp(&turn(b))) else { break };
        if chain.iter().any(|&h| mesh.head(h) == mesh.head(next)) {
            break;
        }
        length += along(next).length();
        chain.push(next);
        here = next;
    }
    chain
}
