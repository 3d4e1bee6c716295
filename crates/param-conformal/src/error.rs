//! What cannot be mapped, and where.

use glam::DVec3;
use mesh_core::{FaceId, VertexId};

/// Why there is no map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The surface is not one piece with two boundary loops and no handle.
    #[error(
        "a ring has one piece, two boundary loops and Euler characteristic 0; this surface has {pieces} pieces, {loops} loops and characteristic {characteristic}"
    )]
    NotARing {
        /// Connected pieces.
        pieces: usize,
        /// Boundary loops.
        loops: usize,
        /// Vertices − edges + faces.
        characteristic: i64,
    },
    /// The surface is not one piece with one boundary loop and no handle.
    #[error(
        "a disc has one piece, one boundary loop and Euler characteristic 1; this surface has {pieces} pieces, {loops} loops and characteristic {characteristic}"
    )]
    NotADisc {
        /// Connected pieces.
        pieces: usize,
        /// Boundary loops.
        loops: usize,
        /// Vertices − edges + faces.
        characteristic: i64,
    },
    /// No chain of inner edges joins the two loops.
    #[error("no path of inner edges leads from vertex {from} at {at} to the other boundary; refine the surface there")]
    NoSeam {
        /// Where the path was to begin.
        from: VertexId,
        /// Its place.
        at: DVec3,
    },
    /// The seam does not lead from the first loop to the second through inner vertices.
    #[error(
        "the seam must run head to tail from the first boundary loop to the second through inner vertices; step {step} does not"
    )]
    BadSeam {
        /// The offending step.
        step: usize,
    },
    /// The boundary values do not fit the boundary.
    #[error(
        "{expected} boundary values are needed in rising order within the period, {given} were given (first fault at {index})"
    )]
    Outline {
        /// Boundary vertices.
        expected: usize,
        /// Values given.
        given: usize,
        /// First value that is missing, not finite or out of order.
        index: usize,
    },
    /// A coordinate is NaN, infinite or beyond 1e100.
    #[error("vertex {vertex} at {at} has no usable coordinates")]
    NotFinite {
        /// Which.
        vertex: VertexId,
        /// Where.
        at: DVec3,
    },
    /// Nothing fixes the value of a vertex: its piece has no fixed vertex, or all its triangles are without area.
    #[error(
        "nothing ties vertex {vertex} at {at} to a fixed one; fix a vertex of its piece, or remove triangles without area there"
    )]
    Loose {
        /// Which.
        vertex: VertexId,
        /// Where.
        at: DVec3,
    },
    /// The equations are singular to working precision.
    #[error(
        "the equations are singular near vertex {vertex} at {at}: the triangles there are needles without area; remesh them"
    )]
    Singular {
        /// Which.
        vertex: VertexId,
        /// Where.
        at: DVec3,
    },
    /// The map turns triangles over or flattens them.
    #[error("{count} triangles are turned over or flattened by the map, first {face} at {at}; {}", remedy(*.pinned))]
    Flipped {
        /// The first one.
        face: FaceId,
        /// Its middle, in model units.
        at: DVec3,
        /// How many there are.
        count: usize,
        /// Whether all its corners lie on one straight side of the boundary, so that it can have no area.
        pinned: bool,
    },
}

fn remedy(pinned: bool) -> &'static str {
    if pinned {
        "its corners all lie on one side of the outline: remove it from the region, or split its inner edge"
    } else {
        "map with `Weights::Uniform`, or remesh obtuse triangles"
    }
}
