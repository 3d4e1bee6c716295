//! Fair linkages: feet smoothed along the rail and put back on their patches.
//!
//! On a faceted patch a ball's raw foot sticks at convex edges and jumps over concave ones by O(r·h/R), so that raw
//! linkages are wavy and step back. Jumps are filled with samples, then every foot becomes a weighted mean of its
//! neighbours and is projected to its patch again. Means of points in a plane stay in the plane, so that on planar
//! patches only bends of the linkage are touched.

use crate::contact::Contact;
use crate::patch::Patch;
use crate::radius::RadiusField;
use glam::DVec3;
use mesh_core::{Adjacency, Positions};
use mesh_query::ClosestPoint;
use rayon::prelude::*;

/// How much a stretch of the rail is smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softening {
    /// Centre of the stretch.
    pub at: DVec3,
    /// Distance from the centre at which it ends, in model units.
    pub extent: f64,
    /// What is added to the kernel's standard deviation at its centre, in model units.
    pub extra: f64,
}

/// One ball with its fair feet.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Ball centre.
    pub center: DVec3,
    /// Ball radius.
    pub radius: f64,
    /// Fair feet on the left and right patch.
    pub feet: [ClosestPoint; 2],
    /// Normal curvature of each side across the curve at its foot, positive towards the ball, in 1/model unit; 0 unless
    /// [`crate::Rail::measure_bends`] measured it.
    pub bends: [f64; 2],
}

impl From<Contact> for Sample {
    fn from(ball: Contact) -> Self {
        Self { center: ball.center, radius: ball.radius, feet: ball.feet, bends: [0.0; 2] }
    }
}

impl Sample {
    /// How far whichever of centre and feet moves most is from where it is in `next`.
    pub(crate) fn advance(&self, next: &Self) -> f64 {
        (0..2)
            .map(|s| self.feet[s].point.distance(next.feet[s].point))
            .fold(self.center.distance(next.center), f64::max)
    }
}

/// How [`fair`] works.
pub(crate) struct Fairing<'a> {
    /// Standard deviation of the kernel in facet lengths, at most half the radius.
    pub fairness: f64,
    /// Largest distance left between neighbouring feet, in model units, and the longest step that the ball itself takes.
    pub gaps: [f64; 2],
    /// Where the kernel is wider.
    pub softenings: &'a [Softening],
    /// Whether the last ball is next to the first.
    pub closed: bool,
    /// The ends of an open curve and the ways out of it. Beyond them lies other surface: the kernel narrows towards them.
    pub ends: &'a [(DVec3, DVec3)],
    /// How far from an end a ball can be that belongs to it, in model units.
    pub reach: f64,
}

/// Kernels narrow so that an end is this many standard deviations away.
const CLEAR: f64 = 3.0;

/// Fills jumps, smooths, projects. Also gives the largest residual of the balls seated on the way.
pub(crate) fn fair<M: Adjacency + Positions + Sync>(
    mesh: &M,
    patches: &[Patch; 2],
    radius: &RadiusField,
    contacts: &[Contact],
    Fairing { fairness, gaps, softenings, closed, ends, reach }: Fairing<'_>,
) -> (Vec<Sample>, f64) {
    let (raw, residual) = fill_jumps(mesh, patches, radius, contacts, closed, gaps);
    let metric = Metric::of(&raw, closed);
    let points: [Vec<DVec3>; 2] = [0, 1].map(|side| raw.iter().map(|s| s.feet[side].point).collect());
    let centers: Vec<DVec3> = raw.iter().map(|s| s.center).collect();
    let sigmas = [0, 1].map(|side| fairness * facet_length(mesh, &raw, closed, side));
    let fair = (0..raw.len())
        .into_par_iter()
        .map(|i| {
            let mut sample = raw[i];
            let extra: f64 = softenings
                .iter()
                .map(|s| s.extra * (1.0 - raw[i].center.distance_squared(s.at) / (s.extent * s.extent)).max(0.0))
                .sum();
            if extra > 0.0 {
                sample.center = metric.mean(&centers, i, extra.min(sample.radius));
            }
            let room = |(at, out): &(DVec3, DVec3)| {
                (raw[i].center.distance(*at) < reach).then(|| (*at - raw[i].center).dot(*out).max(0.0) / CLEAR)
            };
            let widest = ends.iter().filter_map(room).fold(f64::INFINITY, f64::min);
            for side in 0..2 {
                let sigma = (sigmas[side].min(0.5 * sample.radius) + extra.min(sample.radius)).min(widest);
                if sigma <= 0.0 {
                    continue;
                }
                let smooth = metric.mean(&points[side], i, sigma);
                if let Some(foot) = patches[side].closest(mesh, smooth) {
                    sample.feet[side] = foot;
                }
            }
            sample
        })
        .collect();
    (fair, residual)
}

