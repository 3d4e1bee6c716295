//! The nearest place for the ball's centre: the envelope of all balls, point by point.
//!
//! What the ball can reach is bounded by points at distance r from the set C of admissible centres, those at least r from the
//! surface. For a point x that it cannot reach, the nearest centre c in C gives the envelope at c + r·(x − c)/|x − c|: no
//! spine, no strips, no corners, and any number of contacts. C is found by cutting planes: a centre nearest to x in front
//! of the tangent planes met so far, the closest contact that it violates added as one more plane, until none is.

use super::patches::{Patches, to_segment};
use glam::{DMat3, DVec3};
use mesh_core::{Bounds, Connected, FaceId, HalfedgeId, Positions, TriMesh};
use mesh_query::TriBvh;
use std::collections::BTreeMap;

/// Contact distances are right to this share of the radius.
const SEATED: f64 = 1e-9;
/// Where the search ends, the ball may be this share of the radius too near to a face for rounding.
const SETTLED: f64 = 1e-6;
/// A centre farther than this from its point, in radii, is none.
const FARTHEST: f64 = 8.0;
/// Cutting planes added, at most.
const STEPS: usize = 80;
/// Planes kept at once; beyond that, those that do not hold the centre are forgotten.
const PLANES: usize = 10;

/// The surface as the ball meets it.
pub(crate) struct Ground<'a> {
    pub mesh: &'a Connected<TriMesh>,
    pub patches: &'a Patches,
    pub tree: &'a TriBvh,
    /// 1 where the ball rolls outside the solid, −1 inside.
    pub sign: f64,
    /// Halfedges that nothing is marked across, beside those between patches.
    pub fences: &'a [bool],
}

/// A face in whose plane the envelope ends: no centre lies in front of that.
pub(crate) struct Stop {
    /// Out of the face.
    pub normal: DVec3,
    /// The stretch of its boundary at which the envelope ends.
    pub along: Vec<DVec3>,
}

impl Stop {
    /// Whether the stop is in the way of balls at a point: it is behind the plane and no farther than a radius from the
    /// stretch.
    fn acts(&self, x: DVec3, r: f64) -> bool {
        let near = || self.along.windows(2).any(|w| to_segment(x, [w[0], w[1]]) <= r);
        self.along.first().is_some_and(|&at| self.normal.dot(x - at) <= SETTLED * r) && near()
    }

    fn plane(&self, r: f64) -> Option<Plane> {
        let at = self.along.first()?;
        Some(Plane { face: None, foot: *at + r * self.normal, normal: -self.normal })
    }
}

/// The half space in front of a contact with a face, or behind a stop: n·(c − foot) ≥ r.
#[derive(Clone, Copy)]
struct Plane {
    face: Option<FaceId>,
    foot: DVec3,
    normal: DVec3,
}

