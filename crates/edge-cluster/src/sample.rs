//! How densely curves are sampled: as their curvature asks for.

use glam::DVec3;

/// Places at which curvature is looked at.
const LOOKS: usize = 24;
/// Curvature between the looks may be greater.
const SAFETY: f64 = 0.8;

/// A curve over [0, 1], at many places at once.
pub type Curve<'a> = &'a dyn Fn(&[f64]) -> Vec<DVec3>;

/// Shares in [0, 1], from 0 to 1, at which to cut a curve so that its chords stay within `tolerance`. The density of
/// cuts is the greatest that any of `curves` asks for at each place; nowhere less than a quarter of the mean.
pub fn shares(curves: &[Curve<'_>], tolerance: f64, least: usize) -> Vec<f64> {
    let step = 1.0 / LOOKS as f64;
    let looks: [f64; 2 * LOOKS + 1] = std::array::from_fn(|i| 0.5 * step * i as f64);
    let mut density = [0.0f64; LOOKS];
    for curve in curves {
        let points = curve(&looks);
        for (i, d) in density.iter_mut().enumerate() {
            // |x″| h² from the two halves of the interval; a chord over 1/n of it is off by that over 8 n².
            let bend = (points[2 * i] - 2.0 * points[2 * i + 1] + points[2 * i + 2]).length() * 4.0;
            *d = d.max((bend / (8.0 * SAFETY * tolerance)).sqrt());
        }
    }
    cuts(&density, least)
}

/// Cuts the unit interval so that every piece holds the same share of a density that is constant on equal parts of it;
/// `density` counts pieces per part.
pub fn cuts(density: &[f64], least: usize) -> Vec<f64> {
    const MOST: f64 = 4096.0;
    let parts = density.len() as f64;
    let mean = density.iter().sum::<f64>() / parts;
    // What little curvature a straight line has by rounding must not decide.
    let raised: Vec<f64> = density.iter().map(|&d| d.max(0.25 * mean).max(1e-3)).collect();
    let total: f64 = raised.iter().sum();
    let count = (total.min(MOST).ceil() as usize).max(least.max(1));
    let mut all = Vec::with_capacity(count + 1);
    let (mut part, mut before) = (0, 0.0);
    for i in 0..=count {
        let goal = total * i as f64 / count as f64;
        while part + 1 < raised.len() && before + raised[part] < goal {
            before += raised[part];
            part += 1;
        }
        all.push(((part as f64 + (goal - before) / raised[part]) / parts).clamp(0.0, 1.0));
    }
    // The ends are exact, so that neighbours agree on them.
    all[0] = 0.0;
    all[count] = 1.0;
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_of_an_ellipse_stay_within_tolerance() {
        let ellipse = |t: f64| DVec3::new(3.0 * (6.2 * t).cos(), (6.2 * t).sin(), 0.0);
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let cut = shares(&[&|at: &[f64]| at.iter().map(|&t| ellipse(t)).collect()], tolerance, 1);
            let off = cut.windows(2).map(|w| {
                let middle = ellipse(0.5 * (w[0] + w[1]));
                middle.distance(0.5 * (ellipse(w[0]) + ellipse(w[1])))
            });
            let worst = off.fold(0.0, f64::max);
            assert!(worst < tolerance && worst > 0.3 * tolerance, "{worst} {tolerance}");
        }
        let straight = shares(&[&|at: &[f64]| at.iter().map(|&t| t * DVec3::X).collect()], 1e-3, 4);
        assert!((0..=4).all(|i| (straight[i] - 0.25 * i as f64).abs() < 1e-12), "{straight:?}");
    }

    #[test]
    fn cuts_rise_strictly() {
        let cut = cuts(&[0.0, 0.0, 9.0, 0.0, 5.0], 2);
        assert!(cut.windows(2).all(|w| w[0] < w[1]) && cut[0] == 0.0 && cut.last() == Some(&1.0));
    }
}
