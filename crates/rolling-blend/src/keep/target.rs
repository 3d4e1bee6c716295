//! The virtual surface S(t, u) through the profiles of a rail, t around and u across, and the linkages as its borders.

use super::refusal::Refusal;
use crate::Params as BlendParams;
use crate::sketch::Drawing;
use crate::strip::section;
use glam::{DVec2, DVec3};
use profile_nurbs::Sweep;
use spine::Rail;

/// The surface that vertices are moved to.
pub(super) struct Target {
    /// Ruled between neighbouring profiles; the first one is repeated at the end.
    sweep: Sweep,
    /// Parameter of each profile, and of the first again.
    pub stations: Vec<f64>,
    /// Left and right foot of each profile, and of the first again.
    pub feet: [Vec<DVec3>; 2],
    /// From each foot out of the blend, along the base surface: unit vectors.
    pub outward: [Vec<DVec3>; 2],
    /// Which profile is the longest.
    pub longest: usize,
    /// Profile parameter at even steps of the longest profile's length.
    even: Vec<f64>,
    /// Mean length of the profiles, in model units.
    pub across: f64,
    /// The angle through which each profile turns, in radians, and the first again.
    turns: Vec<f64>,
    /// The greatest curvature of a linkage, in 1/model unit.
    pub bend: f64,
    /// The smallest ball's.
    pub radius: f64,
}

/// Steps of the table that makes u run at even speed.
const STEPS: usize = 64;

impl Target {
    pub fn new(rail: &Rail, params: &BlendParams) -> Result<Self, Refusal> {
        let (profile, reach, sides) = (&params.profile, params.reach, params.radii.sides);
        let samples = &rail.samples;
        let n = samples.len();
        let (mut stations, mut run) = (Vec::with_capacity(n + 1), 0.0);
        for (i, here) in samples.iter().enumerate() {
            stations.push(run);
            let next = &samples[(i + 1) % n];
            // Where the ball turns on the spot its centre stays while a foot runs on.
            run += (0..2)
                .map(|s| here.feet[s].point.distance(next.feet[s].point))
                .fold(here.center.distance(next.center), f64::max);
        }
        stations.push(run);
        let sections: Vec<_> = samples.iter().map(|s| section(s, s.feet.map(|f| f.point), sides)).collect();
        let closed = |i: usize| &sections[i % n];
        let feet = [0, 1].map(|side: usize| (0..=n).map(|i| [closed(i).p1, closed(i).p2][side]).collect());
        let turns = (0..=n).map(|i| closed(i).angle()).collect();
        let bend = feet.iter().map(|f: &Vec<DVec3>| greatest_curvature(f)).fold(0.0, f64::max);
        let outward = [0, 1].map(|side: usize| {
            let out = |i| ([closed(i).p1, closed(i).p2][side] - closed(i).p0).normalize_or_zero();
            (0..=n).map(out).collect()
        });
        let pulled = |i: usize| reach.map_or(sections[i], |reach| sections[i].with_reach(samples[i].center, reach));
        let mut curves: Vec<_> = (0..n).map(|i| profile.curve(&pulled(i))).collect();
        curves.push(curves[0].clone());
        let lengths: Vec<f64> = curves[..n].iter().map(|c| chords(c, 8).1).collect();
        let longest = (0..n).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]).then(b.cmp(&a))).unwrap_or(0);
        let even = even_steps(&chords(&curves[longest], STEPS).0);
        let sweep = Sweep::new(stations.clone(), curves)
            .map_err(|source| Refusal::Profile { at: samples[0].center, source })?;
        let across = lengths.iter().sum::<f64>() / n as f64;
        let radius = samples.iter().map(|s| s.radius).fold(f64::INFINITY, f64::min);
        Ok(Self { sweep, stations, feet, outward, longest, even, across, turns, bend, radius })
    }

    /// The profiles, to look at.
    pub fn profiles(&self) -> Drawing {
        let point = |t: f64, k: usize| self.point(DVec2::new(t, self.across * k as f64 / STEPS as f64));
        let profile = |&t: &f64| ((0..=STEPS).map(|k| point(t, k)).collect(), false);
        Drawing::Lines(self.stations[..self.stations.len() - 1].iter().map(profile).collect())
    }

    /// Length all round, in t.
    pub fn period(&self) -> f64 {
        self.stations[self.stations.len() - 1]
    }

    /// The angle through which the profile before t turns, in radians.
    pub fn turn(&self, t: f64) -> f64 {
        let t = t.rem_euclid(self.period());
        self.turns[self.stations.partition_point(|&s| s <= t).clamp(1, self.turns.len()) - 1]
    }

    /// The point of the surface at `p`: x is t, in any turn, and y runs from 0 on the right linkage to [`Target::across`]
    /// on the left one, at even speed along the profile.
    pub fn point(&self, p: DVec2) -> DVec3 {
        let u = 1.0 - (p.y / self.across).clamp(0.0, 1.0);
        let at = u * STEPS as f64;
        let i = (at as usize).min(STEPS - 1);
        let u = self.even[i] + (at - i as f64) * (self.even[i + 1] - self.even[i]);
        self.sweep.point(p.x.rem_euclid(self.period()), u)
    }
}

/// Of a closed chain whose first point is repeated at the end.
fn greatest_curvature(chain: &[DVec3]) -> f64 {
    let n = chain.len() - 1;
    let at = |i: usize| {
        let [a, b, c] = [chain[(i + n - 1) % n], chain[i], chain[i + 1]];
        let (before, after) = (b - a, c - b);
        let turn = before.angle_between(after) * 2.0 / (before.length() + after.length());
        if turn.is_finite() { turn } else { 0.0 }
    };
    (0..n).map(at).fold(0.0, f64::max)
}

/// Lengths from the start of a curve to even steps of its parameter, and the whole.
fn chords(curve: &profile_nurbs::Nurbs, steps: usize) -> (Vec<f64>, f64) {
    let [first, last] = curve.domain();
    let (mut lengths, mut run, mut before) = (vec![0.0], 0.0, curve.point(first));
    for i in 1..=steps {
        let here = curve.point(first + (last - first) * i as f64 / steps as f64);
        run += before.distance(here);
        lengths.push(run);
        before = here;
    }
    (lengths, run)
}

/// The parameters, in [0, 1], at which even shares of the length are passed.
fn even_steps(lengths: &[f64]) -> Vec<f64> {
    let total = lengths[STEPS];
    let mut i = 0;
    let at = |k: usize| {
        let wanted = total * k as f64 / STEPS as f64;
        while i + 1 < STEPS && lengths[i + 1] < wanted {
            i += 1;
        }
        let width = lengths[i + 1] - lengths[i];
        let within = if width > 0.0 { ((wanted - lengths[i]) / width).clamp(0.0, 1.0) } else { 0.5 };
        (i as f64 + within) / STEPS as f64
    };
    let mut steps: Vec<f64> = (0..=STEPS).map(at).collect();
    (steps[0], steps[STEPS]) = (0.0, 1.0);
    steps
}
