//! Primitives that parts ride on: a pose is a place of the primitive's parameter domain, a spin and an offset, and follows when the primitive
//! is resized (\[Lin2008\] §4.1).

use glam::{DMat3, DQuat, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A box, cylinder, sphere or truncated cone in its own coordinates. All but the sphere stand on the origin and rise along z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    /// Extents along x, y and z.
    Box(DVec3),
    /// Radii at the base and at the top, and the height. A cylinder where they are equal.
    Cone([f64; 2], f64),
    /// Radius, about the origin.
    Sphere(f64),
}

/// A rigid motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    pub(crate) rotation: DQuat,
    pub(crate) translation: DVec3,
}

impl Motion {
    pub(crate) const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// From coordinates with the given unit axes x and z, z the leading one, at a point.
    fn to_axes(point: DVec3, x: DVec3, z: DVec3) -> Self {
        let x = (x - x.dot(z) * z).try_normalize().unwrap_or_else(|| z.any_orthonormal_vector());
        Self { rotation: DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize(), translation: point }
    }

    /// The shortest turn that takes z to `axis`, and then to a point.
    pub(crate) fn along(axis: DVec3, point: DVec3) -> Self {
        Self { rotation: DQuat::from_rotation_arc(DVec3::Z, axis), translation: point }
    }

    /// This motion after another.
    pub(crate) fn after(self, first: Self) -> Self {
        Self { rotation: self.rotation * first.rotation, translation: self.point(first.translation) }
    }

    pub(crate) fn point(self, p: DVec3) -> DVec3 {
        self.rotation * p + self.translation
    }
}

impl Shape {
    /// The frame at (u, v) of the parameter domain: z out of the surface, x along growing u, y along growing v.
    ///
    /// u counts turns from the x axis, once round from 0 to 1, on a box by the length of its outline. v goes from 0 at the base to 1 at the top; on
    /// to 2 it goes over the top to its middle, and down to −1 over the base. On a sphere v goes from pole to pole.
    pub(crate) fn frame(self, u: f64, v: f64) -> Motion {
        let (sin, cos) = (TAU * u).sin_cos();
        let (radial, around) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
        match self {
            Self::Sphere(radius) => {
                let latitude = PI * (v.clamp(0.0, 1.0) - 0.5);
                let normal = latitude.cos() * radial + latitude.sin() * DVec3::Z;
                Motion::to_axes(radius * normal, around, normal)
            }
            Self::Cone([base, top], height) => {
                let (share, end) = spread(v);
                let radius = base + (top - base) * end;
                let point = share * radius * radial + height * end * DVec3::Z;
                let slope = (height * radial + (base - top) * DVec3::Z).normalize_or(radial);
                Motion::to_axes(point, around, over(v, slope))
            }
            Self::Box(size) => {
                let (share, end) = spread(v);
                let (rim, side) = outline(size.truncate(), u);
                let point = (share * rim).extend(size.z * end);
                let out = side.extend(0.0);
                Motion::to_axes(point, DVec3::Z.cross(out), over(v, out))
            }
        }
    }

    /// The (u, v) whose place is nearest to a point, to within a step of a grid and some halvings of it.
    pub(crate) fn nearest(self, p: DVec3) -> (f64, f64) {
        const STEPS: i32 = 48;
        let (low, high) = if matches!(self, Self::Sphere(_)) { (0.0, 1.0) } else { (-1.0, 2.0) };
        let far = |(u, v): (f64, f64)| self.frame(u, v).translation.distance_squared(p);
        let nearer = |a: (f64, f64), b: (f64, f64)| if far(b) < far(a) { b } else { a };
        let grid = (0..STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j)));
        let grid =
            grid.map(|(i, j)| (f64::from(i) / f64::from(STEPS), low + (high - low) * f64::from(j) / f64::from(STEPS)));
        let mut best = grid.reduce(nearer).unwrap_or_default();
        let mut step = 1.0 / f64::from(STEPS);
        for _ in 0..160 {
            let (u, v) = best;
            let around = [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)];
            let found = around.map(|(a, b)| (u + a, (v + b).clamp(low, high))).into_iter().fold(best, nearer);
            if found == best {
                step *= 0.5;
            }
            best = found;
        }
        best
    }
}

