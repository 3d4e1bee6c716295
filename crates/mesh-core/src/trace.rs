//! Walking on a surface from one point to another: the edges and vertices crossed on the way.
//!
//! The walk follows the section of the mesh by a plane. Which side of the plane a vertex lies on is one rounded number,
//! computed the same way every time, and zero counts as positive; so every face has either no crossing or one way in
//! and one way out, and the walk cannot get lost between needle triangles however the numbers were rounded. Where the section
//! does not lead to the goal (a fold, a hole, a point within rounding of an edge), a short search over faces finds a strip
//! of triangles instead, and the path is pulled straight within it.

use crate::ids::{FaceId, HalfedgeId};
use crate::surface_point::SurfacePoint;
use crate::traits::{Adjacency, Faces, Positions};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// A section this much longer than the straight line is taken without looking the other way.
const NEARLY_STRAIGHT: f64 = 1.25;

/// How far [`trace`] may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceLimits {
    /// Longest path, as a multiple of the straight distance; at least 1. A path over a surface that is smooth at the scale of
    /// the step stays under π/2; 3 leaves room for creases and still refuses to run round a thin wall.
    pub stretch: f64,
    /// Added to the longest path, as a multiple of the longest edge of the faces at both ends: short steps on coarse meshes
    /// cross whole triangles.
    pub slack: f64,
    /// Most faces the search may look at where the plane section fails.
    pub faces: usize,
}

impl Default for TraceLimits {
    fn default() -> Self {
        Self { stretch: 3.0, slack: 3.0, faces: 256 }
    }
}

/// Why there is no path.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TraceError {
    /// An end is not on the mesh, or its place is not finite.
    #[error("{point:?} is not a point of this mesh; name an existing element and finite numbers")]
    BadPoint {
        /// The end in question.
        point: SurfacePoint,
    },
    /// The ends are not joined by a short stretch of surface.
    #[error(
        "no path over the surface from {from} to {to} within a length of {limit} model units; take closer samples or fill the hole between them"
    )]
    Lost {
        /// Where the walk began.
        from: DVec3,
        /// Where it should have arrived.
        to: DVec3,
        /// The longest path allowed, in model units.
        limit: f64,
    },
}

impl SurfacePoint {
    /// The faces whose closure holds the point: all around a vertex, one or two at an edge, one inside.
    pub fn faces<'a, M: Adjacency>(&self, mesh: &'a M) -> impl Iterator<Item = FaceId> + use<'a, M> {
        let (ring, pair) = match *self {
            Self::Vertex(v) => (Some(mesh.ring(v)), [None; 2]),
            Self::Edge { halfedge, .. } => (None, [Some(halfedge.face()), mesh.twin(halfedge).map(HalfedgeId::face)]),
            Self::Face { face, .. } => (None, [Some(face), None]),
        };
        ring.into_iter().flatten().map(HalfedgeId::face).chain(pair.into_iter().flatten())
    }

    /// Whether the closure of `face` holds the point.
    pub fn lies_in<M: Adjacency>(&self, mesh: &M, face: FaceId) -> bool {
        match *self {
            Self::Vertex(v) => mesh.corners(face).contains(&v),
            Self::Edge { halfedge: h, .. } => h.face() == face || mesh.twin(h).is_some_and(|t| t.face() == face),
            Self::Face { face: f, .. } => f == face,
        }
    }

    /// Whether the element exists in the mesh and the numbers are finite.
    pub fn is_on<M: Faces>(&self, mesh: &M) -> bool {
        match *self {
            Self::Vertex(v) => v.index() < mesh.vertex_count(),
            Self::Edge { halfedge, t } => halfedge.face().index() < mesh.face_count() && t.is_finite(),
            Self::Face { face, barycentric } => {
                face.index() < mesh.face_count() && barycentric.iter().all(|x| x.is_finite())
            }
        }
    }
}

