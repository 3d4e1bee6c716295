//! The frame that boxes live in: centred on the mesh and scaled by a power of two into [−1, 1], so that `f32` serves
//! coordinates of any size and place.

use glam::{DVec3, Vec3A};
use mesh_core::Bounds;
use obvhs::aabb::Aabb;

/// Every box is wider than its triangle by at least this on each side: eight times the spacing of `f32` near 1, so
/// that rounding to nearest still rounds outward and `f64` rounding in queries needs no care of its own.
const PAD: f64 = 1.0 / (1 << 21) as f64;

/// Largest binary exponent of the scale; beyond it, tiny meshes merely use less of the range.
const MAX_EXPONENT: i32 = 1000;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) center: DVec3,
    /// Half of the longest side of the mesh's box, in model units.
    pub(crate) half: f64,
    /// Power of two.
    pub(crate) scale: f64,
}

impl Frame {
    /// The frame in which `bounds` fills [−1, 1] to within a factor of two.
    pub(crate) fn around(bounds: &Bounds) -> Self {
        if bounds.is_empty() {
            return Self { center: DVec3::ZERO, half: 0.0, scale: 1.0 };
        }
        let half = (0.5 * bounds.max - 0.5 * bounds.min).max_element();
        Self { center: bounds.center(), half, scale: inverse_power_of_two(half) }
    }

    /// Model coordinates to frame coordinates; relative rounding error 2⁻⁵³ in the distance from the centre.
    #[inline]
    pub(crate) fn local(&self, p: DVec3) -> DVec3 {
        (p - self.center) * self.scale
    }

    /// The padded box of a triangle. The pad is varied by up to a half with `face`: with all boxes alike (duplicated
    /// or evenly spaced triangles) every node would find its two neighbours equally good, and the builder would pair
    /// off one node per sweep.
    #[inline]
    pub(crate) fn box_of(&self, triangle: [DVec3; 3], face: u32) -> Aabb {
        let [a, b, c] = triangle.map(|p| self.local(p).as_vec3a());
        let noise = face.wrapping_mul(0x9E37_79B9) >> 16;
        let pad = Vec3A::splat((PAD * (1.0 + f64::from(noise) / f64::from(1 << 17))) as f32);
        Aabb { min: a.min(b).min(c) - pad, max: a.max(b).max(c) + pad }
    }
}

/// A power of two that brings `length` into [1/2, 1], as far as exponents reach; 1 for 0.
pub(crate) fn inverse_power_of_two(length: f64) -> f64 {
    if length == 0.0 {
        return 1.0;
    }
    // Unbiased exponent from the bits; subnormal numbers read as −1023, which the clamp takes care of.
    let exponent = ((length.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    let wanted = (-1 - exponent).clamp(-1022, MAX_EXPONENT);
    f64::from_bits(((wanted + 1023) as u64) << 52)
}