/// For v below 0 and above 1: the share of the way out from the middle, and the end it is at.
fn spread(v: f64) -> (f64, f64) {
    let v = v.clamp(-1.0, 2.0);
    if v > 1.0 {
        (2.0 - v, 1.0)
    } else if v < 0.0 {
        (1.0 + v, 0.0)
    } else {
        (1.0, v)
    }
}

/// The normal at v: that of the side, or up or down.
fn over(v: f64, side: DVec3) -> DVec3 {
    if v > 1.0 {
        DVec3::Z
    } else if v < 0.0 {
        DVec3::NEG_Z
    } else {
        side
    }
}

/// The place a share u round a rectangle, from the middle of its side on the right, and that side's normal.
fn outline(size: DVec2, u: f64) -> (DVec2, DVec2) {
    let mut left = (u - u.floor()) * 2.0 * (size.x + size.y);
    let half = 0.5 * size;
    let sides = [
        (DVec2::new(half.x, 0.0), DVec2::Y, half.y, DVec2::X),
        (DVec2::new(half.x, half.y), DVec2::NEG_X, size.x, DVec2::Y),
        (DVec2::new(-half.x, half.y), DVec2::NEG_Y, size.y, DVec2::NEG_X),
        (DVec2::new(-half.x, -half.y), DVec2::X, size.x, DVec2::NEG_Y),
        (DVec2::new(half.x, -half.y), DVec2::Y, half.y, DVec2::X),
    ];
    for (from, along, length, normal) in sides {
        if left < length {
            return (from + left * along, normal);
        }
        left -= length;
    }
    (sides[0].0, DVec2::X)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPES: [Shape; 4] = [
        Shape::Box(DVec3::new(2.0, 3.0, 4.0)),
        Shape::Cone([2.0, 1.0], 3.0),
        Shape::Cone([1.5, 1.5], 2.0),
        Shape::Sphere(1.3),
    ];

    fn inside(shape: Shape, p: DVec3) -> bool {
        match shape {
            Shape::Box(s) => p.x.abs() < 0.5 * s.x && p.y.abs() < 0.5 * s.y && p.z > 0.0 && p.z < s.z,
            Shape::Cone([a, b], h) => p.z > 0.0 && p.z < h && p.truncate().length() < a + (b - a) * p.z / h,
            Shape::Sphere(r) => p.length() < r,
        }
    }

    /// Places lie on the surface, z leads out of it, and x and y follow the parameters.
    #[test]
    fn frames_stand_on_the_surface() {
        for shape in SHAPES {
            for i in 0..60u32 {
                let (u, v) = (f64::from(i) / 60.0 + 0.003, [-0.4f64, 0.1, 0.6, 0.93, 1.7][i as usize % 5]);
                let v = if matches!(shape, Shape::Sphere(_)) { v.clamp(0.05, 0.95) } else { v };
                let at = shape.frame(u, v);
                let step = 1e-4;
                assert!(
                    inside(shape, at.point(-step * DVec3::Z)) && !inside(shape, at.point(step * DVec3::Z)),
                    "{shape:?} {u} {v}"
                );
                let along = |du: f64, dv: f64| {
                    let moved = shape.frame(u + du, v + dv).translation - at.translation;
                    at.rotation.inverse() * moved.normalize_or_zero()
                };
                assert!(along(1e-6, 0.0).x > 0.999, "{shape:?} {u} {v} {}", along(1e-6, 0.0));
                // Over the top of a box v leads inward, not along y.
                if (0.0..=1.0).contains(&v) {
                    assert!(along(0.0, 1e-6).y > 0.999, "{shape:?} {u} {v}");
                }
                let (nu, nv) = shape.nearest(at.translation);
                assert!(
                    shape.frame(nu, nv).translation.distance(at.translation) < 1e-6,
                    "{shape:?} {u} {v}: {nu} {nv}"
                );
            }
        }
    }
}
