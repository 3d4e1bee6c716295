//! Smooth curves near drawn ones: Bézier curves of degree five, and closed curves.

use glam::DVec3;

/// Places at which drawn curves are followed.
const DENSE: usize = 128;
/// Pieces by which lengths along a Bézier curve are measured.
const PIECES: usize = 512;
/// Harmonics of a closed curve: enough for an outline with five bays.
const HARMONICS: usize = 5;

/// A Bézier curve of degree five.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bezier {
    pub control: [DVec3; 6],
}

/// Bernstein polynomials of degree five.
fn bernstein(u: f64) -> [f64; 6] {
    let v = 1.0 - u;
    [v.powi(5), 5.0 * u * v.powi(4), 10.0 * u * u * v.powi(3), 10.0 * u.powi(3) * v * v, 5.0 * u.powi(4) * v, u.powi(5)]
}

impl Bezier {
    /// The point at u in [0, 1].
    pub fn point(&self, u: f64) -> DVec3 {
        bernstein(u).iter().zip(self.control).map(|(b, c)| *b * c).sum()
    }

    /// The derivative at u.
    pub fn tangent(&self, u: f64) -> DVec3 {
        let v = 1.0 - u;
        let weights = [v.powi(4), 4.0 * u * v.powi(3), 6.0 * u * u * v * v, 4.0 * u.powi(3) * v, u.powi(4)];
        weights.iter().zip(self.control.windows(2)).map(|(b, c)| 5.0 * *b * (c[1] - c[0])).sum()
    }

    /// Points and derivatives evenly along the curve, about `spacing` apart, without the ends.
    pub fn uniform(&self, spacing: f64) -> Vec<(DVec3, DVec3)> {
        let parameter = |k: usize| k as f64 / PIECES as f64;
        let mut lengths = vec![0.0];
        for k in 0..PIECES {
            lengths.push(lengths[k] + self.point(parameter(k)).distance(self.point(parameter(k + 1))));
        }
        let total = lengths[PIECES];
        // Bounded, whatever the numbers.
        let count = (total / spacing).ceil().clamp(4.0, 400.0) as usize;
        let at = |s: f64| {
            let k = lengths.partition_point(|&l| l < s).clamp(1, PIECES);
            let t = (s - lengths[k - 1]) / (lengths[k] - lengths[k - 1]);
            (k as f64 - 1.0 + if t.is_finite() { t } else { 0.0 }) / PIECES as f64
        };
        (1..count)
            .map(|i| at(total * i as f64 / count as f64))
            .map(|u| (self.point(u), self.tangent(u)))
            .filter(|s| s.0.is_finite() && s.1.is_finite())
            .collect()
    }
}

/// The curve nearest to a polyline in the least squares, from its first point to its last, that leaves both with the given unit
/// tangents, each out of its end. Of the six control points four are fixed by that.
pub(super) fn through(polyline: &[DVec3], tangents: [DVec3; 2]) -> Bezier {
    let (points, length) = resampled(&spline(polyline, false), DENSE);
    let (from, to) = (points[0], points[DENSE - 1]);
    let reach = length / 5.0;
    let mut control = [from, from + reach * tangents[0], from, to, to + reach * tangents[1], to];
    let mut parameters: Vec<f64> = (0..DENSE).map(|i| i as f64 / (DENSE - 1) as f64).collect();
    for _ in 0..12 {
        let (mut a, mut b, mut c) = (0.0, 0.0, 0.0);
        let (mut p, mut q) = (DVec3::ZERO, DVec3::ZERO);
        for (&x, &u) in points.iter().zip(&parameters) {
            let w = bernstein(u);
            let rest = x - (w[0] * control[0] + w[1] * control[1] + w[4] * control[4] + w[5] * control[5]);
            (a, b, c) = (a + w[2] * w[2], b + w[2] * w[3], c + w[3] * w[3]);
            (p, q) = (p + w[2] * rest, q + w[3] * rest);
        }
        let det = a * c - b * b;
        control[2] = (c * p - b * q) / det;
        control[3] = (a * q - b * p) / det;
        // Each point to the nearest place of the new curve, by one step of Newton's method.
        let bezier = Bezier { control };
        for (&x, u) in points.iter().zip(&mut parameters) {
            let t = bezier.tangent(*u);
            let step = (x - bezier.point(*u)).dot(t) / t.length_squared();
            if step.is_finite() {
                *u = (*u + step.clamp(-0.05, 0.05)).clamp(0.0, 1.0);
            }
        }
    }
    Bezier { control }
}

/// Points and tangents about `spacing` apart along a smooth closed curve near a closed polyline, whose last point need not repeat
/// the first.
pub(super) fn closed_curve(polyline: &[DVec3], spacing: f64) -> Vec<(DVec3, DVec3)> {
    let n = DENSE;
    let mut ring = polyline.to_vec();
    let length: f64 = ring.windows(2).map(|w| w[0].distance(w[1])).sum();
    while ring.len() > 3 && ring[0].distance(ring[ring.len() - 1]) <= 0.02 * length {
        ring.pop();
    }
    let (points, length) = resampled(&spline(&ring, true), n + 1);
    let angle = |k: usize, t: f64| std::f64::consts::TAU * k as f64 * t;
    let mut waves = [(DVec3::ZERO, DVec3::ZERO); HARMONICS + 1];
    for (k, wave) in waves.iter_mut().enumerate() {
        for (i, &p) in points[..n].iter().enumerate() {
            let (sin, cos) = angle(k, i as f64 / n as f64).sin_cos();
            let weight = if k == 0 { 1.0 } else { 2.0 } / n as f64;
            *wave = (wave.0 + weight * cos * p, wave.1 + weight * sin * p);
        }
    }
    let count = (length / spacing).ceil().clamp(8.0, 400.0) as usize;
    let at = |i: usize| {
        let t = i as f64 / count as f64;
        let (mut point, mut tangent) = (DVec3::ZERO, DVec3::ZERO);
        for (k, (a, b)) in waves.iter().enumerate() {
            let (sin, cos) = angle(k, t).sin_cos();
            point += cos * a + sin * b;
            tangent += k as f64 * (cos * b - sin * a);
        }
        (point, tangent)
    };
    (0..count).map(at).filter(|s| s.0.is_finite() && s.1.is_finite()).collect()
}

