//! The closed curves around what the ball cannot reach.
//!
//! Within a patch they are level sets of the scalar. Along a wall between patches they follow the wall where one side of it
//! is inside and the other is not.

use super::centre::Ground;
use super::mark::{Marked, parent, scalar};
use super::patches::to_segment;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{Adjacency, FaceId, Faces, HalfedgeId, Positions, SurfacePoint, VertexId, VertexOrigin};
use std::collections::BTreeMap;
use tri_intersect::SurfaceCurve;

/// How often what lies around a place where outlines touch is taken in.
const WIDENINGS: usize = 2;
/// Steps of the search for the place on an edge where the scalar vanishes.
const STEPS: usize = 8;
/// Crossings keep away from the ends of their edges by this share.
const ASIDE: f64 = 0.01;

/// Longest distance between points of an outline within a face, and how far from their chords others may lie, in radii.
const SPACING: f64 = 0.3;
const STRAIGHT: f64 = 1e-3;

/// A point of the outline: a vertex of the copy, or the crossing of an edge, of its halfedge's side where that is a wall.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Node {
    Vertex(VertexId),
    Crossing(HalfedgeId),
}

struct Outline<'a> {
    ground: &'a Ground<'a>,
    marked: &'a Marked<'a>,
    chosen: &'a [bool],
    r: f64,
    links: BTreeMap<Node, Vec<Node>>,
    crossings: BTreeMap<HalfedgeId, f64>,
}

/// The outlines as curves on the mesh.
pub(super) fn outlines(
    ground: &Ground<'_>,
    mut marked: Marked<'_>,
    chosen: &[bool],
    r: f64,
) -> Result<Vec<SurfaceCurve>, Trouble> {
    for _ in 0..WIDENINGS {
        let pinches = Outline::of(ground, &marked, chosen, r).pinches();
        if pinches.is_empty() || !marked.take_in(ground, &pinches, r) {
            break;
        }
    }
    Outline::of(ground, &marked, chosen, r).loops()
}

impl<'a> Outline<'a> {
    fn of(ground: &'a Ground<'a>, marked: &'a Marked<'a>, chosen: &'a [bool], r: f64) -> Self {
        let mut outline = Self { ground, marked, chosen, r, links: BTreeMap::new(), crossings: BTreeMap::new() };
        for f in marked.fine.face_ids() {
            outline.cross(f);
        }
        for h in marked.fine.halfedge_ids() {
            outline.follow(h);
        }
        outline
    }

    /// Vertices at or next to which outlines touch.
    fn pinches(&self) -> Vec<VertexId> {
        let inside = |h: HalfedgeId| {
            if self.ends(h).is_some_and(|e| e[0]) { self.marked.fine.tail(h) } else { self.marked.fine.head(h) }
        };
        let vertex = |node: &Node| match *node {
            Node::Vertex(v) => v,
            Node::Crossing(h) => inside(h),
        };
        self.links.iter().filter(|l| l.1.len() != 2).map(|l| vertex(l.0)).collect()
    }
}

