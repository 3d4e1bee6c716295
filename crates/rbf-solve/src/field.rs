//! A fitted field.

use crate::admit::admit;
use crate::affine::Affine;
use crate::constraint::Constraint;
use crate::dense;
use crate::error::Error;
use crate::iterate::{self, Rescue};
use crate::kernel::Kernel;
use crate::params::{Params, Solver};
use crate::patches::Patches;
use crate::sum::Sum;
use glam::DVec3;

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

    /// The field for many points that lie densely along a surface: in cubes of a width, in model units, within which values and
    /// gradients of far centres are expanded, to about 1e-6 of the width. 40 spacings of the points make good cubes.
    pub fn patches(&self, width: f64) -> Patches<'_> {
        Patches::new(self, width / self.scale)
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
