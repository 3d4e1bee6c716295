//! Why there is no blend.

use glam::DVec3;

/// Why a polyhedron or a cluster of it cannot be blended as asked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The mesh is no oriented 2-manifold.
    #[error("not a polyhedron: {0}")]
    NotManifold(String, Option<DVec3>),
    /// The mesh has a boundary.
    #[error("not a polyhedron: the mesh has a boundary at {0}; close it first")]
    Open(DVec3),
    /// A face is not planar.
    #[error(
        "face {face} is not planar: the vertex at {at} is {off} off its plane, more than {tolerance}; a curved model has no planes to keep contact with, use `blend` for it"
    )]
    NotPlanar {
        /// Which planar face, in order of lowest triangle.
        face: usize,
        /// The vertex.
        at: DVec3,
        /// Its distance from the plane, in model units.
        off: f64,
        /// The largest distance allowed, in model units.
        tolerance: f64,
    },
    /// Faces meet in a way no polyhedron's do.
    #[error(
        "two faces share several edges, or a face touches itself, at vertex {vertex} ({at}); move the vertices apart"
    )]
    Pinched {
        /// The vertex.
        vertex: u32,
        /// Where it is.
        at: DVec3,
    },
    /// There are too many vertices for one patch each.
    #[error(
        "the polyhedron has {vertices} vertices, whose patches would have {points} control points, more than {most}; for a scan or a curved model use `blend`, or name the clusters, or decimate it first"
    )]
    TooLarge {
        /// How many vertices.
        vertices: usize,
        /// How many control points, if each had a patch.
        points: usize,
        /// The largest number that is tried.
        most: usize,
    },
    /// A set of vertices is no cluster.
    #[error("the cluster of vertices {vertices:?} at {at} {why}")]
    NoCluster {
        /// The vertices.
        vertices: Vec<u32>,
        /// The first of them.
        at: DVec3,
        /// What is wrong.
        why: &'static str,
    },
    /// A vertex is in two clusters.
    #[error("vertex {vertex} at {at} is in two clusters; leave it out of one")]
    TwoClusters {
        /// The vertex.
        vertex: u32,
        /// Where it is.
        at: DVec3,
    },
    /// The degree does not exist.
    #[error("degree {degree} is out of range: {why}")]
    Degree {
        /// As asked for.
        degree: String,
        /// What would be in range.
        why: &'static str,
    },
    /// A control point would have to be in several places at once.
    #[error(
        "a patch of degree {degree} cannot have contact of order {continuity} around the cluster at {at}: control point {index:?} would have to lie in the planes of sides {sides:?} at once, which have no common point or pin a corner; {}",
        .works.as_ref().map_or("no degree tried works".to_string(), |d| format!("degree {d} works"))
    )]
    Conflict {
        /// The degree asked for.
        degree: String,
        /// The order of contact asked for.
        continuity: usize,
        /// The cluster's first vertex.
        at: DVec3,
        /// The control point's index.
        index: Vec<u8>,
        /// The sides, counting from 1.
        sides: Vec<usize>,
        /// The lowest degree that works.
        works: Option<String>,
    },
    /// A control point was named that does not exist.
    #[error("the patch of degree {degree} has no control point {index:?}")]
    NoControlPoint {
        /// The index asked for.
        index: Vec<u8>,
        /// The patch's degree.
        degree: String,
    },
    /// An option is out of range.
    #[error("{name} is {value}, which is not in {range}")]
    Range {
        /// Which option.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The values allowed.
        range: &'static str,
    },
    /// An edge was named that does not exist.
    #[error("there is no edge between vertices {0} and {1}")]
    NoEdge(u32, u32),
    /// Strips have no STEP entity.
    #[error(
        "STEP has no entity for the {strips} strips along open edges; keep all edges between clusters sharp (--all-sharp)"
    )]
    NoStep {
        /// How many.
        strips: usize,
    },
    /// Patches overlap within a face.
    #[error(
        "the blends of face {face} overlap near {at}, however short; use clusters with less reach there, or keep an edge sharp"
    )]
    Crowded {
        /// Which planar face.
        face: usize,
        /// Where.
        at: DVec3,
    },
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] mesh_core::Cancelled),
}

impl Error {
    /// Where it happened, in model units.
    pub fn place(&self) -> Option<DVec3> {
        match self {
            Self::NotManifold(_, at) => *at,
            Self::Open(at)
            | Self::NotPlanar { at, .. }
            | Self::Pinched { at, .. }
            | Self::NoCluster { at, .. }
            | Self::TwoClusters { at, .. }
            | Self::Conflict { at, .. }
            | Self::Crowded { at, .. } => Some(*at),
            _ => None,
        }
    }
}
