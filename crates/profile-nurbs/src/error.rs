//! What can be wrong with the numbers given.

use glam::DVec3;

/// Why a curve, section or sweep cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A curve's arrays do not fit together.
    #[error(
        "a curve of degree {degree} with {points} points needs degree ≥ 1, at least degree + 1 points, {points} weights and {} knots, not {weights} weights and {knots} knots",
        points + degree + 1
    )]
    Counts {
        /// Degree asked for.
        degree: usize,
        /// Control points given.
        points: usize,
        /// Weights given.
        weights: usize,
        /// Knots given.
        knots: usize,
    },
    /// A knot is not finite, lower than the one before it, or repeated too often.
    #[error(
        "knot {index} is {value}: knots must be finite, never fall, span a positive range, and repeat at most `degree` times inside it (`degree + 1` at the ends)"
    )]
    Knot {
        /// Which knot.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A weight is not positive and finite.
    #[error("weight {index} is {value}: weights must be positive and finite")]
    Weight {
        /// Which weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A point has a coordinate that is NaN or infinite.
    #[error("point {index} is not finite: {point}")]
    NotFinite {
        /// Which point, in the order of the arguments.
        index: usize,
        /// The point.
        point: DVec3,
    },
    /// The feet of a ball are not at one distance from its centre.
    #[error(
        "the feet of the ball at {center} are {first} and {second} away from it; use `Section::from_tangents` for feet that lie on no common ball"
    )]
    UnequalRadii {
        /// The ball's centre.
        center: DVec3,
        /// Distance of the first foot.
        first: f64,
        /// Distance of the second foot.
        second: f64,
    },
    /// The tangents at the feet are parallel: the feet coincide, lie opposite each other, or share a normal.
    #[error(
        "the tangents at the feet {first} and {second} do not meet; the ball must touch two surfaces that are neither tangent nor back to back there"
    )]
    NoApex {
        /// First foot.
        first: DVec3,
        /// Second foot.
        second: DVec3,
    },
    /// A custom profile does not run from (1, 0, 0) to (0, 1, 0) within z = 0.
    #[error(
        "a custom profile must run from (1, 0, 0), the first foot, to (0, 1, 0), the second, with z = 0; this one has {point}"
    )]
    CustomFrame {
        /// The offending control point.
        point: DVec3,
    },
    /// A sweep needs two curves or more, and one rising parameter for each.
    #[error(
        "a sweep needs at least two curves with one strictly rising, finite parameter each; got {curves} curves and parameter {index} out of order (of {parameters})"
    )]
    Sweep {
        /// Curves given.
        curves: usize,
        /// Parameters given.
        parameters: usize,
        /// First parameter that does not rise.
        index: usize,
    },
}
