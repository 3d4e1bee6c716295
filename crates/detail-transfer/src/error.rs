//! What cannot be taken or given, and where.

use glam::DVec3;
use mesh_core::{Cancelled, VertexId};

/// Why there is no detail.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A region has no face, or a map of faces is not as long as its mesh.
    #[error("the {which} region holds no face of its mesh; give it a larger radius, or another place")]
    Empty {
        /// `"target"` or `"source"`.
        which: &'static str,
    },
    /// A coordinate is NaN, infinite or beyond 1e100.
    #[error("vertex {vertex} at {at} has no usable coordinates")]
    NotFinite {
        /// Which.
        vertex: VertexId,
        /// Where.
        at: DVec3,
    },
    /// A length is not positive and finite.
    #[error("{name} is {value}; it must be a positive length in model units")]
    Length {
        /// Which parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The source stands off its base in folds, flaps or handles: no displacement of a surface.
    #[error(
        "{:.1}% of the source folds over its own base surface, first near {at}{}: detail of another topology (handles, flaps, bowknots) cannot be carried; take a source without it, or a shorter wavelength",
        100.0 * share, if *.handles > 0 { format!(", and it has {handles} handles") } else { String::new() }
    )]
    Folded {
        /// The share of the source's area that folds over.
        share: f64,
        /// Where one fold is.
        at: DVec3,
        /// Handles of the source region.
        handles: usize,
    },
    /// No vertex of any source has its whole fan on the source.
    #[error(
        "no vertex of the source has a neighbourhood of radius {length} of its own around {at}; enlarge the source region or shorten the fans"
    )]
    SourceTooSmall {
        /// Length of the fans, in model units.
        length: f64,
        /// A place of the source.
        at: DVec3,
    },
    /// A governing curve needs two or more points.
    #[error("a governing curve needs two different points or more")]
    NoCurve,
    /// The curve does not pass both through detail and through the target.
    #[error(
        "the governing curve has {sources} anchors on the source and {targets} on the target near {at}; draw it from detail into the target, or give a curve on the source"
    )]
    CurveMisses {
        /// Anchors whose rectangle lies on the source.
        sources: usize,
        /// Anchors on the target.
        targets: usize,
        /// Where the curve begins.
        at: DVec3,
    },
    /// The equations are singular to working precision.
    #[error("the equations are singular near {at}: the triangles there are needles without area; remesh them")]
    Singular {
        /// A place of the patch.
        at: DVec3,
    },
    /// See [`mesh_core::Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// Where it happened, in model units.
    pub fn place(&self) -> Option<DVec3> {
        match *self {
            Self::NotFinite { at, .. }
            | Self::Folded { at, .. }
            | Self::SourceTooSmall { at, .. }
            | Self::CurveMisses { at, .. }
            | Self::Singular { at } => Some(at),
            Self::Empty { .. } | Self::Length { .. } | Self::NoCurve | Self::Cancelled(_) => None,
        }
    }
}
