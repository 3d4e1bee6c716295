//! The ball outside the whole surface whose centre is nearest to a point, and where it wants that point to be.

use super::sides::{Seen, Sides};
use glam::{DMat3, DVec3};
use mesh_core::FaceId;
use spine::RadiusField;

/// Distances to the surface must not fall short of the radius by more than this share of it.
const TOUCHES: f64 = 1e-4;
/// Cutting planes are renewed so often. Flat contacts are exact at once; edges and vertices turn their planes as the
/// ball moves.
const STEPS: usize = 20;
/// Contacts kept at a time.
const CONTACTS: usize = 12;

/// Where the blend passes near `p`: on the ball nearest to `p` of all that stay outside both sides. Where that ball
/// rests on the side below `p` alone, this is the side itself. `None` where no such ball is found.
pub(crate) fn target(sides: &Sides<'_>, radius: &RadiusField, p: DVec3) -> Option<DVec3> {
    let r = radius.at(p).0;
    let center = nearest_center(sides, r, p)?;
    let way = p - center;
    (way.length() > 0.3 * r).then(|| center + r * way.normalize_or_zero())
}

/// The centre nearest to `p` of a ball of radius `r` that stays outside both sides, by cutting planes: the nearest
/// features of both sides at the present centre are contacts, each keeps the centre beyond a plane at distance `r`, and
/// the next centre is the point nearest to `p` beyond all planes.
pub(crate) fn nearest_center(sides: &Sides<'_>, r: f64, p: DVec3) -> Option<DVec3> {
    let seen = [sides.seen(0, p)?, sides.seen(1, p)?];
    let near = if seen[0].distance.abs() <= seen[1].distance.abs() { seen[0] } else { seen[1] };
    let mut s = near.foot + r * near.normal;
    let mut contacts: Vec<FaceId> = Vec::with_capacity(CONTACTS);
    let mut planes: Vec<Plane> = Vec::with_capacity(CONTACTS);
    for _ in 0..STEPS {
        let here = [sides.seen(0, s)?, sides.seen(1, s)?];
        let depth = here.iter().map(|h| r - h.distance).fold(0.0, f64::max);
        for h in here.iter().filter(|h| h.distance < (1.0 + 1e-3) * r) {
            if !contacts.contains(&h.face) {
                contacts.push(h.face);
            }
        }
        planes.clear();
        planes.extend(contacts.iter().map(|&f| Plane::below(&sides.seen_on(f, s), r)));
        if contacts.len() > CONTACTS {
            // The farthest says least.
            let slack = |i: &usize| planes[*i].slack(s);
            let far = (0..planes.len()).max_by(|a, b| slack(a).total_cmp(&slack(b)))?;
            contacts.swap_remove(far);
            planes.swap_remove(far);
        }
        let step = nearest_beyond(&planes, p, 1e-9 * r)? - s;
        if depth < TOUCHES * r && step.length() < 1e-3 * r {
            return Some(s + step);
        }
        s += step.clamp_length_max(r);
        if s.distance(near.foot) >= 12.0 * r || !s.is_finite() {
            return None;
        }
    }
    None
}

/// The half-space `normal · x ≥ offset`.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    /// Beyond the plane a ball is at least `r` from what is seen, as far as one direction tells.
    fn below(seen: &Seen, r: f64) -> Self {
        Self { normal: seen.gradient, offset: seen.gradient.dot(seen.foot) + r }
    }

    fn slack(&self, x: DVec3) -> f64 {
        self.normal.dot(x) - self.offset
    }
}

/// The point nearest to `p` beyond all planes: the first choice of up to three of them that all push outwards and
/// satisfy the others. `None` if there is no such point.
fn nearest_beyond(planes: &[Plane], p: DVec3, tolerance: f64) -> Option<DVec3> {
    let n = planes.len();
    let meets = |x: DVec3| planes.iter().all(|h| h.slack(x) >= -tolerance);
    if meets(p) {
        return Some(p);
    }
    let short = |i: usize| -planes[i].slack(p);
    let normal = |i: usize| planes[i].normal;
    for i in (0..n).filter(|&i| short(i) >= 0.0) {
        let x = p + short(i) * normal(i);
        if meets(x) {
            return Some(x);
        }
    }
    for i in 0..n {
        for j in i + 1..n {
            let c = normal(i).dot(normal(j));
            let det = 1.0 - c * c;
            let (a, b) = (short(i) - c * short(j), short(j) - c * short(i));
            if det < 1e-6 || a < 0.0 || b < 0.0 {
                continue;
            }
            let x = p + (a * normal(i) + b * normal(j)) / det;
            if meets(x) {
                return Some(x);
            }
        }
    }
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let normals = DMat3::from_cols(normal(i), normal(j), normal(k));
                let gram = normals.transpose() * normals;
                if gram.determinant() < 1e-7 {
                    continue;
                }
                let push = gram.inverse() * DVec3::new(short(i), short(j), short(k));
                if push.min_element() < 0.0 {
                    continue;
                }
                let x = p + normals * push;
                if meets(x) {
                    return Some(x);
                }
            }
        }
    }
    None
}

/// Whether a ball that touches both sides is found near `p`.
pub(crate) fn touches_both(sides: &Sides<'_>, radius: &RadiusField, p: DVec3) -> bool {
    let r = radius.at(p).0;
    let touches = |c: DVec3| (0..2).all(|k| sides.distance(k, c) < (1.0 + 1e-2) * r);
    nearest_center(sides, r, p).is_some_and(touches)
}
