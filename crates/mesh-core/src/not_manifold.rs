//! Why a mesh is not an oriented 2-manifold.

use crate::ids::{FaceId, VertexId};
use glam::DVec3;

/// Why a mesh is not an oriented 2-manifold. Every offender is listed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "not an oriented 2-manifold: {} edges with more than two faces, {} edges whose two faces disagree in orientation, {} vertices whose faces do not form one fan, {} faces with a repeated corner, {} faces that name a missing vertex{}; `repair` mends what can be mended",
    .edges.len(), .misoriented.len(), .vertices.len(), .degenerate.len(), .out_of_range.len(), first_place(self)
)]
pub struct NotManifold {
    /// Edges with three or more faces, as vertex pairs (low, high), in order.
    pub edges: Vec<[VertexId; 2]>,
    /// Edges with two faces that run along them in the same direction, as vertex pairs (low, high), in order.
    pub misoriented: Vec<[VertexId; 2]>,
    /// Vertices whose faces form more than one fan, in order.
    pub vertices: Vec<VertexId>,
    /// Faces that use a vertex twice, in order.
    pub degenerate: Vec<FaceId>,
    /// Faces with a corner beyond the vertex count, in order.
    pub out_of_range: Vec<FaceId>,
    /// Where the first offender is, in model units.
    pub place: Option<DVec3>,
}

fn first_place(e: &NotManifold) -> String {
    e.place.map_or(String::new(), |p| format!(" (first at {}, {}, {})", p.x, p.y, p.z))
}
