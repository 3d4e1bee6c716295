//! Why parts cannot be composed, where, and what would help.

use glam::DVec3;
use mesh_core::Cancelled;

/// Why there is no composition. Parts and loops count from 0, loops in the order of `info`.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No part has a boundary.
    #[error("no part has an opening; cut the parts open where they are to be joined (`cut`)")]
    Closed,
    /// A loop that is not there.
    #[error("part {part} has {count} boundary loops, so there is no loop {index}; `info` lists them")]
    NoLoop {
        /// The part.
        part: usize,
        /// The loop asked for.
        index: usize,
        /// How many it has.
        count: usize,
    },
    /// A part's normals point inward.
    #[error(
        "part {part} is inside out near {at}: closed at its openings it would enclose a negative volume; turn its faces over"
    )]
    InsideOut {
        /// The part.
        part: usize,
        /// A place on it.
        at: DVec3,
    },
    /// Two parts cross.
    #[error("parts {first} and {second} cross at {at}; move them apart, or join them with `union`")]
    Overlap {
        /// One part.
        first: usize,
        /// The other.
        second: usize,
        /// Where.
        at: DVec3,
    },
    /// An opening lies inside the solid of another part.
    #[error(
        "loop {index} of part {part} lies inside part {other} at {at}; move one of them so that openings face free space"
    )]
    Buried {
        /// The part with the opening.
        part: usize,
        /// Its loop.
        index: usize,
        /// The part around it.
        other: usize,
        /// A point of the loop.
        at: DVec3,
    },
    /// An opening cannot be trimmed.
    #[error("loop {index} of part {part} cannot be moved back: {source}")]
    Adjust {
        /// The part.
        part: usize,
        /// Its loop.
        index: usize,
        /// Why.
        source: Box<crate::cut::Error>,
    },
    /// Trimming an opening has made several of it, or run into another.
    #[error(
        "moving the openings apart makes several of loop {index} of part {part}, near {at}, or joins it with another; ask for a smaller distance, or move the parts apart"
    )]
    Trimmed {
        /// The part.
        part: usize,
        /// Its loop.
        index: usize,
        /// A place on it.
        at: DVec3,
    },
    /// A silhouette cannot be led as drawn.
    #[error("silhouette {index}, near {at}: {reason}")]
    Silhouette {
        /// Which, counting from 0.
        index: usize,
        /// Where, in model units.
        at: DVec3,
        /// Why, and what would help.
        reason: &'static str,
    },
    /// The surface closes openings instead of joining them.
    #[error(
        "the surface falls into {pieces} pieces: loop {index} of part {part}, around {at}, is not joined to the rest; bring the openings closer or turn them towards each other, lead the surface with a silhouette, or try another --kernel"
    )]
    Apart {
        /// Connected pieces of the result.
        pieces: usize,
        /// A part that is left alone.
        part: usize,
        /// One of its loops.
        index: usize,
        /// Around where.
        at: DVec3,
        /// The loops, as (part, loop), that hang together with the first.
        joined: Vec<(usize, usize)>,
    },
    /// The surface crosses a part or itself.
    #[error(
        "the surface crosses {what} near {at}, in {pairs} pairs of faces; move the openings apart there or turn them towards each other, lead the surface with a silhouette, or try another --kernel"
    )]
    Crossing {
        /// What is crossed: a part by number, or itself.
        what: String,
        /// How many pairs of faces.
        pairs: usize,
        /// Where.
        at: DVec3,
    },
    /// The field could not be fitted.
    #[error(transparent)]
    Field(#[from] rbf_solve::Error),
    /// The surface could not be tessellated.
    #[error(transparent)]
    Surface(#[from] lmc_tessellate::Error),
    /// The surface could not be remeshed.
    #[error(transparent)]
    Remesh(#[from] remesh::Error),
    /// See [`mesh_core::Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// Where it happened, in model units.
    pub fn place(&self) -> Option<DVec3> {
        use lmc_tessellate::Error as L;
        match self {
            Self::InsideOut { at, .. }
            | Self::Overlap { at, .. }
            | Self::Buried { at, .. }
            | Self::Apart { at, .. }
            | Self::Silhouette { at, .. }
            | Self::Trimmed { at, .. }
            | Self::Crossing { at, .. }
            | Self::Surface(
                L::NotANumber { at }
                | L::Inverted { at, .. }
                | L::Unbounded { at }
                | L::TooLarge { at, .. }
                | L::Leak { at, .. }
                | L::Gap { at, .. },
            )
            | Self::Field(
                rbf_solve::Error::Flat { at, .. }
                | rbf_solve::Error::Contradiction { at, .. }
                | rbf_solve::Error::Singular { at, .. }
                | rbf_solve::Error::NotConverged { at, .. },
            ) => Some(*at),
            Self::Adjust { source, .. } => source.place(),
            _ => None,
        }
    }

    /// Whether a result was made and found wanting.
    pub fn is_invalid_result(&self) -> bool {
        matches!(self, Self::Crossing { .. })
    }

    /// Whether the caller asked to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Field(rbf_solve::Error::Cancelled)
                | Self::Surface(lmc_tessellate::Error::Cancelled(_))
                | Self::Remesh(remesh::Error::Cancelled(_))
        ) || matches!(self, Self::Adjust { source, .. } if source.is_cancelled())
    }
}
