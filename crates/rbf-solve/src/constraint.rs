//! What a field is asked to satisfy.

use glam::DVec3;

/// One thing a field must satisfy: its value at a point, and where given its gradient there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// Where, in model units.
    pub point: DVec3,
    /// The value there, in model units: zero on the surface, negative inside.
    pub value: f64,
    /// The gradient there. The outward normal on a surface.
    pub gradient: Option<DVec3>,
}

impl Constraint {
    /// The surface passes through `point`.
    pub const fn on_surface(point: DVec3) -> Self {
        Self { point, value: 0.0, gradient: None }
    }

    /// The field is `value` at `point`.
    pub const fn off_surface(point: DVec3, value: f64) -> Self {
        Self { point, value, gradient: None }
    }

    /// The surface passes through `point` with outward unit normal `normal`. Needs [`crate::Kernel::Triharmonic`].
    pub const fn with_normal(point: DVec3, normal: DVec3) -> Self {
        Self { point, value: 0.0, gradient: Some(normal) }
    }
}
