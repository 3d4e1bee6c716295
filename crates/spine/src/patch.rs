//! Base patches: the faces on either side of a blend curve that a ball of the given reach could touch.

use crate::curve::BlendCurve;
use glam::DVec3;
use mesh_core::{Adjacency, EdgeId, FaceId, HalfedgeId, Positions};
use mesh_query::{ClosestPoint, TriBvh, closest_point_on_triangle};
use std::collections::{HashMap, HashSet, VecDeque};

/// One side of a blend curve.
pub struct Patch {
    /// The faces, ascending.
    pub faces: Vec<FaceId>,
    bvh: TriBvh,
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
        barriers: &HashSet<EdgeId>,
        reach: f64,
        spacing: f64,
    ) -> Result<Self, mesh_query::Error> {
        let marks = Marks::along(mesh, curve, spacing);
        let mut nearest: HashMap<FaceId, usize> = HashMap::new();
        let mut queue = VecDeque::new();
        for (i, &h) in curve.halfedges.iter().enumerate() {
            let own = match side {
                Side::Left => Some(h),
                Side::Right => mesh.twin(h),
            };
            if let Some(h) = own
                && nearest.insert(h.face(), marks.first_of_edge[i]).is_none()
            {
                queue.push_back(h.face());
            }
        }
        while let Some(face) = queue.pop_front() {
            for corner in 0..3 {
                let h = HalfedgeId::new(face, corner);
                let Some(next) = mesh.twin(h).map(HalfedgeId::face) else { continue };
                if barriers.contains(&mesh.edge(h)) || nearest.contains_key(&next) {
                    continue;
                }
                let triangle = mesh.corners(next).map(|v| mesh.position(v));
                let (mark, distance) = marks.descend(nearest[&face], triangle);
                if distance <= reach {
                    nearest.insert(next, mark);
                    queue.push_back(next);
                }
            }
        }
        let mut faces: Vec<FaceId> = nearest.into_keys().collect();
        faces.sort_unstable();
        Ok(Self { bvh: TriBvh::build_subset(mesh, &faces)?, faces })
    }

    /// The closest point of the patch. `None` only for an empty patch.
    pub fn closest<M: Adjacency + Positions>(&self, mesh: &M, p: DVec3) -> Option<ClosestPoint> {
        self.bvh.closest_point(mesh, p)
    }
}

/// Points along a curve at most `spacing` apart.
struct Marks {
    points: Vec<DVec3>,
    first_of_edge: Vec<usize>,
}

impl Marks {
    fn along<M: Adjacency + Positions>(mesh: &M, curve: &BlendCurve, spacing: f64) -> Self {
        let (mut points, mut first_of_edge) = (Vec::new(), Vec::new());
        for &h in &curve.halfedges {
            let (a, b) = (mesh.position(mesh.tail(h)), mesh.position(mesh.head(h)));
            first_of_edge.push(points.len());
            // The seam of a boolean is full of edges far shorter than the spacing; one mark for each of them is enough.
            let pieces = (a.distance(b) / spacing).ceil().clamp(1.0, 4096.0) as u32;
            points.extend((0..pieces).map(|k| a.lerp(b, f64::from(k) / f64::from(pieces))));
        }
        Self { points, first_of_edge }
    }

    /// Walks from mark `start` to a locally nearest mark of the triangle, looking a few marks ahead each way.
    fn descend(&self, start: usize, triangle: [DVec3; 3]) -> (usize, f64) {
        let n = self.points.len();
        let distance = |i: usize| closest_point_on_triangle(self.points[i], triangle).0.distance(self.points[i]);
        let mut best = (start, distance(start));
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
        best
    }
}