/// A denser polyline along the centripetal Catmull–Rom spline through the points (\[Yuksel2011\]).
fn spline(points: &[DVec3], closed: bool) -> Vec<DVec3> {
    const STEPS: usize = 16;
    let mut points = points.to_vec();
    points.dedup();
    let n = points.len();
    if n < 3 {
        return points;
    }
    // Counted from the point before the first.
    let at = |i: usize| match i {
        _ if closed => points[(i + n - 1) % n],
        0 => 2.0 * points[0] - points[1],
        _ => points.get(i - 1).copied().unwrap_or(2.0 * points[n - 1] - points[n - 2]),
    };
    let mut out = vec![];
    for i in 0..if closed { n } else { n - 1 } {
        let p = [at(i), at(i + 1), at(i + 2), at(i + 3)];
        let mut t = [0.0; 4];
        for k in 0..3 {
            t[k + 1] = t[k] + p[k].distance(p[k + 1]).sqrt().max(f64::MIN_POSITIVE);
        }
        for step in 0..STEPS {
            let x = t[1] + (t[2] - t[1]) * step as f64 / STEPS as f64;
            let mix = |a: DVec3, b: DVec3, s: f64, e: f64| a.lerp(b, (x - s) / (e - s));
            let a = [0, 1, 2].map(|k| mix(p[k], p[k + 1], t[k], t[k + 1]));
            let b = [0, 1].map(|k| mix(a[k], a[k + 1], t[k], t[k + 2]));
            out.push(mix(b[0], b[1], t[1], t[2]));
        }
    }
    out.push(if closed { points[0] } else { points[n - 1] });
    out
}

/// `count` points evenly along a polyline, ends included, and its length.
fn resampled(polyline: &[DVec3], count: usize) -> (Vec<DVec3>, f64) {
    let mut lengths = vec![0.0];
    for w in polyline.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + w[0].distance(w[1]));
    }
    let total = lengths[lengths.len() - 1];
    let at = |i: usize| {
        let s = total * i as f64 / (count - 1) as f64;
        let k = lengths.partition_point(|&l| l < s).clamp(1, polyline.len() - 1);
        let t = (s - lengths[k - 1]) / (lengths[k] - lengths[k - 1]);
        polyline[k - 1].lerp(polyline[k], if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 })
    };
    ((0..count).map(at).collect(), total)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a curve of degree five with the right ends come back as that curve.
    #[test]
    fn a_bezier_curve_is_found_again() {
        let (p, q) = (DVec3::ZERO, DVec3::new(10.0, 0.0, 0.0));
        let made = Bezier {
            control: [
                p,
                DVec3::new(0.0, 2.5, 0.0),
                DVec3::new(2.0, 4.0, 1.0),
                DVec3::new(7.0, 4.0, 1.0),
                q + DVec3::new(0.0, 2.5, 0.0),
                q,
            ],
        };
        let dense: Vec<DVec3> = (0..=400).map(|i| made.point(f64::from(i) / 400.0)).collect();
        let found = through(&dense, [DVec3::Y, DVec3::Y]);
        let off = dense
            .iter()
            .map(|p| (0..=2000).map(|i| found.point(f64::from(i) / 2000.0).distance(*p)).fold(f64::INFINITY, f64::min));
        let worst = off.fold(0.0, f64::max);
        assert!(worst < 0.05, "{worst}");
        assert!(found.tangent(0.0).normalize().distance(DVec3::Y) < 1e-12);
    }

    #[test]
    fn samples_are_evenly_apart() {
        let arc: Vec<DVec3> =
            (0..=20).map(|i| f64::from(i) * 0.1).map(|t| DVec3::new(t.sin(), -t.cos(), 0.0)).collect();
        let ends = [DVec3::X, DVec3::new(-2f64.cos(), -2f64.sin(), 0.0)];
        let bezier = through(&arc, ends);
        let points = bezier.uniform(0.05);
        assert_eq!(points.len(), 39);
        for (p, t) in &points {
            assert!((p.length() - 1.0).abs() < 2e-3 && t.normalize().dot(p.normalize()).abs() < 0.01, "{p} {t}");
        }
        for w in points.windows(2) {
            assert!((w[0].0.distance(w[1].0) - 0.05).abs() < 1e-3);
        }
    }

    #[test]
    fn eight_points_of_a_circle_make_the_circle() {
        let ring: Vec<DVec3> = (0..8)
            .map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4)
            .map(|a| DVec3::new(a.cos(), a.sin(), 2.0))
            .collect();
        for (p, t) in closed_curve(&ring, 0.1) {
            assert!((p.truncate().length() - 1.0).abs() < 0.01 && t.dot(p - 2.0 * DVec3::Z).abs() < 0.03, "{p}");
        }
    }
}
