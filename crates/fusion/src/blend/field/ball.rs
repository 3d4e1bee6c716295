//! The ball in contact with both sides that is nearest to a point, and where it wants that point to be.

use super::sides::Sides;
use glam::DVec3;
use spine::RadiusField;

/// Distances to both sides must be the radius up to this share of it.
const TOUCHES: f64 = 1e-4;
/// Steps of Newton's method.
const STEPS: usize = 12;

/// Where the blend passes near `p`: on the ball that touches both sides if `p` lies between its feet, on the side
/// itself beyond them. `None` where no such ball is found.
///
/// The ball starts where it would touch the nearer side below `p` and the plane that the other one shows it, which is
/// exact between planes at any angle. Then both distances are made equal to the radius, in the plane of their
/// gradients, and the ball is slid along its way until it is abreast of `p`.
pub(crate) fn target(sides: &Sides<'_>, radius: &RadiusField, p: DVec3) -> Option<DVec3> {
    let seen = [sides.seen(0, p)?, sides.seen(1, p)?];
    let near = if seen[0].distance.abs() <= seen[1].distance.abs() { seen[0] } else { seen[1] };
    let r = radius.at(p).0;
    let mut s = near.foot + r * near.normal;
    for step in 0..STEPS {
        let [a, b] = [sides.seen(0, s)?, sides.seen(1, s)?];
        let (da, db) = (r - a.distance, r - b.distance);
        let off = da.abs().max(db.abs()) / r;
        let along = a.gradient.cross(b.gradient);
        let det = along.length_squared();
        let tangent = along.normalize_or_zero();
        let aside = (p - s).dot(tangent);
        if off < TOUCHES && (aside.abs() < 1e-3 * r || step + 1 == STEPS) {
            return seat(p, s, r, [a.foot, b.foot], [seen[0].foot, seen[1].foot]);
        }
        if det < 1e-4 {
            return None;
        }
        let c = a.gradient.dot(b.gradient);
        let both = ((da - c * db) * a.gradient + (db - c * da) * b.gradient) / det;
        s += both.clamp_length_max(0.7 * r);
        if step + 3 < STEPS {
            s += aside.clamp(-0.5 * r, 0.5 * r) * tangent;
        }
        if s.distance(near.foot) >= 12.0 * r || !s.is_finite() {
            return None;
        }
    }
    None
}

/// Where `p` belongs, given the ball's centre, its feet, and the points of the sides nearest to `p`.
fn seat(p: DVec3, center: DVec3, r: f64, feet: [DVec3; 2], below: [DVec3; 2]) -> Option<DVec3> {
    let [u, v] = feet.map(|f| (f - center) / r);
    let w = p - center;
    // w = α·u + β·v + something along the ball's way.
    let c = u.dot(v);
    let det = 1.0 - c * c;
    let (wu, wv) = (w.dot(u), w.dot(v));
    let (alpha, beta) = ((wu - c * wv) / det, (wv - c * wu) / det);
    if alpha < 0.0 && beta < 0.0 {
        return None;
    }
    // Beyond a foot there is the side itself.
    if beta < 0.0 {
        return Some(below[0]);
    }
    if alpha < 0.0 {
        return Some(below[1]);
    }
    (w.length() > 0.3 * r).then(|| center + r * w.normalize_or_zero())
}