impl Outline<'_> {
    fn is_wall(&self, h: HalfedgeId) -> bool {
        let edge = self.marked.edge_of[h.index()];
        edge.is_some_and(|e| !self.chosen[e.index()] && self.ground.ends_marks(e)) || self.marked.fine.twin(h).is_none()
    }

    /// Whether both ends of a halfedge are inside, as its own face sees them; `None` where its face was not reached.
    fn ends(&self, h: HalfedgeId) -> Option<[bool; 2]> {
        let values = self.marked.corners[h.face().index()]?;
        Some([values[h.corner()] < 0.0, values[(h.corner() + 1) % 3] < 0.0])
    }

    fn key(&self, h: HalfedgeId) -> HalfedgeId {
        if self.is_wall(h) { h } else { self.marked.fine.twin(h).map_or(h, |t| t.min(h)) }
    }

    fn link(&mut self, a: Node, b: Node) {
        if a != b {
            self.links.entry(a).or_default().push(b);
            self.links.entry(b).or_default().push(a);
        }
    }

    /// The crossing of an edge one end of which is inside.
    fn crossing(&mut self, h: HalfedgeId) -> Node {
        let key = self.key(h);
        if !self.crossings.contains_key(&key) {
            let t = self.vanishes(key);
            self.crossings.insert(key, t);
        }
        Node::Crossing(key)
    }

    /// Where along a halfedge the scalar of its face vanishes: false position, kept off the ends.
    fn vanishes(&self, h: HalfedgeId) -> f64 {
        let fine = self.marked.fine;
        let [a, b] = fine.ends(h);
        let face = parent(self.marked.origins, h.face());
        let value = |t: f64| scalar(self.ground, face, a.lerp(b, t), self.r) - self.marked.level;
        let (mut low, mut high) = ([0.0, value(0.0)], [1.0, value(1.0)]);
        if (low[1] < 0.0) == (high[1] < 0.0) {
            // The faces around a vertex see it a little differently, or it was taken in.
            return 0.5;
        }
        for step in 0..STEPS {
            let t = if step % 3 == 2 {
                0.5 * (low[0] + high[0])
            } else {
                low[0] + (high[0] - low[0]) * low[1] / (low[1] - high[1])
            };
            let next = [t, value(t)];
            if (next[1] < 0.0) == (low[1] < 0.0) {
                low = next;
            } else {
                high = next;
            }
            if next[1].abs() < 1e-9 {
                return t.clamp(ASIDE, 1.0 - ASIDE);
            }
        }
        (0.5 * (low[0] + high[0])).clamp(ASIDE, 1.0 - ASIDE)
    }

    /// The piece of outline within a face.
    fn cross(&mut self, f: FaceId) {
        let crossed: Vec<HalfedgeId> =
            f.halfedges().into_iter().filter(|&h| self.ends(h).is_some_and(|[a, b]| a != b)).collect();
        if let [a, b] = crossed[..] {
            let (a, b) = (self.crossing(a), self.crossing(b));
            self.link(a, b);
        }
    }

    /// The pieces of outline along an edge: where a wall has one side inside and the other not.
    fn follow(&mut self, h: HalfedgeId) {
        let twin = self.marked.fine.twin(h);
        if !self.is_wall(h) || twin.is_some_and(|t| t < h) {
            return;
        }
        let own = self.ends(h).unwrap_or([false; 2]);
        let other = twin.and_then(|t| self.ends(t)).map_or([false; 2], |[a, b]| [b, a]);
        if own == other && own[0] == own[1] {
            return;
        }
        let [tail, head] = [self.marked.fine.tail(h), self.marked.fine.head(h)].map(Node::Vertex);
        // The part of each side that is inside, as an interval with its ends.
        let mut span = |ends: [bool; 2], h: HalfedgeId, turned: bool| {
            let place = |outline: &mut Self| {
                let node = outline.crossing(h);
                let Node::Crossing(key) = node else { return (0.0, node) };
                let t = outline.crossings[&key];
                (if turned { 1.0 - t } else { t }, node)
            };
            match ends {
                [true, true] => Some([(0.0, tail), (1.0, head)]),
                [true, false] => Some([(0.0, tail), place(self)]),
                [false, true] => Some([place(self), (1.0, head)]),
                [false, false] => None,
            }
        };
        let one = span(own, h, false);
        let two = twin.and_then(|t| span(other, t, true));
        match (one, two) {
            (Some([a, b]), None) | (None, Some([a, b])) => self.link(a.1, b.1),
            (Some([a, b]), Some([c, d])) if b.0 < c.0 || d.0 < a.0 => {
                self.link(a.1, b.1);
                self.link(c.1, d.1);
            }
            (Some([a, b]), Some([c, d])) => {
                self.link(a.1, c.1);
                self.link(b.1, d.1);
            }
            (None, None) => {}
        }
    }

    fn loops(mut self) -> Result<Vec<SurfaceCurve>, Trouble> {
        let pinches: Vec<DVec3> = self.links.iter().filter(|l| l.1.len() != 2).map(|l| self.place(*l.0)).collect();
        if !pinches.is_empty() {
            return Err(Trouble::at("what the ball cannot reach pinches", pinches));
        }
        let mut curves = vec![];
        while let Some((&start, _)) = self.links.first_key_value() {
            let mut nodes = vec![start];
            let Some(mut next) = self.links.remove(&start).and_then(|l| l.first().copied()) else { continue };
            let mut last = start;
            while next != start {
                nodes.push(next);
                let Some(links) = self.links.remove(&next) else { break };
                let onwards = if links[0] == last { links[1] } else { links[0] };
                (last, next) = (next, onwards);
            }
            let points: Vec<SurfacePoint> = nodes.iter().map(|&n| self.on_mesh(n)).collect();
            let points = straightened(self.ground.mesh, points);
            curves.push(SurfaceCurve { points: thinned(self.ground.mesh, points, self.r), closed: true });
        }
        Ok(curves)
    }

    fn place(&self, node: Node) -> DVec3 {
        let fine = self.marked.fine;
        match node {
            Node::Vertex(v) => fine.position(v),
            Node::Crossing(h) => {
                let [a, b] = fine.ends(h);
                a.lerp(b, self.crossings.get(&h).copied().unwrap_or(0.5))
            }
        }
    }

    fn on_mesh(&self, node: Node) -> SurfacePoint {
        let (fine, origins, mesh) = (self.marked.fine, self.marked.origins, self.ground.mesh);
        match node {
            Node::Vertex(v) => match origins.vertices[v] {
                VertexOrigin::Input { vertex, .. } => SurfacePoint::Vertex(vertex),
                VertexOrigin::Edge { ends: [a, b], t, .. } => {
                    mesh.halfedge(a, b).map_or(SurfacePoint::Vertex(a), |halfedge| SurfacePoint::Edge { halfedge, t })
                }
                VertexOrigin::Face { face, barycentric, .. } => SurfacePoint::Face { face, barycentric },
                VertexOrigin::New { .. } => SurfacePoint::Vertex(v),
            },
            Node::Crossing(h) => {
                let face = parent(origins, h.face());
                let corners = mesh.corners(face);
                let t = self.crossings.get(&h).copied().unwrap_or(0.5);
                let [a, b] = [fine.tail(h), fine.head(h)]
                    .map(|v| origins.vertices[v].barycentric(corners).unwrap_or([1.0 / 3.0; 3]));
                let w = [0, 1, 2].map(|k| (1.0 - t) * a[k] + t * b[k]);
                match w.iter().position(|&x| x == 0.0) {
                    Some(k) => {
                        let halfedge = HalfedgeId::new(face, (k + 1) % 3);
                        SurfacePoint::Edge { halfedge, t: w[(k + 2) % 3] / (w[(k + 1) % 3] + w[(k + 2) % 3]) }
                    }
                    None => SurfacePoint::Face { face, barycentric: w },
                }
            }
        }
    }
}

