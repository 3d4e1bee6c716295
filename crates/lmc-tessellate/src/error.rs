//! Everything that can go wrong, with its place and the way out.

use glam::DVec3;
use mesh_core::Cancelled;

/// Why a zero set could not be tessellated between its rims. Rims count from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A rim has fewer than three points, a coordinate that is no finite number, or not one normal for each edge.
    #[error("rim {rim} is not a closed curve of at least three finite points with a normal for each edge")]
    BadRim {
        /// The rim.
        rim: usize,
    },
    /// The cell size is not a positive number that the rims' coordinates can resolve.
    #[error("a cell size of {cell} cannot be used here; take about 0.8 of the rims' mean edge, {suggested}")]
    BadCell {
        /// The size asked for, in model units.
        cell: f64,
        /// A size that would work.
        suggested: f64,
    },
    /// The field is not a number somewhere on its zero set.
    #[error("the field is not a number at {at}")]
    NotANumber {
        /// Where.
        at: DVec3,
    },
    /// The field grows towards the inside of a part: the part is oriented against the field.
    #[error(
        "around rim {rim} at {at} the field grows inward: the part there is turned inside out, or its constraints are"
    )]
    Inverted {
        /// The rim.
        rim: usize,
        /// One of its points.
        at: DVec3,
    },
    /// The zero set leaves the working space around the rims.
    #[error(
        "the surface leaves the working space at {at}; guide it there with a silhouette, bring the parts closer, or enlarge the space"
    )]
    Unbounded {
        /// Where it left.
        at: DVec3,
    },
    /// More cells than allowed.
    #[error("the surface takes more than {cells} cells, around {at}; enlarge the cells")]
    TooLarge {
        /// The limit.
        cells: usize,
        /// Where the search stopped.
        at: DVec3,
    },
    /// A sheet that starts outward from one rim arrives at a rim from inside its part.
    #[error(
        "near {at} the surface runs into the part behind rim {rim}; check the orientation of the parts, or guide the surface with a silhouette"
    )]
    Leak {
        /// The rim.
        rim: usize,
        /// Where.
        at: DVec3,
    },
    /// The gap between rims and surface could not be triangulated.
    #[error("the gap at rim {rim} near {at} has no triangulation; make the cells smaller or move the boundaries apart")]
    Gap {
        /// One of the rims there.
        rim: usize,
        /// Where.
        at: DVec3,
    },
}
