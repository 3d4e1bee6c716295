//! Why a cut is not possible.

use glam::DVec3;
use mesh_core::Cancelled;
use tri_intersect::EmbedError;

/// Why a cut is not possible.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The normal is zero, or a number is not finite.
    #[error("no plane goes through {point} with normal {normal}; give finite numbers and a normal other than 0,0,0")]
    NoPlane {
        /// The point given.
        point: DVec3,
        /// The normal given.
        normal: DVec3,
    },
    /// The plane passes the mesh by.
    #[error(
        "the plane does not cross the mesh, which lies from {low} to {high} along the normal as measured from the plane; move the point of the plane to there"
    )]
    Misses {
        /// Least signed distance of a vertex, in model units.
        low: f64,
        /// Greatest.
        high: f64,
    },
    /// What is left and right of the contour hangs together elsewhere.
    #[error(
        "the cut through {at} does not part the mesh: its two sides hang together elsewhere; cut there first, or all contours of the plane at once (no seed)"
    )]
    DoesNotSeparate {
        /// A point of the contour.
        at: DVec3,
    },
    /// The rim would meet itself at one vertex.
    #[error("the plane touches the mesh at {at} so that the rim would meet itself there; move the plane by a little")]
    Pinched {
        /// Where.
        at: DVec3,
    },
    /// A pick is of no use.
    #[error("pick near {at}: {reason}")]
    Pick {
        /// The pick.
        at: DVec3,
        /// Why, and what would help.
        reason: &'static str,
    },
    /// Two picks are not joined by surface that the path has not used yet.
    #[error(
        "there is no way over the surface from {from} to {to} that keeps clear of the path before it; order the picks round the limb, on one piece of the mesh"
    )]
    NoPath {
        /// The pick it begins at.
        from: DVec3,
        /// The next.
        to: DVec3,
    },
    /// A path meets itself.
    #[error("the path meets itself at {at}; spread the picks round the limb, smooth less, or lessen the snap")]
    Crossed {
        /// Where.
        at: DVec3,
    },
    /// A smoothed curve cannot be put back on the surface.
    #[error("the smoothed curve through {at} cannot be put back on the surface; take fewer rounds of smoothing")]
    Lost {
        /// A place on it.
        at: DVec3,
    },
    /// A crossed face cannot be split.
    #[error(transparent)]
    Embed(#[from] EmbedError),
    /// See [`mesh_core::Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// Where it happened, in model units.
    pub fn place(&self) -> Option<DVec3> {
        match self {
            Self::DoesNotSeparate { at }
            | Self::Pinched { at }
            | Self::Pick { at, .. }
            | Self::NoPath { from: at, .. }
            | Self::Crossed { at }
            | Self::Lost { at } => Some(*at),
            Self::Embed(EmbedError::TooSmall { place, .. } | EmbedError::Apart { place, .. }) => Some(*place),
            _ => None,
        }
    }

    /// Whether the caller asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled(_) | Self::Embed(EmbedError::Cancelled(_)))
    }
}
