//! Why a mesh cannot be remeshed, smoothed or faired.

use glam::DVec3;
use mesh_core::{Cancelled, VertexId};

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A length that is no length.
    #[error("{name} is {value}; it must be positive and finite")]
    NotPositive {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A vertex that is no point in space, or so far out that squared lengths overflow.
    #[error(
        "vertex {vertex} is at {place}; coordinates must be finite and below 1e100: repair or scale the mesh first"
    )]
    NotFinite {
        /// The lowest such vertex.
        vertex: VertexId,
        /// Its coordinates.
        place: DVec3,
    },
    /// The result would not fit.
    #[error(
        "an edge length of {edge_length} needs about {faces:.0} triangles, more than {max}; the smallest that fits is about {smallest}"
    )]
    TooFine {
        /// What was asked for.
        edge_length: f64,
        /// How many triangles that makes.
        faces: f64,
        /// How many may be made.
        max: usize,
        /// The smallest edge length that fits.
        smallest: f64,
    },
    /// A list that should have one entry per vertex or face has another length.
    #[error("{name} has {found} entries for {expected}; give one for each, or leave it empty")]
    Count {
        /// Which list.
        name: &'static str,
        /// How many entries it has.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
    /// A linear system has no unique solution.
    #[error(
        "the system is singular near {at}: a piece of the region is joined to nothing that is held; hold at least one vertex of each piece"
    )]
    Singular {
        /// A vertex of the piece.
        at: DVec3,
    },
    /// Rounding is larger than what a linear system is to find.
    #[error(
        "the system cannot be solved near {at}: triangles are too thin or too many there; remesh first, or use a lower order or a smaller region"
    )]
    IllConditioned {
        /// Where it failed.
        at: DVec3,
    },
    /// See [`mesh_core::Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