/// The path over the surface from `from` to `to` in the plane through both that contains `normal`: the edges and vertices
/// crossed, in order, without the two ends. Consecutive points, ends included, share a face.
///
/// `normal` is the rough direction of the surface's normal, of any length. Ends that share a face give an empty path.
/// Cost ∝ faces crossed.
///
/// # Errors
/// [`TraceError::BadPoint`] for an end that is not on the mesh, [`TraceError::Lost`] where no path within `limits` joins them.
pub fn trace<M: Adjacency + Positions>(
    mesh: &M,
    from: SurfacePoint,
    to: SurfacePoint,
    normal: DVec3,
    limits: &TraceLimits,
) -> Result<Vec<SurfacePoint>, TraceError> {
    for point in [from, to] {
        if !point.is_on(mesh) || !point.position(mesh).is_finite() {
            return Err(TraceError::BadPoint { point });
        }
    }
    if from == to || from.faces(mesh).any(|f| to.lies_in(mesh, f)) {
        return Ok(vec![]);
    }
    let (start, goal) = (from.position(mesh), to.position(mesh));
    let longest = from.faces(mesh).chain(to.faces(mesh)).map(|f| longest_edge(mesh, f)).fold(0.0, f64::max);
    let limit = limits.stretch * start.distance(goal) + limits.slack * longest;
    let across = (goal - start).cross(normal).normalize_or_zero();
    // The surface at the start may look away from `normal`: the section is then followed the wrong way round.
    let walk = |across: DVec3, limit: f64| PlaneWalk { mesh, start, goal, across, limit }.run(from, to);
    let there = walk(across, limit);
    let detour = there.as_ref().map_or(limit, |(_, length)| *length);
    let other = if detour > NEARLY_STRAIGHT * start.distance(goal) { walk(-across, detour) } else { None };
    other
        .or(there)
        .map(|(path, _)| path)
        .or_else(|| straightest_in_strip(mesh, from, to, limit, limits.faces))
        .ok_or(TraceError::Lost { from: start, to: goal, limit })
}

fn longest_edge<M: Faces + Positions>(mesh: &M, f: FaceId) -> f64 {
    let [a, b, c] = mesh.triangle(f);
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

/// The section of the mesh by the plane through `start` normal to `across`, followed with the positive side on the right.
struct PlaneWalk<'a, M> {
    mesh: &'a M,
    start: DVec3,
    goal: DVec3,
    across: DVec3,
    limit: f64,
}

impl<M: Adjacency + Positions> PlaneWalk<'_, M> {
    /// The path and its length.
    fn run(&self, from: SurfacePoint, to: SurfacePoint) -> Option<(Vec<SurfacePoint>, f64)> {
        if self.across == DVec3::ZERO {
            return None;
        }
        let mut path = vec![];
        let (mut here, mut length) = (self.start, 0.0);
        let mut exit = self.first_exit(from)?;
        loop {
            let crossing = self.crossing(exit);
            let place = crossing.position(self.mesh);
            length += place.distance(here);
            if length + place.distance(self.goal) > self.limit {
                return None;
            }
            here = place;
            if path.last().unwrap_or(&from) != &crossing {
                path.push(crossing);
            }
            let entry = self.mesh.twin(exit)?;
            if to.lies_in(self.mesh, entry.face()) {
                // Snapped crossings may already be at the goal.
                path.pop_if(|last| *last == to);
                return Some((path, length + here.distance(self.goal)));
            }
            exit = if self.is_exit(entry.next()) { entry.next() } else { entry.prev() };
        }
    }

    /// Where the section leaves the faces around `from`, towards the goal.
    fn first_exit(&self, from: SurfacePoint) -> Option<HalfedgeId> {
        let towards = self.goal - self.start;
        let mut best = None;
        for f in from.faces(self.mesh) {
            for h in f.halfedges().into_iter().filter(|&h| self.is_exit(h)) {
                let heading = (self.crossing(h).position(self.mesh) - self.start).normalize_or_zero().dot(towards);
                let leaves = match from {
                    SurfacePoint::Vertex(v) => self.mesh.tail(h) != v && self.mesh.head(h) != v,
                    SurfacePoint::Edge { halfedge, .. } => self.mesh.edge(halfedge) != self.mesh.edge(h),
                    SurfacePoint::Face { .. } => true,
                };
                if leaves && best.is_none_or(|(d, _)| heading > d) {
                    best = Some((heading, h));
                }
            }
        }
        best.map(|(_, h)| h)
    }

    fn side(&self, v: crate::ids::VertexId) -> f64 {
        (self.mesh.position(v) - self.start).dot(self.across)
    }

    /// Seen from outside, a section with its positive side on the right leaves a face over a side that runs from
    /// positive to negative.
    fn is_exit(&self, h: HalfedgeId) -> bool {
        self.side(self.mesh.tail(h)) >= 0.0 && self.side(self.mesh.head(h)) < 0.0
    }

    fn crossing(&self, exit: HalfedgeId) -> SurfacePoint {
        let (a, b) = (self.side(self.mesh.tail(exit)), self.side(self.mesh.head(exit)));
        on_edge(self.mesh, exit, a / (a - b))
    }
}

