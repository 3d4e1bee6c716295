//! A fitted field.

use crate::admit::admit;
use crate::affine::Affine;
use crate::constraint::Constraint;
use crate::dense;
use crate::error::Error;
use crate::far::Plan;
use crate::iterate::{self, Rescue};
use crate::kernel::Kernel;
use crate::params::{Params, Solver};
use crate::sum::Sum;
use crate::translations::{Translations, degree};
use glam::DVec3;

/// Up to this many pairs of a centre and a point all are summed, which is faster than tables of expansions and their use.
const FEW_PAIRS: usize = 500_000_000;

/// Hears the share of the work that is done, in [0, 1], and says whether to go on.
pub type Progress<'a> = dyn Fn(f64) -> bool + Sync + 'a;

/// An implicit function f(x) = Σ w φ(|x − c|) + affine: negative inside, zero on the surface, and as smooth as its kernel lets it be.
#[derive(Clone, Debug)]
pub struct Field {
    pub(crate) kernel: Kernel,
    centre: DVec3,
    pub(crate) scale: f64,
    pub(crate) sum: Sum,
    residual: f64,
    gradient_residual: f64,
    merged: Vec<[usize; 2]>,
}

impl Field {
    /// Fits a field to constraints: densely in O(n³/3) time and 8n² bytes for n unknowns (one per value, three per gradient), or
    /// iteratively in O(n log n) of both; see [`Solver`].
    ///
    /// # Errors
    /// See [`Error`]: numbers that are none, constraints that contradict each other, that all lie on one plane or that leave the
    /// system singular; [`Error::Cancelled`] when `progress` says so.
    pub fn fit(constraints: &[Constraint], params: &Params, progress: &Progress<'_>) -> Result<Self, Error> {
        let step = |share: f64| if progress(share) { Ok(()) } else { Err(Error::Cancelled) };
        step(0.0)?;
        let mut system = admit(constraints, params)?;
        let affine = Affine::choose(&system)?;
        step(0.05)?;
        let tolerance = match params.solver {
            Solver::Dense => None,
            Solver::Auto => (system.unknowns() > Solver::MOST_DENSE).then_some(Solver::TOLERANCE),
            Solver::Iterative { tolerance } => Some(tolerance),
        };
        let rescue = match params.solver {
            Solver::Auto if system.unknowns() <= Solver::MOST_RESCUED => Rescue::Dense,
            _ => Rescue::Finer,
        };
        let (sum, missing) = match tolerance.filter(|_| system.gradients.is_empty()) {
            Some(tolerance) => match iterate::solve(&system, &affine, params.kernel, tolerance, rescue, &step) {
                Err(Error::NotConverged { .. }) if matches!(rescue, Rescue::Dense) => {
                    dense::solve(&system, &affine, params.kernel, &step)?
                }
                solved => solved?,
            },
            None => dense::solve(&system, &affine, params.kernel, &step)?,
        };
        let n = system.points.len();
        Ok(Self {
            kernel: params.kernel,
            centre: system.centre,
            scale: system.scale,
            residual: largest(&missing[..n]) * system.scale,
            gradient_residual: largest(&missing[n..]),
            merged: std::mem::take(&mut system.merged),
            sum,
        })
    }

    /// The value at a point, in model units. O(n).
    pub fn value(&self, p: DVec3) -> f64 {
        let mut out = [0.0];
        self.values(&[p], &mut out);
        out[0]
    }

    /// The gradient at a point. O(n). The biharmonic kernel has none at its own centres; there the centre's own term is left out.
    pub fn gradient(&self, p: DVec3) -> DVec3 {
        let mut out = [DVec3::ZERO];
        self.gradients(&[p], &mut out);
        out[0]
    }

    /// The values at many points, on all cores; the same bits as one at a time. `out` must be as long as `points`.
    pub fn values(&self, points: &[DVec3], out: &mut [f64]) {
        assert_eq!(points.len(), out.len(), "one value per point");
        self.sum.values(self.kernel, &self.normalised(points), out);
        for v in out {
            *v *= self.scale;
        }
    }

