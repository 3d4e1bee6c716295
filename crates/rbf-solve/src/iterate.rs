//! The whole system without its matrix: conjugate gradients on the reduced system, with fast sums.
//!
//! Cheap sums drive the iteration, accurate ones measure what is left; so the cost is that of the cheap ones and the residual is true.

use crate::admit::System;
use crate::affine::Affine;
use crate::chebyshev::MOST;
use crate::error::Error;
use crate::far::Plan;
use crate::kernel::{Kernel, Radial, with_kernel};
use crate::screen::Screen;
use crate::sum::Sum;
use crate::translations::{Translations, degree};
use std::cell::OnceCell;

/// Corrections after which the system is taken to be beyond working precision.
const MOST_ROUNDS: usize = 12;
/// Steps per correction.
const MOST_STEPS: usize = 60;
/// By how much a correction is asked to reduce the residual.
const REDUCTION: f64 = 1e-3;
/// Degree of the expansions that measure the residual of many points: the most there is.
const FINEST: usize = MOST - 1;
/// Up to this many points residuals are measured by direct sums.
const FEW: usize = 40_000;

/// What comes after sums that are too coarse.
#[derive(Clone, Copy)]
pub(crate) enum Rescue {
    /// Finer ones.
    Finer,
    /// Nothing here: the dense solver, faster for systems it can hold.
    Dense,
}

/// The reduced system: values less the affine function through those at the special four.
struct Reduced<'a> {
    affine: &'a Affine,
    sign: f64,
}

impl Reduced<'_> {
    fn reduce(&self, v: &[f64]) -> Vec<f64> {
        let Affine { special, shares, .. } = self.affine;
        let own = special.map(|s| v[s]);
        (0..v.len()).map(|i| self.sign * (v[i] - (0..4).map(|k| shares[k][i] * own[k]).sum::<f64>())).collect()
    }

    /// Gives the special four the weights that make all orthogonal to affine functions.
    fn complete(&self, mut y: Vec<f64>) -> Vec<f64> {
        let Affine { special, shares, .. } = self.affine;
        for &s in special {
            y[s] = 0.0;
        }
        let own = [0, 1, 2, 3].map(|k| -dot(&shares[k], &y));
        for (&s, w) in special.iter().zip(own) {
            y[s] = w;
        }
        y
    }

    /// Solves for `r` until `goal`, or as far as it goes.
    fn descend(
        &self,
        screen: &Screen,
        sums: &Plan<'_>,
        mut r: Vec<f64>,
        goal: f64,
        step: &dyn Fn(f64) -> Result<(), Error>,
    ) -> Result<Vec<f64>, Error> {
        let n = r.len();
        let mut y = vec![0.0; n];
        let mut z = screen.apply(&r);
        let mut direction = z.clone();
        let mut rz = dot(&r, &z);
        let start = largest(&r);
        for _ in 0..MOST_STEPS {
            step(largest(&r))?;
            let image = self.reduce(&sums.sums(&self.complete(direction.clone())));
            let curvature = dot(&direction, &image);
            // Rounded sums are not definite; where that shows, nothing is left to gain from them.
            if !(curvature > 0.0 && rz.is_finite()) {
                break;
            }
            let alpha = rz / curvature;
            for i in 0..n {
                y[i] += alpha * direction[i];
                r[i] -= alpha * image[i];
            }
            if largest(&r) <= goal || largest(&r) > 1e3 * start {
                break;
            }
            z = screen.apply(&r);
            let next = dot(&r, &z);
            let beta = next / rz;
            rz = next;
            for i in 0..n {
                direction[i] = z[i] + beta * direction[i];
            }
        }
        Ok(self.complete(y))
    }
}

