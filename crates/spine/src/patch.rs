//! Base patches: the faces on either side of a blend curve that a ball of the given reach could touch.

use crate::curve::BlendCurve;
use glam::DVec3;
use mesh_core::{Adjacency, EdgeId, FaceId, FaceMap, HalfedgeId, IdSet, Positions};
use mesh_query::{ClosestPoint, TriBvh, closest_point_on_triangle};
use std::collections::VecDeque;

/// One side of a blend curve.
pub struct Patch {
    /// The faces, ascending.
    pub faces: Vec<FaceId>,
    bvh: TriBvh,
}

impl std::fmt::Debug for Patch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Patch").field("faces", &self.faces.len()).finish_non_exhaustive()
    }
}

/// Which side of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The faces of the curve's own halfedges.
    Left,
    /// The faces of their twins.
    Right,
}

impl Patch {
    /// Floods the faces of `side` that come within `reach` of the curve, never crossing a `barrier` edge.
    ///
    /// Distances are straight, to curve points at most `spacing` apart, and each face inherits its candidate from the
    /// face it was reached through; so the cost grows with the patch, not with the mesh.
    ///
    /// # Errors
    /// What [`TriBvh::build_subset`] refuses.
    pub fn flood<M: Adjacency + Positions + Sync>(
        mesh: &M,
        curve: &BlendCurve,
        side: Side,
        barriers: &IdSet<EdgeId>,
        reach: f64,
        spacing: f64,
    ) -> Result<Self, mesh_query::Error> {
        let marks = Marks::along(mesh, curve, spacing);
        // Mark each face was reached by; the whole array costs less than hashing the patch.
        let mut nearest = FaceMap::filled(mesh.face_count(), u32::MAX);
        let mut faces = Vec::new();
        let mut queue = VecDeque::new();
        for (i, &h) in curve.halfedges.iter().enumerate() {
            let own = match side {
                Side::Left => Some(h),
                Side::Right => mesh.twin(h),
            };
            if let Some(h) = own
                && nearest[h.face()] == u32::MAX
            {
                nearest[h.face()] = marks.first_of_edge[i];
                faces.push(h.face());
                queue.push_back(h.face());
            }
        }
        while let Some(face) = queue.pop_front() {
            for corner in 0..3 {
                let h = HalfedgeId::new(face, corner);
                let Some(next) = mesh.twin(h).map(HalfedgeId::face) else { continue };
                if nearest[next] != u32::MAX || barriers.contains(&mesh.edge(h)) {
                    continue;
                }
                let triangle = mesh.triangle(next);
                if let Some(mark) = marks.approach(nearest[face], triangle, reach) {
                    nearest[next] = mark;
                    faces.push(next);
                    queue.push_back(next);
                }
            }
        }
        faces.sort_unstable();
        Ok(Self { bvh: TriBvh::build_subset(mesh, &faces)?, faces })
    }

    /// The closest point of the patch. `None` only for an empty patch.
    pub fn closest<M: Adjacency + Positions>(&self, mesh: &M, p: DVec3) -> Option<ClosestPoint> {
        self.bvh.closest_point(mesh, p)
    }

    /// The closest point of the patch, found the sooner the nearer `known`, a point of the patch, is to it.
    pub fn closest_near<M: Adjacency + Positions>(&self, mesh: &M, p: DVec3, known: DVec3) -> Option<ClosestPoint> {
        // A little slack, so that the rounding of the bound does not lose the known point itself.
        self.bvh.closest_point_within(mesh, p, (1.0 + 1e-9) * p.distance(known)).or_else(|| self.closest(mesh, p))
    }
}

/// Points along a curve at most `spacing` apart.
struct Marks {
    points: Vec<DVec3>,
    first_of_edge: Vec<u32>,
}

impl Marks {
    fn along<M: Adjacency + Positions>(mesh: &M, curve: &BlendCurve, spacing: f64) -> Self {
        let (mut points, mut first_of_edge) = (Vec::new(), Vec::new());
        for &h in &curve.halfedges {
            let [a, b] = mesh.ends(h);
            first_of_edge.push(points.len() as u32);
            // The seam of a boolean is full of edges far shorter than the spacing; one mark for each of them is enough.
            let pieces = (a.distance(b) / spacing).ceil().clamp(1.0, 4096.0) as u32;
            points.extend((0..pieces).map(|k| a.lerp(b, f64::from(k) / f64::from(pieces))));
        }
        points.extend(curve.ends(mesh).last().map(|end| end.0));
        Self { points, first_of_edge }
    }

    /// A mark within `reach` of a triangle, sought from mark `start`: by turns the triangle's point nearest to the mark and
    /// the mark nearest to that point. A large triangle may come near the curve far from its middle, and a needle that
    /// leaves the curve at a small angle so slowly that the turns do not arrive there: its corners are tried too.
    fn approach(&self, start: u32, triangle: [DVec3; 3], reach: f64) -> Option<u32> {
        let [a, b, c] = triangle;
        [(a + b + c) / 3.0, a, b, c].into_iter().find_map(|from| {
            let mut mark = self.descend(start, from);
            let mut best = f64::INFINITY;
            for _ in 0..64 {
                let p = self.points[mark as usize];
                let on = closest_point_on_triangle(p, triangle).0;
                let distance = on.distance(p);
                if distance <= reach {
                    return Some(mark);
                }
                let next = self.descend(mark, on);
                if next == mark || distance >= best {
                    return None;
                }
                (mark, best) = (next, distance);
            }
            None
        })
    }

    /// Walks from mark `start` to a locally nearest mark of a point, looking a few marks ahead each way.
    fn descend(&self, start: u32, p: DVec3) -> u32 {
        let n = self.points.len();
        let distance = |i: usize| self.points[i].distance_squared(p);
        let mut best = (start as usize, distance(start as usize));
        for _ in 0..n {
            let here = best.0;
            for step in [1, 2, 4, 8] {
                for i in [(here + step) % n, (here + n - step % n) % n] {
                    let d = distance(i);
                    if d < best.1 {
                        best = (i, d);
                    }
                }
            }
            if best.0 == here {
                break;
            }
        }
        best.0 as u32
    }
}
