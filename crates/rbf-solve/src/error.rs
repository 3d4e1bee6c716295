//! Why a field cannot be fitted.

use glam::DVec3;

/// Why a field cannot be fitted. Indices are positions in the list of constraints.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A coordinate, value or gradient is not finite, or so large that squares overflow.
    #[error("constraint {index} at {at} has a coordinate, value or gradient that is not a usable number; remove it")]
    NotFinite {
        /// The constraint.
        index: usize,
        /// Where it claims to be.
        at: DVec3,
    },
    /// Fewer constraints than an affine function has coefficients, or all of them on one plane, line or point.
    #[error(
        "{count} constraints around {at} lie on one plane to within {thickness:e} of their extent, which leaves the field undetermined across it; add constraints off the surface, or gradients"
    )]
    Flat {
        /// How many constraints there are.
        count: usize,
        /// The middle of them.
        at: DVec3,
        /// Extent across the flattest plane, as a share of the extent along it.
        thickness: f64,
    },
    /// Two constraints at one place disagree.
    #[error(
        "constraints {first} and {second} are both at {at} but ask for values {values:?} or for different gradients; keep one of them"
    )]
    Contradiction {
        /// The earlier constraint.
        first: usize,
        /// The later one.
        second: usize,
        /// Where they are.
        at: DVec3,
        /// What each asks for.
        values: [f64; 2],
    },
    /// The kernel has no gradient at its centres.
    #[error(
        "constraint {index} at {at} asks for a gradient, which the biharmonic kernel does not have at its own centres; use the triharmonic kernel"
    )]
    NoGradient {
        /// The constraint.
        index: usize,
        /// Where it is.
        at: DVec3,
    },
    /// The system is singular to working precision.
    #[error(
        "the system is singular: constraints {first} and {second} at {at} are only {distance:e} apart, too near to tell from each other; raise `merge` above that distance or remove one"
    )]
    Singular {
        /// The constraint whose row depends on the others.
        first: usize,
        /// The one nearest to it.
        second: usize,
        /// Where they are.
        at: DVec3,
        /// How far apart, in model units.
        distance: f64,
    },
    /// The iteration stalled.
    #[error(
        "the iterative solver stopped at a residual of {residual:e} of the extent after {rounds} corrections, worst at constraint {worst} at {at}; raise `merge` or the tolerance, or use the dense solver"
    )]
    NotConverged {
        /// Largest residual, as a share of the constraints' extent.
        residual: f64,
        /// Corrections made.
        rounds: usize,
        /// Where the residual is largest.
        worst: usize,
        /// Where that is.
        at: DVec3,
    },
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}
