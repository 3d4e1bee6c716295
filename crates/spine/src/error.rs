//! Why a ball cannot be rolled, and how far it came.

use crate::Patch;
use glam::DVec3;
use mesh_core::VertexId;
use std::sync::Arc;

/// Why a ball could not be rolled. Every variant names a place in model units.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Two consecutive vertices of a curve are not joined by an inner edge.
    #[error(
        "vertices {from} and {to} at {at} are not joined by an edge with two faces; a blend curve runs along mesh edges"
    )]
    NotAnEdge {
        /// First vertex.
        from: VertexId,
        /// Second vertex.
        to: VertexId,
        /// Where the first vertex is.
        at: DVec3,
    },
    /// The curve is partly a ridge and partly a valley.
    #[error("the curve changes between ridge and valley near {at} ({:.0}% of its length differs); split it there", 100.0 * .share)]
    MixedConvexity {
        /// Where the first edge of the lesser kind is.
        at: DVec3,
        /// Share of the length that is of the lesser kind.
        share: f64,
    },
    /// The radius is not a positive finite number.
    #[error("a radius of {radius} is not a positive length")]
    BadRadius {
        /// The radius given.
        radius: f64,
    },
    /// No ball can be seated anywhere on the curve.
    #[error("a ball of radius {radius} touches both sides nowhere along the curve at {at}; try a smaller radius")]
    NoStart {
        /// A point of the curve.
        at: DVec3,
        /// The radius tried.
        radius: f64,
    },
    /// The ball cannot go on.
    #[error("the ball cannot roll on at {at} with radius {radius}; a smaller radius (or a dip there) may pass")]
    Stuck {
        /// The ball's centre.
        at: DVec3,
        /// Its radius there.
        radius: f64,
        /// The radius away from dips.
        wanted: f64,
    },
    /// The spine does not close.
    #[error(
        "the spine has not come back after {travelled}, at {at}, on a curve of length {curve}; try a smaller radius"
    )]
    Astray {
        /// Where the trace was given up.
        at: DVec3,
        /// How far it had gone.
        travelled: f64,
        /// Length of the blend curve.
        curve: f64,
    },
    /// The offset patches do not cross in a closed curve.
    #[error(
        "the patches moved by {radius} cross in no closed curve near {at}; try a smaller radius or the contact solver"
    )]
    NoLoop {
        /// Where the longest open crossing ends, or else a point of the curve.
        at: DVec3,
        /// The radius there.
        radius: f64,
    },
    /// The offset patches cross where they are folded, farther than can be bridged.
    #[error(
        "a patch moved by {radius} folds over at {at}, so no ball fits; try a smaller radius or the contact solver"
    )]
    Folded {
        /// The middle of the fold.
        at: DVec3,
        /// The radius there.
        radius: f64,
    },
    /// The step is lost beside the length of the spine.
    #[error("a spine of length {length} at {at} cannot be walked in steps of {step}; take a larger radius or step")]
    TooFine {
        /// A point of the spine.
        at: DVec3,
        /// Its length.
        length: f64,
        /// The step asked for.
        step: f64,
    },
    /// The patch has coordinates that boxes cannot hold.
    #[error(transparent)]
    Query(#[from] mesh_query::Error),
}

impl Error {
    /// Where it happened, if it happened somewhere.
    pub fn place(&self) -> Option<DVec3> {
        match *self {
            Self::NotAnEdge { at, .. }
            | Self::MixedConvexity { at, .. }
            | Self::NoStart { at, .. }
            | Self::Stuck { at, .. }
            | Self::Astray { at, .. }
            | Self::NoLoop { at, .. }
            | Self::TooFine { at, .. }
            | Self::Folded { at, .. } => Some(at),
            Self::BadRadius { .. } | Self::Query(_) => None,
        }
    }
}

/// A ball that did not come all the way: why, and what there is to look at.
#[derive(Clone, Debug)]
pub struct Halt {
    /// Why.
    pub error: Error,
    /// The base patches, if they had been flooded.
    pub patches: Option<Arc<[Patch; 2]>>,
    /// Centres of the balls on the way so far, in order.
    pub balls: Vec<DVec3>,
}

impl From<Error> for Box<Halt> {
    fn from(error: Error) -> Self {
        Self::new(Halt { error, patches: None, balls: Vec::new() })
    }
}

impl From<mesh_query::Error> for Box<Halt> {
    fn from(error: mesh_query::Error) -> Self {
        Error::from(error).into()
    }
}
