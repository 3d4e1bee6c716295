//! Mean value weights, which are positive for any triangles.

use crate::cotangent::{NARROWEST, widened};
use glam::DVec3;

/// The weights of a triangle's first corner towards the second and third: half of tan(α/2) over each side's length, α the angle at the
/// corner (\[Floater2003\]). One over model units, positive and finite: the crate's rule for degenerate faces bounds the angle and the
/// sides; 0 where all corners coincide or one is not finite.
pub(crate) fn corner_weights(p: [DVec3; 3]) -> [f64; 2] {
    let (u, v) = (p[1] - p[0], p[2] - p[0]);
    let longest = u.length_squared().max(v.length_squared()).max(p[1].distance_squared(p[2])).sqrt();
    let half = (0.5 * widened(p).atan2(u.dot(v))).tan();
    [u, v].map(|side| {
        let weight = half / side.length().max(NARROWEST * longest);
        if weight.is_finite() { weight } else { 0.0 }
    })
}
