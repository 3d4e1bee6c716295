//! The exact rolling ball between planes, spheres and cylinders.
//!
//! The ball's centre runs where both shapes' signed distances are ±r: a circle when both are shapes of revolution about
//! one axis, and for two perpendicular cylinders a curve with a closed form. The blend is the set of points at distance
//! r from it, the canal surface between the two feet.

use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;

/// A part's exact surface, in the case's own frame.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// z = 0, the solid below.
    Plane,
    /// Around the point (0, 0, z).
    Sphere { z: f64, radius: f64 },
    /// Around an axis through the origin.
    Cylinder { axis: DVec3, radius: f64 },
}

impl Shape {
    /// Signed distance, negative inside, and its gradient.
    pub fn distance(&self, p: DVec3) -> (f64, DVec3) {
        let around = |v: DVec3, radius: f64| (v.length() - radius, v.normalize());
        match *self {
            Self::Plane => (p.z, DVec3::Z),
            Self::Sphere { z, radius } => around(p - z * DVec3::Z, radius),
            Self::Cylinder { axis, radius } => around(p.reject_from_normalized(axis), radius),
        }
    }
}

/// The ball's way.
#[derive(Clone, Copy, Debug)]
pub enum Spine {
    /// A circle around the z axis.
    Circle { z: f64, radius: f64 },
    /// Where a cylinder of radius `a` about x meets one of radius `b` ≥ `a` about z, on the side x > 0 or on both.
    Cylinders { a: f64, b: f64, both: bool },
}

impl Spine {
    fn nearest(&self, p: DVec3) -> DVec3 {
        match *self {
            Self::Circle { z, radius } => {
                let flat = p.with_z(0.0).normalize();
                (radius * flat).with_z(z)
            }
            Self::Cylinders { a, b, both } => {
                let mirror = if both && p.x < 0.0 { -1.0 } else { 1.0 };
                let at = |t: f64| {
                    let (sin, cos) = t.sin_cos();
                    DVec3::new(mirror * (b * b - a * a * cos * cos).max(0.0).sqrt(), a * cos, a * sin)
                };
                let gap = |t: f64| at(t).distance_squared(p);
                let step = TAU / f64::from(COARSE);
                let best = (0..COARSE)
                    .map(|i| step * f64::from(i))
                    .min_by(|&s, &t| gap(s).total_cmp(&gap(t)))
                    .unwrap_or_default();
                // Golden section: the two neighbours bracket the nearest point, also where the curve has a kink.
                let golden = 0.5 * (5.0f64.sqrt() - 1.0);
                let (mut low, mut high) = (best - step, best + step);
                for _ in 0..60 {
                    let (s, t) = (high - golden * (high - low), low + golden * (high - low));
                    if gap(s) < gap(t) { high = t } else { low = s }
                }
                at(0.5 * (low + high))
            }
        }
    }
}

/// The exact blend of one case.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Surfaces of parts a and b.
    pub shapes: [Shape; 2],
    /// +1 where the ball is outside the part, −1 where inside.
    pub sides: [f64; 2],
    pub radius: f64,
    pub spine: Spine,
    /// From the case's frame to the world.
    pub pose: DAffine3,
}

/// What the exact blend is like near a point.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Distance from the point to the spine.
    pub distance: f64,
    /// From the ball's centre to its feet on a and b, unit length, in the world.
    pub to_feet: [DVec3; 2],
    /// From the ball's centre to the point, unit length, in the world.
    pub to_point: DVec3,
}

impl Near {
    /// cos(φ/2), φ the angle between the feet.
    pub fn half_cosine(&self) -> f64 {
        (0.5 * (1.0 + self.to_feet[0].dot(self.to_feet[1]))).max(0.0).sqrt()
    }
}

impl Truth {
    pub fn near(&self, world: DVec3) -> Near {
        let p = self.pose.inverse().transform_point3(world);
        let center = self.spine.nearest(p);
        let to_feet = [0, 1].map(|i| {
            let (d, gradient) = self.shapes[i].distance(center);
            // The closed form of the spine against the shapes themselves.
            assert!((d - self.sides[i] * self.radius).abs() < 1e-9, "the truth is wrong: {d} at {center}");
            self.pose.transform_vector3(-self.sides[i] * gradient)
        });
        Near { distance: center.distance(p), to_feet, to_point: self.pose.transform_vector3((p - center).normalize()) }
    }

    /// Signed distance of `world` to the surface of `part`.
    pub fn part_distance(&self, part: usize, world: DVec3) -> f64 {
        self.shapes[part].distance(self.pose.inverse().transform_point3(world)).0
    }
}

/// Samples of a spine before the nearest is polished.
const COARSE: u32 = 256;