/// Mean length of the linkage between turns of the surface under it: the scale on which facets disturb the feet.
///
/// Turns under half a degree disturb nothing, and those over 30 degrees are creases, where feet belong on either side;
/// zero where there are no others.
fn facet_length<M: Adjacency + Positions>(mesh: &M, samples: &[Sample], closed: bool, side: usize) -> f64 {
    let normal = |s: &Sample| {
        let [a, b, c] = mesh.triangle(s.feet[side].face);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let (mut length, mut turns) = (0.0, 0u32);
    for (here, next) in pairs(samples, closed) {
        length += here.feet[side].point.distance(next.feet[side].point);
        let turn = normal(here).angle_between(normal(next)).to_degrees();
        turns += u32::from((0.5..30.0).contains(&turn));
    }
    if turns == 0 { 0.0 } else { length / f64::from(turns) }
}

/// Fills the stretches where a foot moves farther than `gap` from one ball to the next. Where it only moves fast, balls
/// are seated in between; where it jumps, the ball stays and its foot walks over.
fn fill_jumps<M: Adjacency + Positions>(
    mesh: &M,
    patches: &[Patch; 2],
    radius: &RadiusField,
    contacts: &[Contact],
    closed: bool,
    [gap, longest]: [f64; 2],
) -> (Vec<Sample>, f64) {
    let mut residual = 0.0f64;
    let between = |here: &Sample, next: &Sample, t: f64| {
        let walked = walk(mesh, patches, here, next, t)?;
        let known = walked.feet.map(|f| f.point);
        let near = |p: DVec3, q: DVec3| p.distance(q) < 0.25 * gap;
        let ball =
            Contact::seat(mesh, patches, radius, walked.center, Some(known)).filter(|b| near(b.center, walked.center));
        let Some(ball) = ball else { return Some(walked) };
        residual = residual.max(ball.residual);
        // Where a foot jumps, the seated ball's stays at one end of the jump: the walked one is kept.
        let jumped = (0..2).any(|s| !near(ball.feet[s].point, known[s]));
        let feet = if jumped { walked.feet } else { ball.feet };
        Some(Sample { feet, ..Sample::from(ball) })
    };
    let samples: Vec<Sample> = contacts.iter().copied().map(Sample::from).collect();
    let filled = subdivide(&samples, closed, [gap, longest], between);
    (filled, residual)
}

/// Fills gaps with samples between their ends, feet walking over the patches.
pub(crate) fn fill_gaps<M: Adjacency + Positions>(
    mesh: &M,
    patches: &[Patch; 2],
    samples: &[Sample],
    closed: bool,
    gaps: [f64; 2],
) -> Vec<Sample> {
    subdivide(samples, closed, gaps, |here, next, t| walk(mesh, patches, here, next, t))
}

/// Puts what `between` makes into every stretch longer than `gap`.
fn subdivide(
    samples: &[Sample],
    closed: bool,
    [gap, longest]: [f64; 2],
    mut between: impl FnMut(&Sample, &Sample, f64) -> Option<Sample>,
) -> Vec<Sample> {
    let mut filled = Vec::with_capacity(samples.len());
    for (here, next) in pairs(samples, closed) {
        filled.push(*here);
        // Where the ball itself goes far, it goes straight.
        let gap = gap.max(1.5 * here.center.distance(next.center).min(longest));
        // A jump is never longer than a few diameters, so the count is bounded.
        let pieces = (here.advance(next) / gap).ceil().clamp(1.0, 256.0) as u32;
        filled.extend((1..pieces).filter_map(|k| between(here, next, f64::from(k) / f64::from(pieces))));
    }
    if !closed {
        filled.extend(samples.last());
    }
    filled
}

/// Each sample with the next; of a closed chain also the last with the first.
pub(crate) fn pairs(samples: &[Sample], closed: bool) -> impl Iterator<Item = (&Sample, &Sample)> {
    let wrap = if closed { samples.last().zip(samples.first()) } else { None };
    samples.windows(2).map(|w| (&w[0], &w[1])).chain(wrap)
}

/// The ball between two, its feet on the patches next to the straight line between theirs.
fn walk<M: Adjacency + Positions>(
    mesh: &M,
    patches: &[Patch; 2],
    here: &Sample,
    next: &Sample,
    t: f64,
) -> Option<Sample> {
    let foot = |s: usize| patches[s].closest(mesh, here.feet[s].point.lerp(next.feet[s].point, t));
    Some(Sample {
        center: here.center.lerp(next.center, t),
        radius: here.radius + t * (next.radius - here.radius),
        feet: [foot(0)?, foot(1)?],
        bends: [0.0; 2],
    })
}

/// Arc lengths along a rail, measured on whichever of centre and feet moves most.
struct Metric {
    /// At each sample.
    at: Vec<f64>,
    /// In all, the way from the last sample to the first included where the rail is closed.
    total: f64,
    closed: bool,
}

impl Metric {
    fn of(samples: &[Sample], closed: bool) -> Self {
        let (mut at, mut total) = (Vec::with_capacity(samples.len()), 0.0);
        for (here, next) in pairs(samples, closed) {
            at.push(total);
            total += here.advance(next);
        }
        if !closed {
            at.push(total);
        }
        Self { at, total, closed }
    }

    /// Distance from sample `i` to sample `j` going forwards.
    fn ahead(&self, i: usize, j: usize) -> f64 {
        if self.closed { (self.at[j] - self.at[i]).rem_euclid(self.total) } else { self.at[j] - self.at[i] }
    }

    /// Gaussian mean of `points` around `i`, each weighted by the stretch of curve it stands for. Near the ends of an
    /// open rail the kernel is cut on both sides alike, so that the ends stay where they are.
    fn mean(&self, points: &[DVec3], i: usize, sigma: f64) -> DVec3 {
        let n = points.len();
        let to_end = if self.closed { f64::INFINITY } else { self.at[i].min(self.total - self.at[i]) };
        let reach = (3.0 * sigma).min(0.4 * self.total).min(to_end * (1.0 + 1e-9));
        let least = 1e-6 * self.total / n as f64;
        let stretch = |j: usize| {
            let (before, after) =
                if self.closed { ((j + n - 1) % n, (j + 1) % n) } else { (j.saturating_sub(1), (j + 1).min(n - 1)) };
            self.ahead(before, after).max(least)
        };
        let (mut sum, mut weight) = (stretch(i) * points[i], stretch(i));
        for forwards in [true, false] {
            let mut j = i;
            for _ in 1..n {
                j = match (forwards, self.closed) {
                    (true, true) => (j + 1) % n,
                    (false, true) => (j + n - 1) % n,
                    (true, false) if j + 1 < n => j + 1,
                    (false, false) if j > 0 => j - 1,
                    _ => break,
                };
                let d = if forwards { self.ahead(i, j) } else { self.ahead(j, i) };
                if d > reach {
                    break;
                }
                let w = stretch(j) * (-0.5 * (d / sigma) * (d / sigma)).exp();
                sum += w * points[j];
                weight += w;
            }
        }
        sum / weight
    }
}
