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
/// rests on the side below `p` alone, this is the side itself. `None` where none is found.
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
/// satisfy the others. `None` if no point does.
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use mesh_core::{Connected, TriMesh, Watch, shapes};
    use spine::{BlendCurve, Convexity};
    use tri_intersect::{Boolean, Operation, Params, boolean};

    const R: f64 = 0.3;

    fn union(a: &TriMesh, b: &TriMesh) -> Boolean {
        let [a, b] = [a, b].map(|m| Connected::new(m.clone()).unwrap());
        boolean(&a, &b, Operation::Union, &Params::default(), &Watch::default()).unwrap()
    }

    /// Two crossed bars on a plate whose top is z = 0: four corners of three planes each.
    fn cross_on_plate() -> (Connected<TriMesh>, Vec<BlendCurve>) {
        let bar = |size: DVec3, z: f64| shapes::posed(shapes::cuboid(size), DQuat::IDENTITY, DVec3::new(0.0, 0.0, z));
        let cross = union(&bar(DVec3::new(4.0, 1.0, 2.0), 0.5), &bar(DVec3::new(1.0, 4.0, 2.4), 0.5)).mesh;
        let whole = union(&bar(DVec3::new(8.0, 8.0, 1.0), -0.5), &cross);
        let mesh = Connected::new(whole.mesh).unwrap();
        let curves = whole.seams.iter().map(|s| BlendCurve::from_vertices(&mesh, &s.vertices).unwrap()).collect();
        (mesh, curves)
    }

    #[test]
    fn in_a_corner_the_ball_rests_on_three_planes() {
        let (mesh, curves) = cross_on_plate();
        let sides = Sides::new(&mesh, &curves, Convexity::Concave).unwrap();
        for p in [DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.6, 0.5, 0.1), DVec3::new(0.55, 0.62, 0.0)] {
            let center = nearest_center(&sides, R, p).unwrap();
            assert!(center.distance(DVec3::new(0.8, 0.8, 0.3)) < 1e-6, "{p}: {center}");
        }
        let at = target(&sides, &RadiusField::constant(R), DVec3::new(0.5, 0.5, 0.0)).unwrap();
        assert!(at.distance(DVec3::new(0.8, 0.8, 0.3) - R / 3f64.sqrt() * DVec3::ONE) < 1e-6, "{at}");
    }

    /// Of all centres on a fine grid that keep a radius away from the surface, none is nearer.
    #[test]
    fn no_other_ball_outside_is_nearer() {
        let (mesh, curves) = cross_on_plate();
        let sides = Sides::new(&mesh, &curves, Convexity::Concave).unwrap();
        let (mut random, mut tried) = (1u32, 0);
        let mut unit = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(random >> 8) / f64::from(1u32 << 24)
        };
        for _ in 0..24 {
            // On the plate beside a wall, around the end of a bar, and on the wall.
            let p = match tried % 3 {
                0 => DVec3::new(0.5 + 1.4 * unit(), 0.5 + 0.25 * unit(), 0.0),
                1 => DVec3::new(2.0 + 0.25 * unit(), 0.6 * unit(), 0.0),
                _ => DVec3::new(0.5 + 1.4 * unit(), 0.5, 0.25 * unit()),
            };
            tried += 1;
            let center = nearest_center(&sides, R, p).unwrap();
            let clearance = |c: DVec3| sides.distance(0, c).min(sides.distance(1, c));
            assert!(clearance(center) > (1.0 - 1e-3) * R, "{p}: {center}");
            for i in 0..17 * 17 * 17 {
                let cell = DVec3::new(f64::from(i % 17), f64::from(i / 17 % 17), f64::from(i / 289)) - 8.0;
                let c = center + 0.08 * R * cell;
                let outside = c.z > 0.0 && (0..2).all(|k| sides.seen(k, c).unwrap().distance > 0.0);
                if outside && clearance(c) >= R {
                    assert!(c.distance(p) > center.distance(p) - 1e-3 * R, "{p}: {c} is nearer than {center}");
                }
            }
        }
    }
}
