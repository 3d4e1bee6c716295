//! The order of contact between a patch and the planes around it, measured.

use crate::net::Net;
use crate::patch::Patch;

/// Distances inside the side, as shares of the way to the patch's middle, at which heights are compared.
const NEAR: [f64; 2] = [1.0 / 64.0, 1.0 / 128.0];
/// Heights below this share of the patch's own are rounding.
const ROUNDING: f64 = 1e-13;

/// How fast the surface leaves the plane of each side: the least slope of log height over log distance, at seven places
/// along the side. Contact of order g shows as g + 1, less a few hundredths. Infinite where the surface does not leave
/// the plane at all.
pub fn contact_slopes(net: &Net, patch: &Patch) -> Vec<f64> {
    let size = net.points.iter().map(|p| p.distance(net.points[0])).fold(0.0, f64::max);
    let slope = |k: usize, u: f64| {
        let edge = patch.side(k, u);
        let height = |share: f64| net.planes[k].height(patch.point(edge.lerp(patch.center(), share))).abs();
        let [far, near] = NEAR.map(height);
        if near <= ROUNDING * size { f64::INFINITY } else { (far / near).ln() / (NEAR[0] / NEAR[1]).ln() }
    };
    (0..patch.sides()).map(|k| (1..8).map(|i| slope(k, f64::from(i) / 8.0)).fold(f64::INFINITY, f64::min)).collect()
}