/// Without points within faces that lie on the chord between others: marks are as far apart there as the blend's edges.
fn thinned<M: Faces + Positions>(mesh: &M, points: Vec<SurfacePoint>, r: f64) -> Vec<SurfacePoint> {
    let n = points.len();
    let free = |i: usize| matches!(points[i % n], SurfacePoint::Face { .. });
    let Some(first) = (0..n).find(|&i| !free(i)) else { return points };
    let place = |i: usize| points[i % n].position(mesh);
    let mut kept = vec![points[first]];
    let mut last = first;
    while last < first + n {
        // As far ahead as all points passed over lie on the chord.
        let fits = |to: usize| {
            let chord = [place(last), place(to)];
            chord[0].distance(chord[1]) <= SPACING * r
                && (last + 1..to).all(|i| to_segment(place(i), chord) <= STRAIGHT * r)
        };
        let mut next = last + 1;
        while next < first + n && free(next) && fits(next + 1) {
            next += 1;
        }
        last = next;
        if last < first + n {
            kept.push(points[last % n]);
        }
    }
    if kept.len() >= 3 { kept } else { points }
}

/// Without points between two others of the same edge: along a wall the mesh has an edge already.
fn straightened<M: Adjacency>(mesh: &M, points: Vec<SurfacePoint>) -> Vec<SurfacePoint> {
    let n = points.len();
    let shares = |i: usize, e: HalfedgeId| match points[i] {
        SurfacePoint::Edge { halfedge, .. } => mesh.edge(halfedge) == mesh.edge(e),
        SurfacePoint::Vertex(v) => mesh.tail(e) == v || mesh.head(e) == v,
        SurfacePoint::Face { .. } => false,
    };
    let between = |i: usize| match points[i] {
        SurfacePoint::Edge { halfedge, .. } => shares((i + 1) % n, halfedge) && shares((i + n - 1) % n, halfedge),
        _ => false,
    };
    let kept: Vec<SurfacePoint> = (0..n).filter(|&i| !between(i)).map(|i| points[i]).collect();
    if kept.len() >= 3 { kept } else { points }
}
