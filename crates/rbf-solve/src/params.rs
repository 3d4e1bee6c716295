//! How to fit.

use crate::kernel::Kernel;

/// How to fit a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// The radial function. Default: triharmonic, the smoothest of the two.
    pub kernel: Kernel,
    /// Constraints of one value nearer to each other than this, in model units, are merged into the one given first. Zero merges only
    /// what coincides. Nearly coincident constraints ruin the condition of the system as a power of their distance;
    /// a tenth of the mean edge between constraints is a good choice.
    pub merge: f64,
    /// How the system is solved.
    pub solver: Solver,
}

impl Default for Params {
    fn default() -> Self {
        Self { kernel: Kernel::default(), merge: 0.0, solver: Solver::default() }
    }
}

/// How the system is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Solver {
    /// Dense up to [`Solver::MOST_DENSE`] unknowns, and wherever there are gradients; iterative to [`Solver::TOLERANCE`] beyond, but
    /// dense again where that does not converge and there are no more than [`Solver::MOST_RESCUED`].
    #[default]
    Auto,
    /// Cholesky factorization of the whole system. Exact up to rounding; n²·8 bytes and n³/3 operations.
    Dense,
    /// Conjugate gradients with fast sums. Without gradients only. Time and memory grow as n log n.
    Iterative {
        /// Largest residual allowed, as a share of the extent of the constraints. Above 0.
        tolerance: f64,
    },
}

impl Solver {
    /// Up to how many unknowns [`Solver::Auto`] solves densely. A constraint with a gradient has four unknowns, others one.
    pub const MOST_DENSE: usize = 4000;
    /// Up to how many unknowns [`Solver::Auto`] solves densely what does not converge: 2 GiB.
    pub const MOST_RESCUED: usize = 16_000;
    /// The tolerance of [`Solver::Auto`].
    pub const TOLERANCE: f64 = 1e-8;
}