    /// The values at very many points together, wherever they are: centres far from a point are felt through expansions
    /// (\[FongDarve2009\]), which costs O(n + m) for n centres and m points where [`Field::values`] costs O(n m). Off by less than
    /// about 1e-6 of the extent of the constraints; which other points are asked for changes the last bits. Few points and centres,
    /// and gradient constraints, are summed exactly. `out` must be as long as `points`.
    pub fn many_values(&self, points: &[DVec3], out: &mut [f64]) {
        let few = self.centres() * points.len() <= FEW_PAIRS;
        if few || !self.sum.tilts[0].is_empty() || !points.iter().all(|p| p.is_finite()) {
            return self.values(points, out);
        }
        assert_eq!(points.len(), out.len(), "one value per point");
        self.expanded_values(points, out);
    }

    fn expanded_values(&self, points: &[DVec3], out: &mut [f64]) {
        let (centres, at) = (self.sum.centres(), self.normalised(points));
        let translations = Translations::new(self.kernel, degree(self.kernel));
        let sums = Plan::new(&translations, &centres, Some(&at)).sums(&self.sum.weights);
        let [c, x, y, z] = self.sum.affine;
        for ((v, sum), p) in out.iter_mut().zip(sums).zip(at) {
            *v = self.scale * (sum + c + DVec3::new(x, y, z).dot(p));
        }
    }

    /// The gradients at many points, on all cores; the same bits as one at a time. `out` must be as long as `points`.
    pub fn gradients(&self, points: &[DVec3], out: &mut [DVec3]) {
        assert_eq!(points.len(), out.len(), "one gradient per point");
        self.sum.gradients(self.kernel, &self.normalised(points), out);
    }

    /// Both at many points, with the same bits as each alone and faster than one after the other. All three slices must be
    /// of one length.
    pub fn values_and_gradients(&self, points: &[DVec3], values: &mut [f64], gradients: &mut [DVec3]) {
        assert!(points.len() == values.len() && points.len() == gradients.len(), "one value and gradient per point");
        self.sum.values_and_gradients(self.kernel, &self.normalised(points), values, gradients);
        for v in values {
            *v *= self.scale;
        }
    }

    pub(crate) fn normalised(&self, points: &[DVec3]) -> Vec<DVec3> {
        points.iter().map(|&p| (p - self.centre) / self.scale).collect()
    }

    /// How far the field is from the constraints' values at worst, in model units.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    /// How far the field is from the constraints' gradients at worst.
    pub fn gradient_residual(&self) -> f64 {
        self.gradient_residual
    }

    /// Constraints that were left out, each beside the one that was kept for it.
    pub fn merged(&self) -> &[[usize; 2]] {
        &self.merged
    }

    /// How many centres the field is a sum over.
    pub fn centres(&self) -> usize {
        self.sum.x.len()
    }
}

fn largest(values: &[f64]) -> f64 {
    // `max` would drop NaN, which must show.
    values.iter().fold(0.0, |a, v| if v.abs() <= a { a } else { v.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The twin that adds everything directly, for values in a steep band: inside, outside and far away.
    #[test]
    fn expanded_values_are_the_values() {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let direction = |i: usize, n: usize| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64;
            let (s, c) = (golden * i as f64).sin_cos();
            DVec3::new((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z)
        };
        let constraints: Vec<Constraint> = (0..1000)
            .map(|i| direction(i, 1000))
            .map(|d| (d, d * (1.0 + 0.1 * (5.0 * d.x).sin() * (4.0 * d.y).cos())))
            .flat_map(|(d, p)| [Constraint::on_surface(p), Constraint::off_surface(p + 0.02 * d, 0.02)])
            .collect();
        let place = |i: usize| direction(i, 3000) * (0.1 + 1.4 * (i % 97) as f64 / 97.0);
        let points: Vec<DVec3> = (0..3000).map(place).chain([DVec3::splat(9.0)]).collect();
        for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
            let field = Field::fit(&constraints, &Params { kernel, ..Params::default() }, &|_| true).unwrap();
            let (mut exact, mut expanded) = (vec![0.0; points.len()], vec![0.0; points.len()]);
            field.values(&points, &mut exact);
            field.expanded_values(&points, &mut expanded);
            let off = exact.iter().zip(&expanded).map(|(e, m)| (e - m).abs()).fold(0.0, f64::max);
            println!("{kernel:?}: {off:e}");
            assert!(off > 0.0 && off < 2e-6, "{kernel:?}: {off:e}");
        }
    }
}
