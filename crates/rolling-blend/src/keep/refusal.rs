//! What `keep` cannot serve, and why.

use glam::DVec3;
use mesh_core::{FaceId, VertexId};

/// Why vertices cannot be slid onto the blend. Sewing (`--surface stitch`) has none of these limits.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No profile can be drawn.
    #[error("no profile can be drawn at {at}: {source}")]
    Profile {
        /// The ball's centre.
        at: DVec3,
        /// Why.
        source: profile_nurbs::Error,
    },
    /// The cross-section varies.
    #[error(
        "the profile asked for at {at} cannot be kept apart from the others; give one profile, or take the surface `stitch`"
    )]
    KeyedProfiles {
        /// Where.
        at: DVec3,
    },
    /// The region has an edge of the mesh in it.
    #[error("the blend reaches the boundary of the mesh at {at}; take a smaller radius, or the surface `stitch`")]
    Boundary {
        /// Where.
        at: DVec3,
    },
    /// The region is no ring.
    #[error(
        "the region around the curve at {at} is no ring that can be cut open into a rectangle: {loops} boundary loops in {pieces} pieces; it has holes, or meets itself; take a smaller radius, or the surface `stitch`"
    )]
    NotARing {
        /// A point of the region.
        at: DVec3,
        /// Boundary loops.
        loops: usize,
        /// Pieces.
        pieces: usize,
    },
    /// The region's border pinches, however it is widened.
    #[error(
        "the region's border pinches at vertex {vertex} at {at}; refine the mesh there, or take the surface `stitch`"
    )]
    Pinched {
        /// Where the border meets itself.
        vertex: VertexId,
        /// Its place.
        at: DVec3,
    },
    /// Two regions share vertices.
    #[error(
        "the regions of two curves share a vertex at {at}; blend them one after the other, or with a smaller radius"
    )]
    Overlap {
        /// Where.
        at: DVec3,
    },
    /// Triangles are too large for the bend they must follow.
    #[error(
        "the mesh is too coarse for a radius of {radius} at {at}: an edge of length {edge} stands off the surface by {sagitta}; refine the mesh there, take a larger radius, or the surface `stitch`"
    )]
    TooCoarse {
        /// Middle of the edge.
        at: DVec3,
        /// Its length.
        edge: f64,
        /// The ball's radius.
        radius: f64,
        /// How far its middle is from the surface there.
        sagitta: f64,
    },
    /// The border cannot be laid along a linkage in order.
    #[error(
        "the border vertices near {at} do not follow one another along the linkage; refine the mesh there, or take the surface `stitch`"
    )]
    Border {
        /// Where.
        at: DVec3,
    },
    /// The map could not be made, or turns triangles over.
    #[error("the region around {at} cannot be flattened: {source}")]
    Map {
        /// A point of the region.
        at: DVec3,
        /// Why.
        source: param_conformal::Error,
    },
    /// A triangle of the region is turned over in the parameter domain after smoothing.
    #[error(
        "{count} triangles stay turned over in the parameter domain after smoothing, first {face} at {at}; refine the mesh there, or take the surface `stitch`"
    )]
    Flipped {
        /// The first one.
        face: FaceId,
        /// Its middle in the input.
        at: DVec3,
        /// How many there are.
        count: usize,
    },
    /// A triangle beside the region would leave its surface.
    #[error(
        "triangle {face} at {at} beside the blend would turn by more than 60 degrees as its border moves to the linkage: the mesh is too coarse there for this radius; refine it, or take the surface `stitch`"
    )]
    Sheared {
        /// Which.
        face: FaceId,
        /// Its middle in the result.
        at: DVec3,
    },
    /// The result would meet itself.
    #[error(
        "{pairs} pairs of triangles would intersect, first at {at}; take a smaller radius, another profile, or the surface `stitch`"
    )]
    Meets {
        /// How many.
        pairs: usize,
        /// Where the first is.
        at: DVec3,
    },
}

impl Refusal {
    /// Where it happened, in model units.
    pub fn place(&self) -> DVec3 {
        match *self {
            Self::KeyedProfiles { at }
            | Self::Profile { at, .. }
            | Self::Boundary { at }
            | Self::NotARing { at, .. }
            | Self::Pinched { at, .. }
            | Self::Overlap { at }
            | Self::TooCoarse { at, .. }
            | Self::Border { at }
            | Self::Map { at, .. }
            | Self::Flipped { at, .. }
            | Self::Sheared { at, .. }
            | Self::Meets { at, .. } => at,
        }
    }
}
