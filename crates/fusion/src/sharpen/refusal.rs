//! Why a rounding cannot be sharpened, and where.

use glam::DVec3;

/// Why a rounding cannot be sharpened. Each names a place in model units.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No ball is limited there by anything but walls.
    #[error("the surface nearest to {at} is not rounded; name a place on a fillet, or give its radius")]
    NotRounded {
        /// The place that was picked.
        at: DVec3,
    },
    /// The rounding reaches the mesh's boundary.
    #[error("the rounding reaches the boundary of the mesh at {at}; close the mesh first")]
    Boundary {
        /// Where.
        at: DVec3,
    },
    /// The rounding is neither a ring nor a strip between creases.
    #[error(
        "the rounding at {at} is no band between two surfaces: its border has {loops} loops and {ends} ends at creases; it meets others in rounded corners, or runs out, which cannot be sharpened; a smaller radius may tell it from its neighbours"
    )]
    NotABand {
        /// A point of its border.
        at: DVec3,
        /// How many loops bound it.
        loops: usize,
        /// At how many creases it ends.
        ends: usize,
    },
    /// A fillet in a valley that ends at a crease.
    #[error(
        "the fillet ends in a face at {at} that would have to lose a part; only ridges and closed fillets are sharpened"
    )]
    OpenValley {
        /// A point of the end.
        at: DVec3,
    },
    /// The surfaces on both sides do not meet.
    #[error("the surfaces on both sides of the rounding at {at} are parallel, so no edge lies between them")]
    Parallel {
        /// Half-way between them.
        at: DVec3,
    },
    /// The edge does not meet the surface at its end.
    #[error("the edge would run along the surface at which the rounding ends near {at}; cut the part there first")]
    Grazing {
        /// Where.
        at: DVec3,
    },
    /// The result would meet itself, or pinch.
    #[error("sharpened, the surface would meet itself at {at}")]
    Meets {
        /// Where.
        at: DVec3,
    },
}

impl Refusal {
    /// Where.
    pub fn place(&self) -> DVec3 {
        match *self {
            Self::NotRounded { at }
            | Self::Boundary { at }
            | Self::NotABand { at, .. }
            | Self::OpenValley { at }
            | Self::Parallel { at }
            | Self::Grazing { at }
            | Self::Meets { at } => at,
        }
    }
}
