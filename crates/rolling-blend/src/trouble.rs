//! What goes wrong while a blend is made, and where: the places at which the ball is then made smaller.

use crate::error::Error;
use glam::DVec3;
use mesh_core::{Cancelled, NotManifold};
use tri_intersect::EmbedError;

/// A stage's refusal.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Trouble {
    /// Places where a smoother linkage or a smaller ball may help.
    Places {
        /// What happened there.
        what: &'static str,
        /// Where, in model units.
        places: Vec<DVec3>,
    },
    /// Nodes at which a curve cannot stop at the surface ahead: it has to run out.
    NoStop(Vec<usize>),
    /// The place of a corner between curves with two radii.
    TwoRadiiMeet(DVec3),
    /// The curves could not be embedded for another reason.
    Embed(EmbedError),
    /// The rolling itself failed for a reason without a place.
    Spine(spine::Error),
    /// The caller asked to stop.
    Cancelled(Cancelled),
}

impl Trouble {
    /// For the caller, if no smaller radius is to be looked for.
    pub fn into_error(self, radius: f64) -> Error {
        match self {
            Self::Places { what, places } => {
                Error::DoesNotFit { what, at: places.first().copied().unwrap_or(DVec3::ZERO), radius, workable: None }
            }
            // Every such node was made to run out, so this is not reached with any left.
            Self::NoStop(_) => Error::NoCurves,
            Self::TwoRadiiMeet(at) => Error::TwoRadiiMeet(at),
            Self::Embed(e) => e.into(),
            Self::Spine(e) => e.into(),
            Self::Cancelled(c) => c.into(),
        }
    }

    /// The first place, if there is one.
    pub fn place(&self) -> Option<DVec3> {
        match self {
            Self::Places { places, .. } => places.first().copied(),
            Self::TwoRadiiMeet(at) => Some(*at),
            _ => None,
        }
    }

    /// What happened, in short.
    pub fn what(&self) -> &'static str {
        match self {
            Self::Places { what, .. } => what,
            _ => "the blend fails",
        }
    }

    pub fn at(what: &'static str, places: Vec<DVec3>) -> Self {
        Self::Places { what, places }
    }

    /// What a mesh that is no manifold means.
    pub fn not_manifold(what: &'static str) -> impl FnOnce(NotManifold) -> Self {
        move |refusal| Self::at(what, refusal.place.into_iter().collect())
    }
}

impl From<Cancelled> for Trouble {
    fn from(c: Cancelled) -> Self {
        Self::Cancelled(c)
    }
}
