//! Rings of guides that lead the surface between openings where a neck would break by itself.

use super::Guide;
use super::openings::Opening;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Guides on each ring.
const AROUND: usize = 6;
/// Rings of one neck, at most.
const MOST_RINGS: f64 = 12.0;
/// A neck keeps this share of the radius between the openings' own.
const WAIST: f64 = 0.9;
/// And at most this share of the radius at which its axis turns, or it would run into itself.
const TURN: f64 = 0.7;

/// An opening as a disc.
struct Disc {
    center: DVec3,
    /// Out of the part.
    axis: DVec3,
    radius: f64,
}

impl Disc {
    fn of(opening: &Opening) -> Option<Self> {
        let points = &opening.rim.points;
        let center = points.iter().sum::<DVec3>() / points.len() as f64;
        let after = |i: usize| points[(i + 1) % points.len()];
        // The rim has the part on its left, seen from outside, so that it turns against its axis.
        let area = (0..points.len()).map(|i| (after(i) - center).cross(points[i] - center)).sum::<DVec3>() / 2.0;
        Some(Self { center, axis: area.try_normalize()?, radius: (area.length() / PI).sqrt() })
    }
}

/// The axis of a neck: a cubic from one disc to another that leaves both along their axes.
struct Axis([DVec3; 4]);

impl Axis {
    fn between(a: &Disc, b: &Disc) -> Self {
        let reach = 0.45 * a.center.distance(b.center) + 0.15 * (a.radius + b.radius);
        Self([a.center, a.center + reach * a.axis, b.center + reach * b.axis, b.center])
    }

    /// Place, derivative, second derivative.
    fn at(&self, t: f64) -> [DVec3; 3] {
        let [a, b, c, d] = self.0;
        let s = 1.0 - t;
        [
            s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d,
            3.0 * (s * s * (b - a) + 2.0 * s * t * (c - b) + t * t * (d - c)),
            6.0 * (s * (a - 2.0 * b + c) + t * (b - 2.0 * c + d)),
        ]
    }

    fn length(&self) -> f64 {
        self.0.windows(2).map(|w| w[0].distance(w[1])).sum()
    }
}

/// Guides for a neck between an opening that is `joined` and one of another part that is not, the pair with the shortest
/// axis. None if there is no such pair.
pub(super) fn lead(openings: &[Opening], joined: &[(usize, usize)]) -> Vec<Guide> {
    let discs: Vec<Option<Disc>> = openings.iter().map(Disc::of).collect();
    let is_joined = |o: &Opening| joined.contains(&(o.part, o.index));
    let mut best: Option<(f64, &Disc, &Disc)> = None;
    for (a, from) in openings.iter().zip(&discs).filter(|o| is_joined(o.0)) {
        for (_, to) in openings.iter().zip(&discs).filter(|o| !is_joined(o.0) && o.0.part != a.part) {
            let (Some(from), Some(to)) = (from, to) else { continue };
            let length = Axis::between(from, to).length();
            if best.is_none_or(|best| length < best.0) {
                best = Some((length, from, to));
            }
        }
    }
    best.map_or(vec![], |(length, a, b)| rings(&Axis::between(a, b), length, [a.radius, b.radius]))
}

fn rings(axis: &Axis, length: f64, radii: [f64; 2]) -> Vec<Guide> {
    let count = (length / (radii[0] + radii[1])).round().clamp(1.0, MOST_RINGS);
    let mut guides = vec![];
    for i in 0..count as usize {
        let t = (i as f64 + 1.0) / (count + 1.0);
        let [center, d1, d2] = axis.at(t);
        let Some(along) = d1.try_normalize() else { continue };
        let curvature = d1.cross(d2).length() / d1.length().powi(3);
        let radius = (WAIST * ((1.0 - t) * radii[0] + t * radii[1])).min(TURN / curvature);
        let side = along.any_orthonormal_vector();
        guides.extend((0..AROUND).map(|k| {
            let (sin, cos) = (TAU * k as f64 / AROUND as f64).sin_cos();
            let normal = cos * side + sin * along.cross(side);
            Guide { point: center + radius * normal, normal: Some(normal) }
        }));
    }
    guides
}
