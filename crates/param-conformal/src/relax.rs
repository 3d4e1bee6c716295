//! Smoothing in the plane for better triangles on the surface that the plane is a map of.

use crate::distortion::{doubled_area, is_flipped};
use crate::rectangle::RingMap;
use glam::{DVec2, DVec3};
use mesh_core::{Adjacency, VertexId};

/// How long [`relax`] smooths.
#[derive(Clone, Debug, PartialEq)]
pub struct RelaxParams {
    /// Rounds over all vertices. Ten bring most of the gain.
    pub rounds: u32,
    /// Share of the way to the mean that a vertex goes, in (0, 1].
    pub step: f64,
}

impl Default for RelaxParams {
    fn default() -> Self {
        Self { rounds: 10, step: 1.0 }
    }
}

/// Weighted Laplacian smoothing of a ring's map, boundary fixed: every vertex moves towards the mean of the far edges'
/// middles of its triangles, each weighed by the triangle's two sides at the vertex, as long as they are on the `target`.
///
/// That is a mean of its neighbours, those weighing more that are farther away on the surface the map is going to be
/// laid on, since it is there that edges are to become even. Equal weights know nothing of that surface; cotangents
/// would pull back to the conformal map; areas let a vertex slide close to the far end of a long triangle. No triangle is turned
/// over by a move, and turned ones are mended where a move can. In vertex order, so the same bits for any thread
/// count. O(n) a round.
pub fn relax<M: Adjacency>(mesh: &M, map: &mut RingMap, target: impl Fn(DVec2) -> DVec3, params: &RelaxParams) {
    let inner: Vec<VertexId> =
        mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_some_and(|h| mesh.twin(h).is_some())).collect();
    let mut lifted: Vec<DVec3> = map.points.as_slice().iter().map(|&p| target(p)).collect();
    let mut star = Star::default();
    for _ in 0..params.rounds {
        for &v in &inner {
            star.gather(mesh, map, &lifted, v);
            let here = map.points[v];
            let Some(mean) = star.mean(lifted[v.index()]) else { continue };
            let way = params.step * (mean - here);
            let found = [1.0, 0.5, 0.25, 0.125].into_iter().map(|s| here + s * way).find(|&p| star.allows(here, p));
            if let Some(p) = found {
                map.points[v] = p;
                lifted[v.index()] = target(p);
            }
        }
    }
}

/// The far edges of the triangles around a vertex, seen from the vertex's own place.
#[derive(Default)]
struct Star {
    plane: Vec<[DVec2; 2]>,
    space: Vec<[DVec3; 2]>,
}

impl Star {
    fn gather<M: Adjacency>(&mut self, mesh: &M, map: &RingMap, lifted: &[DVec3], v: VertexId) {
        self.plane.clear();
        self.space.clear();
        for h in mesh.ring(v) {
            let far = [h.next(), h.prev()];
            let back = map.points[v] - map.corner(mesh, h);
            self.plane.push(far.map(|c| map.corner(mesh, c) + back));
            self.space.push(far.map(|c| lifted[mesh.tail(c).index()]));
        }
    }

    fn mean(&self, lifted: DVec3) -> Option<DVec2> {
        let (mut sum, mut total) = (DVec2::ZERO, 0.0);
        for (&[b, c], &[q, r]) in self.plane.iter().zip(&self.space) {
            let sides = lifted.distance(q) + lifted.distance(r);
            sum += sides * 0.5 * (b + c);
            total += sides;
        }
        (total > 0.0 && sum.is_finite()).then(|| sum / total)
    }

    /// Whether no triangle turns over, or, where one has, the worst gets better.
    fn allows(&self, here: DVec2, there: DVec2) -> bool {
        if self.plane.iter().all(|&[b, c]| !is_flipped([there, b, c])) {
            return true;
        }
        let worst = |p: DVec2| self.plane.iter().map(|&[b, c]| doubled_area([p, b, c])).fold(f64::INFINITY, f64::min);
        self.plane.iter().any(|&[b, c]| is_flipped([here, b, c])) && worst(there) > worst(here)
    }
}
