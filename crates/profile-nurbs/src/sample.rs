//! Evenly spaced points on a profile, without allocation.

use crate::profile::{Profile, casteljau, hermite, into_section, quintic};
use crate::section::Section;
use glam::DVec3;

/// Chords by which a curve's length is measured before its points are spread over it.
const CHORDS: usize = 48;

impl Profile {
    /// Appends `count + 1` points of the profile to `out` (`count` raised to 1), nearly evenly spaced by arc length.
    ///
    /// The first and last are exactly `p1` and `p2`. The arc's lie at equal angles. The sharp profile keeps the apex as
    /// one of its points when `count` ≥ 2. Nothing is allocated but room in `out`.
    pub fn points(&self, section: &Section, count: usize, out: &mut Vec<DVec3>) {
        let count = count.max(1);
        let Section { p1, p2, .. } = *section;
        out.reserve(count + 1);
        out.push(p1);
        let inner = (1..count).map(|i| i as f64 / count as f64);
        match self {
            Self::Chamfer => out.extend(inner.map(|t| p1.lerp(p2, t))),
            Self::Sharp => extend_sharp(section, count, out),
            Self::Arc | Self::Conic(_) => match self.apex_weight(section) {
                f64::INFINITY => extend_sharp(section, count, out),
                w if matches!(self, Self::Arc) && has_equal_legs(section) => {
                    // Parameters sin(α − τ), sin τ with α = φ/2 make equal steps of τ equal angles.
                    let half_angle = (1.0 - w * w).max(0.0).sqrt().atan2(w);
                    out.extend(inner.map(|t| {
                        let (a, b) = ((half_angle * (1.0 - t)).sin(), (half_angle * t).sin());
                        if a + b > 0.0 { conic(section, w, a, b) } else { p1.lerp(p2, t) }
                    }));
                }
                w => spread(section, count, out, |t| even_conic(section, w, t)),
            },
            Self::Hermite => {
                let points = hermite(section);
                spread(section, count, out, |t| casteljau(points, t));
            }
            Self::G2 => {
                let points = quintic(section);
                spread(section, count, out, |t| casteljau(points, t));
            }
            Self::Custom(curve) => {
                let [first, last] = curve.domain();
                spread(section, count, out, |t| into_section(section, curve.point(first + t * (last - first))));
            }
        }
        out.push(p2);
    }
}

/// Whether the arc is circular enough for equal angles to make equal steps.
fn has_equal_legs(s: &Section) -> bool {
    let (a, b) = (s.p0.distance(s.p1), s.p0.distance(s.p2));
    (a - b).abs() <= 0.01 * a.max(b)
}

/// The conic with apex weight `w` at the homogeneous parameter a : b, from `p1` (b = 0) to `p2` (a = 0).
fn conic(s: &Section, w: f64, a: f64, b: f64) -> DVec3 {
    let (x, y, z) = (a * a, 2.0 * w * a * b, b * b);
    (x * s.p1 + y * s.p0 + z * s.p2) / (x + y + z)
}

/// The conic at a parameter in [0, 1] that runs along a leg at even speed however large the weight, where the usual
/// parameter would spend all its range next to the apex.
fn even_conic(s: &Section, w: f64, t: f64) -> DVec3 {
    let half = 2.0 * t.min(1.0 - t);
    // The share of the leg covered grows evenly up to the shoulder, where both parameters are equal.
    let short = half / (1.0 + 2.0 * w * (1.0 - half));
    if t <= 0.5 { conic(s, w, 1.0, short) } else { conic(s, w, short, 1.0) }
}

/// Inner points of the two legs, one of them the apex.
fn extend_sharp(s: &Section, count: usize, out: &mut Vec<DVec3>) {
    if count < 2 {
        return;
    }
    let (first, second) = (s.p1.distance(s.p0), s.p2.distance(s.p0));
    let share = if first + second > 0.0 { first / (first + second) } else { 0.5 };
    let corner = ((share * count as f64).round() as usize).clamp(1, count - 1);
    out.extend((1..corner).map(|i| s.p1.lerp(s.p0, i as f64 / corner as f64)));
    out.push(s.p0);
    let rest = count - corner;
    out.extend((1..rest).map(|i| s.p0.lerp(s.p2, i as f64 / rest as f64)));
}

/// Inner points of a curve over [0, 1], at equal lengths along `CHORDS` chords of it.
fn spread(s: &Section, count: usize, out: &mut Vec<DVec3>, curve: impl Fn(f64) -> DVec3) {
    if count < 2 {
        return;
    }
    let mut lengths = [0.0; CHORDS + 1];
    let mut before = s.p1;
    for i in 1..=CHORDS {
        let here = curve(i as f64 / CHORDS as f64);
        lengths[i] = lengths[i - 1] + before.distance(here);
        before = here;
    }
    let mut chord = 0;
    for i in 1..count {
        let target = lengths[CHORDS] * i as f64 / count as f64;
        while chord + 1 < CHORDS && lengths[chord + 1] < target {
            chord += 1;
        }
        let width = lengths[chord + 1] - lengths[chord];
        let within = if width > 0.0 { (target - lengths[chord]) / width } else { 0.5 };
        out.push(curve((chord as f64 + within) / CHORDS as f64));
    }
}
