//! The order of contact between a patch and the planes around it, measured.

use crate::net::Net;
use crate::patch::Patch;

/// Heights below this share of the patch's own size are rounding; distances are chosen so that contact of the order asked
/// for leaves heights well above it.
const ROUNDING: f64 = 1e-14;
const HEIGHT: f64 = 1e-11;

/// How fast the surface leaves the plane of each side: the slope of log height over log distance, the height being the
/// greatest of seven places along the side. Contact of order g shows as g + 1, less a few hundredths. Infinite where the
/// surface does not leave the plane at all.
pub fn contact_slopes(net: &Net, patch: &Patch) -> Vec<f64> {
    let size = net.points.iter().map(|p| p.distance(net.points[0])).fold(0.0, f64::max);
    // Distances inside the side, as shares of the way to the patch's middle.
    let near = HEIGHT.powf(1.0 / (net.continuity as f64 + 1.0)).min(0.05);
    let slope = |k: usize| {
        let height = |share: f64| {
            let at = |u: f64| patch.side(k, u).lerp(patch.center(), share);
            (1..8).map(|i| net.planes[k].height(patch.point(at(f64::from(i) / 8.0))).abs()).fold(0.0, f64::max)
        };
        let (far, near) = (height(2.0 * near), height(near));
        if near <= ROUNDING * size { f64::INFINITY } else { (far / near).log2() }
    };
    (0..patch.sides()).map(slope).collect()
}
