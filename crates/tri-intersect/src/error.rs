//! Everything that can go wrong, with its place and the way out.

use glam::DVec3;
use mesh_core::{Cancelled, FaceId, VertexId};

/// Why an operation could not be done. `part` counts the inputs from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of part {part} has a coordinate that is not a finite number; remove it or mend the file")]
    NotFinite {
        /// The input.
        part: u32,
        /// The vertex there.
        vertex: VertexId,
    },
    /// An input has a boundary, so it bounds no solid.
    #[error("part {part} is open: it has a boundary at {at}; close its holes first")]
    Open {
        /// The input.
        part: u32,
        /// A point on the boundary.
        at: DVec3,
    },
    /// An input encloses a negative volume: its normals point inward.
    #[error("part {part} is inside out (signed volume {volume}); turn it with `convert --orient`")]
    InsideOut {
        /// The input.
        part: u32,
        /// Its signed volume, in cubed model units.
        volume: f64,
    },
    /// A face without area is crossed by the other part, so the cut through it has no direction.
    #[error(
        "face {face} of part {part} at {at} has no area and is crossed by the other part; remove degenerate faces first"
    )]
    Degenerate {
        /// The input.
        part: u32,
        /// The face there.
        face: FaceId,
        /// One of its corners.
        at: DVec3,
    },
    /// The intersection curves do not divide a part into inside and outside: it intersects itself near the seam.
    #[error(
        "part {part} intersects itself near {at}, where the seam passes; mend the self-intersection or move the part"
    )]
    Tangled {
        /// The input.
        part: u32,
        /// Where inside and outside disagree, or where a chain ends.
        at: DVec3,
    },
    /// The cut cannot be written in 64-bit numbers without folding the surface.
    #[error(
        "the parts graze each other near {at} more closely than 64-bit coordinates can tell apart; move one of them slightly"
    )]
    Rounding {
        /// The place.
        at: DVec3,
    },
    /// The solids touch along an edge or at a vertex, so that the result would pinch there.
    #[error(
        "the parts touch without overlapping near {at}, so the result would not be a manifold there; move one of them, or split the contact"
    )]
    Contact {
        /// The place.
        at: DVec3,
    },
    /// The result failed its own check.
    #[error("the result intersects itself near {at}: its faces {} and {} meet; move one part slightly", .faces[0], .faces[1])]
    SelfIntersecting {
        /// Two faces of the result that meet.
        faces: [FaceId; 2],
        /// A corner of the first.
        at: DVec3,
    },
    /// The result is the empty set: the intersection of disjoint solids, or a solid less one that covers it.
    #[error("nothing is left: {0}")]
    Empty(&'static str),
}

impl Error {
    /// The same error, when what the operation saw as part 1 is really part `number`.
    pub(crate) fn renumbered(mut self, number: u32) -> Self {
        if let Self::NotFinite { part, .. }
        | Self::Open { part, .. }
        | Self::InsideOut { part, .. }
        | Self::Degenerate { part, .. }
        | Self::Tangled { part, .. } = &mut self
            && *part == 1
        {
            *part = number;
        }
        self
    }
}