/// The field's sum and what it leaves at every point, at most `tolerance` of the extent. O(n log n) for each step.
pub(crate) fn solve(
    system: &System,
    affine: &Affine,
    kernel: Kernel,
    tolerance: f64,
    rescue: Rescue,
    step: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<(Sum, Vec<f64>), Error> {
    // Each drives the iteration until it gains nothing more: the smoother the kernel and the nearer the points, the smaller the
    // eigenvalues that must not drown.
    let degrees = [degree(kernel), FINEST];
    let taken = match rescue {
        Rescue::Finer => &degrees[..],
        Rescue::Dense => &degrees[..1],
    };
    solve_by(taken, system, affine, kernel, tolerance, step)
}

/// [`solve`] with sums of other degrees.
fn solve_by(
    degrees: &[usize],
    system: &System,
    affine: &Affine,
    kernel: Kernel,
    tolerance: f64,
    step: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<(Sum, Vec<f64>), Error> {
    let wanted = system.wanted();
    // Lengths are shares of the extent here.
    let allowed = tolerance;
    let reduced = Reduced { affine, sign: with_kernel!(kernel, K => K::SIGN) };
    let screen = with_kernel!(kernel, K => Screen::new::<K>(&system.points, affine));
    step(0.2)?;
    let translations = [(); 2].map(|()| OnceCell::new());
    let plans = [(); 2].map(|()| OnceCell::new());
    let plan = |level: usize| {
        let translations = translations[level].get_or_init(|| Translations::new(kernel, degrees[level]));
        plans[level].get_or_init(|| Plan::new(translations, &system.points, None))
    };
    let many = wanted.len() > FEW;
    let mut sum = Sum::new(&system.points, 0);
    let mut sums = vec![0.0; wanted.len()];
    let mut level = 0;
    let (mut best, mut first) = (f64::INFINITY, None);
    for round in 0..MOST_ROUNDS {
        let missing: Vec<f64> = wanted.iter().zip(&sums).map(|(w, s)| w - s).collect();
        let r = reduced.reduce(&missing);
        let worst = largest(&r);
        let start = *first.get_or_insert(worst);
        if worst <= allowed {
            sum.affine = affine.coefficients(affine.special.map(|s| missing[s]));
            return Ok((sum, r));
        }
        if worst >= 0.5 * best || worst.is_nan() {
            if level + 1 == degrees.len() {
                return Err(stalled(system, &r, round));
            }
            level += 1;
        }
        best = worst.min(best);
        let goal = (0.5 * allowed).max(REDUCTION * worst);
        let share = |left: f64| step(0.2 + 0.8 * ((left / start).ln() / (allowed / start).ln()).clamp(0.0, 1.0));
        let change = reduced.descend(&screen, plan(level), r, goal, &share)?;
        for (w, c) in sum.weights.iter_mut().zip(&change) {
            *w += c;
        }
        if many {
            sums = plan(degrees.len() - 1).sums(&sum.weights);
        } else {
            sum.values(kernel, &system.points, &mut sums);
        }
    }
    let missing: Vec<f64> = wanted.iter().zip(&sums).map(|(w, s)| w - s).collect();
    Err(stalled(system, &reduced.reduce(&missing), MOST_ROUNDS))
}

fn stalled(system: &System, r: &[f64], rounds: usize) -> Error {
    let worst = (0..r.len()).max_by(|&a, &b| r[a].abs().total_cmp(&r[b].abs())).unwrap_or(0);
    Error::NotConverged {
        residual: r[worst].abs(),
        rounds,
        worst: system.sources[worst] as usize,
        at: system.place(worst),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn largest(v: &[f64]) -> f64 {
    // `max` would drop NaN, which must show.
    v.iter().fold(0.0, |a, x| if x.abs() <= a { a } else { x.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::admit::admit;
    use crate::{Constraint, Params};
    use glam::DVec3;

    /// Of tens of thousands of points in tight bands the smallest eigenvalues drowned in the error of the first sums, and the
    /// system was refused. Sums of degree 2 drown here.
    #[test]
    fn where_sums_are_too_coarse_finer_ones_go_on() {
        let n = 4000;
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let point = |i: usize| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / f64::from(n);
            let (s, c) = (golden * i as f64).sin_cos();
            let d = DVec3::new((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z);
            Constraint::off_surface(d, (3.0 * d.x).sin() * d.y)
        };
        let constraints: Vec<Constraint> = (0..n as usize).map(point).collect();
        let system = admit(&constraints, &Params::default()).unwrap();
        let affine = Affine::choose(&system).unwrap();
        let solve = |degrees: &[usize]| solve_by(degrees, &system, &affine, Kernel::Triharmonic, 1e-9, &|_| Ok(()));
        assert!(matches!(solve(&[2, 2]), Err(Error::NotConverged { .. })));
        let (_, left) = solve(&[2, FINEST]).unwrap();
        assert!(largest(&left) <= 1e-9);
    }
}