fn on_edge<M: Faces>(mesh: &M, halfedge: HalfedgeId, t: f64) -> SurfacePoint {
    if t <= 0.0 {
        SurfacePoint::Vertex(mesh.tail(halfedge))
    } else if t < 1.0 {
        SurfacePoint::Edge { halfedge, t }
    } else {
        SurfacePoint::Vertex(mesh.head(halfedge))
    }
}

/// Finds the sides of a strip of faces from `from` to `to` by best-first search, then pulls the path straight in it.
fn straightest_in_strip<M: Adjacency + Positions>(
    mesh: &M,
    from: SurfacePoint,
    to: SurfacePoint,
    limit: f64,
    most_faces: usize,
) -> Option<Vec<SurfacePoint>> {
    let goal = to.position(mesh);
    let middle = |h: HalfedgeId| 0.5 * (mesh.position(mesh.tail(h)) + mesh.position(mesh.head(h)));
    // Face → the halfedge it was entered by; never iterated, so its order does not matter.
    let mut entered: HashMap<FaceId, Option<HalfedgeId>> = HashMap::new();
    let mut queue = BinaryHeap::new();
    let push = |queue: &mut BinaryHeap<_>, f: FaceId, entry: Option<HalfedgeId>, walked: f64, at: DVec3| {
        // Distances are not negative, so their bits sort as they do; ties go to the lower face.
        queue.push(Reverse(((walked + at.distance(goal)).to_bits(), f, walked.to_bits(), entry)));
    };
    for f in from.faces(mesh) {
        push(&mut queue, f, None, 0.0, from.position(mesh));
    }
    while let Some(Reverse((_, f, walked, entry))) = queue.pop() {
        if entered.contains_key(&f) {
            continue;
        }
        if entered.len() >= most_faces {
            return None;
        }
        entered.insert(f, entry);
        if to.lies_in(mesh, f) {
            let mut exits = vec![];
            let mut entry = entry;
            while let Some(exit) = entry.and_then(|h| mesh.twin(h)) {
                exits.push(exit);
                entry = entered[&exit.face()];
            }
            exits.reverse();
            return pull_straight(mesh, from, to, &exits, limit);
        }
        let at = entry.map_or(from.position(mesh), middle);
        for h in f.halfedges() {
            if let Some(next) = mesh.twin(h)
                && !entered.contains_key(&next.face())
            {
                push(&mut queue, next.face(), Some(next), f64::from_bits(walked) + at.distance(middle(h)), middle(h));
            }
        }
    }
    None
}

/// Moves each crossing to the straight line, in the unfolded plane of the two faces at its edge, between its neighbours.
fn pull_straight<M: Adjacency + Positions>(
    mesh: &M,
    from: SurfacePoint,
    to: SurfacePoint,
    exits: &[HalfedgeId],
    limit: f64,
) -> Option<Vec<SurfacePoint>> {
    let middle = |&h: &HalfedgeId| mesh.ends(h)[0].midpoint(mesh.ends(h)[1]);
    let mut places = vec![from.position(mesh)];
    places.extend(exits.iter().map(middle));
    places.push(to.position(mesh));
    let mut parameters = vec![0.5; exits.len()];
    for _ in 0..4 * exits.len() + 8 {
        for (i, &h) in exits.iter().enumerate() {
            let [a, b] = mesh.ends(h);
            let along = b - a;
            let flat = |p: DVec3| {
                let t = ((p - a).dot(along) / along.length_squared()).clamp(-1e3, 1e3);
                (t, p.distance(a + t * along))
            };
            let ((t0, d0), (t1, d1)) = (flat(places[i]), flat(places[i + 2]));
            let t = if d0 + d1 > 0.0 { (t0 * d1 + t1 * d0) / (d0 + d1) } else { 0.5 * (t0 + t1) };
            parameters[i] = if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 };
            places[i + 1] = a + parameters[i] * along;
        }
    }
    let length: f64 = places.windows(2).map(|w| w[0].distance(w[1])).sum();
    if length > limit {
        return None;
    }
    let mut path: Vec<_> = exits.iter().zip(parameters).map(|(&h, t)| on_edge(mesh, h, t)).collect();
    // A path that rounds a vertex at an end passes it in several crossings.
    path.drain(..path.iter().rposition(|p| *p == from).map_or(0, |i| i + 1));
    path.truncate(path.iter().position(|p| *p == to).unwrap_or(path.len()));
    path.dedup();
    Some(path)
}
