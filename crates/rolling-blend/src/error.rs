//! Why a blend is impossible, and where.

use crate::keep;
use glam::DVec3;
use mesh_core::{Cancelled, NotManifold};

/// Why a blend is impossible.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Error {
    /// There is nothing to blend.
    #[error("no blend curve given; lower the dihedral angle, or name a curve")]
    NoCurves,
    /// A field cannot do what is asked for.
    #[error("a field blends closed curves with an arc; {0}")]
    NotByField(&'static str),
    /// The radius does not fit.
    #[error(
        "{what} at {at} with radius {radius}; {}",
        .workable.map_or("no smaller radius tried worked either".to_string(), |r| format!("a radius of {r} works"))
    )]
    DoesNotFit {
        /// What went wrong there.
        what: &'static str,
        /// Where, in model units.
        at: DVec3,
        /// The radius asked for.
        radius: f64,
        /// The largest of the smaller radii tried that works everywhere.
        workable: Option<f64>,
    },
    /// The mesh is not sound before anything is blended.
    #[error(
        "the mesh meets itself near {at}, beside an edge that is to be blended; mend that first, or blend other edges"
    )]
    MeetsItself {
        /// The middle of a face that does.
        at: DVec3,
    },
    /// The blend would have too many vertices.
    #[error(
        "a ball of radius {radius} is too small for these curves: the blend would have some {vertices:.0e} vertices; the least radius is about {least:.1e}"
    )]
    TooFine {
        /// The radius asked for.
        radius: f64,
        /// About how many vertices the blend would have.
        vertices: f64,
        /// About the least radius that is taken, in model units.
        least: f64,
    },
    /// The ball could not be rolled for a reason that no smaller radius mends.
    #[error(transparent)]
    Spine(#[from] spine::Error),
    /// A corner of a blend with two radii.
    #[error(
        "three or more curves meet at {0}, where a blend with two radii has no corner; blend the curves in several calls, or with one radius"
    )]
    TwoRadiiMeet(DVec3),
    /// Vertices cannot be slid onto the surface.
    #[error(transparent)]
    Keep(#[from] keep::Refusal),
    /// The linkages could not be cut into the mesh.
    #[error(transparent)]
    Embed(#[from] tri_intersect::EmbedError),
    /// A stage made a mesh that is not a manifold; nothing is returned.
    #[error("the blend failed its own check: {0}")]
    Invalid(#[from] NotManifold),
    /// See [`Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