impl Ground<'_> {
    /// Whether marks end at an edge unless it is blended.
    pub fn ends_marks(&self, h: HalfedgeId) -> bool {
        self.patches.is_wall(h) || self.fences[h.index()]
    }

    /// The admissible centre nearest to `x`, sought from the plane of `face`, which should be near. `None` where there is
    /// none near by, or none is found.
    pub fn centre(&self, x: DVec3, r: f64, face: FaceId) -> Option<DVec3> {
        self.centre_behind(x, r, face, vec![], |_| true)
    }

    /// The centre nearest to `x` in the plane across `normal` through it, with no contact to facets that lie `ahead` there.
    pub fn centre_in_plane(&self, x: DVec3, r: f64, face: FaceId, normal: DVec3, ahead: &[u32]) -> Option<DVec3> {
        let stops = [normal, -normal].map(|n| Plane { face: None, foot: x - r * n, normal: n });
        self.centre_behind(x, r, face, stops.into(), |f| !ahead.contains(&self.patches.facet(f)))
    }

    /// The nearest centre beyond some planes, of those that keep away from the faces that count.
    fn centre_behind(
        &self,
        x: DVec3,
        r: f64,
        face: FaceId,
        mut planes: Vec<Plane>,
        counts: impl Fn(FaceId) -> bool,
    ) -> Option<DVec3> {
        let [a, ..] = self.mesh.triangle(face);
        planes.push(Plane { face: Some(face), foot: a, normal: self.sign * self.patches.face_normal(face) });
        for _ in 0..STEPS {
            let (place, holding) = nearest_in_front(x, r, &planes)?;
            if place.distance_squared(x) > FARTHEST * FARTHEST * r * r {
                return None;
            }
            // Faces end: a plane that holds the centre turns about its contact until it is tangent to the ball.
            let mut changed = false;
            for (plane, holds) in planes.iter_mut().zip(&holding) {
                let Some(face) = plane.face else { continue };
                let turned = self.plane(face, place);
                changed |= *holds && (place - turned.foot).dot(turned.normal) > (1.0 + SEATED) * r;
                *plane = turned;
            }
            let near = self.tree.closest_point_where(self.mesh, place, (1.0 - SEATED) * r, &counts);
            if let Some(near) = near
                && planes.iter().all(|p| p.face != Some(near.face))
            {
                if planes.len() >= PLANES {
                    let mut held = holding.iter();
                    planes.retain(|p| held.next() == Some(&true) || p.face.is_none());
                }
                planes.push(self.plane(near.face, place));
                changed = true;
            }
            if !changed {
                return near.is_none_or(|n| n.distance > (1.0 - SETTLED) * r).then_some(place);
            }
        }
        None
    }

    /// The tangent plane of the ball at `place` where it is nearest to a face; the face's own plane if it is behind that.
    fn plane(&self, face: FaceId, place: DVec3) -> Plane {
        let (foot, _) = mesh_query::closest_point_on_triangle(place, self.mesh.triangle(face));
        let out = self.sign * self.patches.face_normal(face);
        let away = place - foot;
        let normal = if away.dot(out) > 0.0 { away.normalize_or(out) } else { out };
        Plane { face: Some(face), foot, normal }
    }

    /// The point of the envelope over `x`, and the ball's centre: `x` itself where the ball can touch it. `None` where no ball
    /// can be near. No centre lies beyond the `stops` near `x`.
    pub fn envelope(&self, x: DVec3, r: f64, stops: &[Stop]) -> Option<(DVec3, DVec3)> {
        let nearest = self.tree.closest_point(self.mesh, x)?.face;
        let stops: Vec<Plane> = stops.iter().filter(|s| s.acts(x, r)).filter_map(|s| s.plane(r)).collect();
        let from = |face| self.centre_behind(x, r, face, stops.clone(), |_| true);
        let centre = from(nearest).or_else(|| self.centre_from_any(x, r, nearest, from))?;
        let arm = x - centre;
        let length = arm.length();
        (length > 1e-3 * r).then(|| (centre + arm * (r / length), centre))
    }

    /// The nearest of the centres found from each patch within reach.
    fn centre_from_any(
        &self,
        x: DVec3,
        r: f64,
        tried: FaceId,
        from: impl Fn(FaceId) -> Option<DVec3>,
    ) -> Option<DVec3> {
        let mut around = vec![];
        self.tree.faces_in_box(self.mesh, &Bounds::of([x]).inflated(1.5 * r), &mut around);
        let distance = |f: FaceId| mesh_query::closest_point_on_triangle(x, self.mesh.triangle(f)).0.distance(x);
        let mut starts: BTreeMap<u32, (f64, FaceId)> = BTreeMap::new();
        for f in around.into_iter().filter(|f| *f != tried) {
            let here = (distance(f), f);
            let best = starts.entry(self.patches.of(f)).or_insert(here);
            if here.0 < best.0 {
                *best = here;
            }
        }
        let found = starts.values().filter_map(|&(_, f)| from(f));
        found.min_by(|a, b| a.distance(x).total_cmp(&b.distance(x)))
    }
}

/// The point nearest to `x` at least `r` in front of every plane, and which of them hold it: of all points held by at most
/// three, the nearest that is in front of the rest.
fn nearest_in_front(x: DVec3, r: f64, planes: &[Plane]) -> Option<(DVec3, Vec<bool>)> {
    let depth: Vec<f64> = planes.iter().map(|p| r - p.normal.dot(x - p.foot)).collect();
    let slack = 1e-10 * r;
    let clear = |c: DVec3| planes.iter().all(|p| p.normal.dot(c - p.foot) >= r - slack);
    let n = planes.len();
    let mut best: Option<(f64, DVec3, [usize; 3])> = None;
    let mut consider = |c: DVec3, held: [usize; 3]| {
        let d = c.distance_squared(x);
        if c.is_finite() && best.is_none_or(|b| d < b.0) && clear(c) {
            best = Some((d, c, held));
        }
    };
    consider(x, [n; 3]);
    for i in 0..n {
        let a = planes[i].normal;
        consider(x + depth[i] * a, [i, n, n]);
        for j in i + 1..n {
            let b = planes[j].normal;
            let ab = a.dot(b);
            let det = 1.0 - ab * ab;
            if det > 1e-12 {
                let (s, t) = ((depth[i] - ab * depth[j]) / det, (depth[j] - ab * depth[i]) / det);
                consider(x + s * a + t * b, [i, j, n]);
            }
            for k in j + 1..n {
                let c = planes[k].normal;
                let rows = DMat3::from_cols(a, b, c).transpose();
                if rows.determinant().abs() > 1e-9 {
                    consider(x + rows.inverse() * DVec3::new(depth[i], depth[j], depth[k]), [i, j, k]);
                }
            }
        }
    }
    best.map(|(_, c, held)| (c, (0..n).map(|i| held.contains(&i)).collect()))
}
