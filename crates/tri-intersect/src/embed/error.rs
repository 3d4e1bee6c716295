//! Why curves cannot be embedded, and where.

use glam::DVec3;
use mesh_core::{Cancelled, FaceId};

/// Two pieces of curve that meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Where, in model units.
    pub place: DVec3,
    /// A face of the input around the place.
    pub face: FaceId,
    /// The two curves, which may be the same.
    pub curves: [usize; 2],
    /// On each, the input point at which the piece that meets the other begins.
    pub points: [usize; 2],
}

/// Why curves cannot be embedded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EmbedError {
    /// Curves cross or touch, each other or themselves. At least one crossing is listed for every face in which there are any.
    #[error("{} crossings of curves, the first of curve {} with curve {} at {}; part or shorten the curves there", .0.len(), .0[0].curves[0], .0[0].curves[1], .0[0].place)]
    Crossings(Vec<Crossing>),
    /// Two consecutive points have no face in common.
    #[error(
        "points {point} and the next of curve {curve} share no face, at {place}; trace the curve over the surface first"
    )]
    Apart {
        /// The curve.
        curve: usize,
        /// The earlier point.
        point: usize,
        /// Where it is, in model units.
        place: DVec3,
    },
    /// A point is not on the mesh: an unknown element, a number that is not finite, or a parameter out of range.
    #[error("point {point} of curve {curve} is not on the mesh; name an existing element and parameters within it")]
    BadPoint {
        /// The curve.
        curve: usize,
        /// The point.
        point: usize,
    },
    /// A curve has too few distinct points: two if open, three if closed.
    #[error("curve {curve} shrinks to a point; it needs two distinct points if open, three if closed")]
    Collapsed {
        /// The curve.
        curve: usize,
    },
    /// Points of a curve coincide with a corner of a face after rounding, and no smaller step exists.
    #[error("face {face} at {place} is too small to be split in f64 numbers; collapse it or move the curve off it")]
    TooSmall {
        /// The face of the input.
        face: FaceId,
        /// Where it is, in model units.
        place: DVec3,
    },
    /// The result would have more than `u32::MAX / 3` faces or vertices.
    #[error("the result needs more than 2^32 / 3 elements; embed fewer or shorter curves")]
    TooMany,
    /// See [`mesh_core::Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
