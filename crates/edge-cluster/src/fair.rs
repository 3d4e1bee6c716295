//! Fair places for control points that are free along a line, in a plane or in space.

use crate::plane::Flat;
use glam::DVec3;

/// Where the control points go that nobody placed: the net of springs over `links` in equilibrium, every point held to
/// its flat. `anchors` pull with `strength` times the stiffness of all springs at a point.
///
/// A spring between points at distance d has energy d², so the net is the flattest that the flats allow: along a side
/// that turns by θ at a vertex, the inner points of a cubic sit at 1/(2 + cos θ) of the way to its ends. The system is
/// linear, and solved by conjugate gradients to rounding; O(links · √points).
pub fn settle(flats: &[Flat], links: &[[u32; 2]], anchors: &[(DVec3, f64)]) -> Vec<DVec3> {
    let mut stiffness = vec![0.0; flats.len()];
    for &[a, b] in links {
        stiffness[a as usize] += 1.0;
        stiffness[b as usize] += 1.0;
    }
    // The force at each point, within its flat, of the net `x` while its anchors are at `pull`.
    let force = |x: &[DVec3], pull: &dyn Fn(usize) -> DVec3| -> Vec<DVec3> {
        let mut sum: Vec<DVec3> = (0..x.len()).map(|i| anchors[i].1 * stiffness[i] * (pull(i) - x[i])).collect();
        for &[a, b] in links {
            let d = x[b as usize] - x[a as usize];
            sum[a as usize] += d;
            sum[b as usize] -= d;
        }
        sum.iter().zip(flats).map(|(&f, flat)| flat.along(f)).collect()
    };
    let dot = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
    let mut x: Vec<DVec3> = flats.iter().zip(anchors).map(|(flat, a)| flat.nearest(a.0)).collect();
    let mut residual = force(&x, &|i| anchors[i].0);
    let mut step = residual.clone();
    let start = dot(&residual, &residual);
    let mut now = start;
    for _ in 0..10 * flats.len().max(10) {
        // Relative to the forces at the start, so that lengths do not matter.
        if now <= 1e-30 * start || now == 0.0 {
            break;
        }
        let answer = force(&step, &|_| DVec3::ZERO);
        let length = now / -dot(&step, &answer);
        if !length.is_finite() {
            break;
        }
        for i in 0..x.len() {
            x[i] += length * step[i];
            residual[i] += length * answer[i];
        }
        let next = dot(&residual, &residual);
        for i in 0..x.len() {
            step[i] = residual[i] + next / now * step[i];
        }
        now = next;
    }
    // Rounding has let the points drift off their flats by a few units in the last place.
    x.iter().zip(flats).map(|(&p, flat)| flat.nearest(p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cubic around a right angle: the inner points are half-way, by hand.
    #[test]
    fn a_corner_is_rounded_half_way() {
        let line = |axis: DVec3| {
            let v = axis.any_orthonormal_vector();
            Flat { origin: DVec3::ZERO, axes: [axis, v, axis.cross(v)], dimension: 1 }
        };
        let flats = [Flat::point(DVec3::X), line(DVec3::X), line(DVec3::Y), Flat::point(DVec3::Y)];
        let net = settle(&flats, &[[0, 1], [1, 2], [2, 3]], &[(DVec3::ZERO, 0.0); 4]);
        assert!(net[1].distance(0.5 * DVec3::X) < 1e-14 && net[2].distance(0.5 * DVec3::Y) < 1e-14, "{net:?}");
        let tight = settle(&flats, &[[0, 1], [1, 2], [2, 3]], &[(DVec3::ZERO, 9.0); 4]);
        assert!(tight[1].length() < 0.1 && tight[0] == DVec3::X);
    }
}
