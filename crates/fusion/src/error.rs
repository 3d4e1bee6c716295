//! Why a pipeline gives no result.

use crate::choice_refusal::Refusal as ChoiceRefusal;
use crate::compose::Error as ComposeError;
use crate::cut::Error as CutError;
use crate::document::Error as DocumentError;
use crate::invalid::Invalid;
use crate::operation::OptionError;
use crate::repair_refusal::Refusal as RepairRefusal;
use crate::sharpen::Refusal as SharpenRefusal;
use glam::DVec3;
use mesh_core::{Cancelled, NotManifold};
use rolling_blend as blend;
use tri_intersect::EmbedError;

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// An option has a value that it cannot have.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// Nothing to join.
    #[error("{0} solids given; a join needs two or more")]
    TooFew(usize),
    /// An input is no oriented 2-manifold.
    #[error("part {part} is {source}")]
    NotManifold {
        /// Which input, counting from 0.
        part: usize,
        /// All its defects.
        source: NotManifold,
    },
    /// The parts could not be joined.
    #[error("{}{source}", .step.map_or(String::new(), |k| format!("joining solid {k} (below: part 1) to those before it (part 0): ")))]
    Boolean {
        /// The input that was being joined to all before it, if there are more than two.
        step: Option<usize>,
        /// Why.
        source: tri_intersect::Error,
    },
    /// The models are too large or too small for what is to be measured on them.
    #[error("the models measure {size:e}; this works from 1e-100 to 1e100, so change their unit of length")]
    Extent {
        /// The diagonal of the box around all, or the largest coordinate, in model units.
        size: f64,
    },
    /// No feature curve can be blended.
    #[error("{0}")]
    NoCurve(String, Option<DVec3>),
    /// No curve can be chosen.
    #[error(transparent)]
    Choice(#[from] ChoiceRefusal),
    /// A seam could not be blended.
    #[error(transparent)]
    Blend(#[from] blend::Error),
    /// A seam is no closed chain of edges.
    #[error(transparent)]
    Seam(#[from] spine::Error),
    /// A rounding cannot be sharpened.
    #[error(transparent)]
    Sharpen(#[from] SharpenRefusal),
    /// The parts could not be composed.
    #[error(transparent)]
    Compose(#[from] ComposeError),
    /// A polyhedron cannot be blended by clusters as asked.
    #[error(transparent)]
    Cluster(#[from] edge_cluster::Error),
    /// Detail cannot be carried.
    #[error(transparent)]
    Detail(#[from] detail_transfer::Error),
    /// A region is not there.
    #[error("{0}")]
    Region(String),
    /// The surface could not be remeshed.
    #[error(transparent)]
    Remesh(#[from] remesh::Error),
    /// A document asks for what is not there.
    #[error(transparent)]
    Document(#[from] DocumentError),
    /// A step of a document failed.
    #[error("{name}: {source}")]
    Step {
        /// The step and what it works on.
        name: String,
        /// Why.
        source: Box<Self>,
    },
    /// A repair gives no solid.
    #[error(transparent)]
    Repair(#[from] RepairRefusal),
    /// A plane cannot cut.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// The result failed its own validation; nothing is returned.
    #[error(transparent)]
    Invalid(#[from] Invalid),
    /// See [`mesh_core::Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// Where it happened, in model units.
    pub fn place(&self) -> Option<DVec3> {
        use tri_intersect::Error as B;
        match self {
            Self::NotManifold { source, .. } | Self::Blend(blend::Error::Invalid(source)) => source.place,
            Self::Boolean { source, .. } => match *source {
                B::Open { at, .. }
                | B::Degenerate { at, .. }
                | B::Tangled { at, .. }
                | B::Rounding { at }
                | B::Contact { at }
                | B::SelfIntersecting { at, .. } => Some(at),
                _ => None,
            },
            Self::Blend(blend::Error::DoesNotFit { at, .. } | blend::Error::MeetsItself { at }) => Some(*at),
            Self::Blend(blend::Error::Keep(refusal)) => Some(refusal.place()),
            Self::Blend(blend::Error::Spine(error)) | Self::Seam(error) => error.place(),
            Self::Blend(blend::Error::Embed(error)) => match error {
                EmbedError::Crossings(all) => all.first().map(|c| c.place),
                EmbedError::Apart { place, .. } | EmbedError::TooSmall { place, .. } => Some(*place),
                _ => None,
            },
            Self::Sharpen(refusal) => Some(refusal.place()),
            Self::Cluster(error) => error.place(),
            Self::Cut(error) => error.place(),
            Self::Detail(error) => error.place(),
            Self::Step { source, .. } => source.place(),
            Self::Invalid(invalid) => invalid.at,
            Self::Compose(error) => error.place(),
            Self::NoCurve(_, at) => *at,
            Self::Choice(refusal) => refusal.place(),
            Self::Repair(refusal) => refusal.place(),
            Self::Remesh(
                remesh::Error::NotFinite { place, .. }
                | remesh::Error::Singular { at: place }
                | remesh::Error::IllConditioned { at: place },
            ) => Some(*place),
            Self::Option(_)
            | Self::Region(_)
            | Self::Remesh(_)
            | Self::Blend(_)
            | Self::TooFew(_)
            | Self::Extent { .. }
            | Self::Document(_)
            | Self::Cancelled(_) => None,
        }
    }

    /// Whether a result was made and found wanting.
    pub fn is_invalid_result(&self) -> bool {
        use tri_intersect::Error as B;
        matches!(
            self,
            Self::Invalid(_)
                | Self::Blend(blend::Error::Invalid(_))
                | Self::Boolean { source: B::SelfIntersecting { .. }, .. }
        ) || matches!(self, Self::Compose(error) if error.is_invalid_result())
            || matches!(self, Self::Step { source, .. } if source.is_invalid_result())
    }

    /// Whether the caller asked to stop.
    pub fn is_cancelled(&self) -> bool {
        use tri_intersect::Error as B;
        matches!(
            self,
            Self::Cancelled(_)
                | Self::Blend(blend::Error::Cancelled(_))
                | Self::Cluster(edge_cluster::Error::Cancelled(_))
                | Self::Remesh(remesh::Error::Cancelled(_))
                | Self::Detail(detail_transfer::Error::Cancelled(_))
                | Self::Boolean { source: B::Cancelled(_), .. }
        ) || matches!(self, Self::Compose(error) if error.is_cancelled())
            || matches!(self, Self::Cut(error) if error.is_cancelled())
            || matches!(self, Self::Step { source, .. } if source.is_cancelled())
    }
}
