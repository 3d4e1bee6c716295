//! Folds of the sweep removed by stepping back on both sides and bridging the gap.
//!
//! Where a ball turns about a third contact, or the spine bends more tightly than the ball, a profile can fall behind
//! its predecessor. \[Liu2005\] §4.3 cuts the loop out, steps back to points where the sweep advances again and bridges
//! them; this is that method for whole profiles, so that spine and both linkages are mended at once.

use crate::curve::Convexity;
use crate::fair::Sample;
use glam::DVec3;

/// Points of a profile at which its advance is judged, feet included.
const ROWS: usize = 5;

/// Samples without those whose profiles fall back; the cells that bridge the gaps advance at every row. Gaps longer
/// than `longest` are left as they are, for the caller to make the ball smaller there.
pub(crate) fn regress(samples: &[Sample], closed: bool, convexity: Convexity, longest: f64) -> Vec<Sample> {
    let n = samples.len();
    let rows: Vec<[DVec3; ROWS]> = samples.iter().map(profile).collect();
    let advances = |i: usize, j: usize| {
        let side = match convexity {
            Convexity::Concave => 1.0,
            Convexity::Convex => -1.0,
        };
        cell_advances(&rows[i], &rows[j], samples[i].center.midpoint(samples[j].center), side)
    };
    let mut dropped = vec![false; n];
    for i in 0..if closed { n } else { n.saturating_sub(1) } {
        let next = (i + 1) % n;
        if dropped[i] || dropped[next] || advances(i, next) {
            continue;
        }
        if let Some((back, ahead)) =
            bridge(samples, closed, i, longest, |a, b| !dropped[a] && !dropped[b] && advances(a, b))
        {
            for k in 1..=back + ahead {
                dropped[(i + n - back + k) % n] = true;
            }
        }
    }
    samples.iter().zip(&dropped).filter(|(_, gone)| !**gone).map(|(s, _)| *s).collect()
}

/// The shortest bridge over the cell from `i`: how far to step back before it and ahead after it.
fn bridge(
    samples: &[Sample],
    closed: bool,
    i: usize,
    longest: f64,
    advances: impl Fn(usize, usize) -> bool,
) -> Option<(usize, usize)> {
    let n = samples.len();
    for steps in 1..n.saturating_sub(8).min(200) {
        let mut within = false;
        // Balanced bridges first: they change each side least.
        for k in 0..=steps {
            let back = if k % 2 == 0 { steps / 2 + k / 2 } else { steps / 2 - k.div_ceil(2).min(steps / 2) };
            let Some(ahead) = steps.checked_sub(back) else { continue };
            if !closed && (back > i || i + 1 + ahead >= n) {
                continue;
            }
            let (a, b) = ((i + n - back) % n, (i + 1 + ahead) % n);
            if samples[a].center.distance(samples[b].center) > longest {
                continue;
            }
            within = true;
            if advances(a, b) {
                return Some((back, ahead));
            }
        }
        if !within {
            return None;
        }
    }
    None
}

/// Points of the profile on (about) the ball, from the left foot to the right one.
fn profile(s: &Sample) -> [DVec3; ROWS] {
    let arms = s.feet.map(|f| f.point - s.center);
    let lengths = arms.map(DVec3::length);
    std::array::from_fn(|k| {
        let u = k as f64 / (ROWS - 1) as f64;
        let direction = (arms[0] / lengths[0]).lerp(arms[1] / lengths[1], u).normalize_or_zero();
        s.center + (lengths[0] + u * (lengths[1] - lengths[0])) * direction
    })
}

/// Whether the surface between two profiles shows its front to the ball's side everywhere. Cells without extent, where
/// a foot rests, pass.
fn cell_advances(from: &[DVec3; ROWS], to: &[DVec3; ROWS], center: DVec3, side: f64) -> bool {
    (0..ROWS - 1).all(|k| {
        [[to[k], from[k], from[k + 1]], [to[k], from[k + 1], to[k + 1]]].iter().all(|[a, b, c]| {
            let normal = (b - a).cross(c - a);
            let front = side * (center - (a + b + c) / 3.0);
            let height = normal.length() / (c - b).length().max((c - a).length());
            height < 1e-6 * front.length() || normal.dot(front) > 0.05 * normal.length() * front.length()
        })
    })
}
