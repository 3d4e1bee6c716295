//! Points on a mesh by combinatorial address.

use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::traits::{Faces, Positions};
use glam::DVec3;

/// A point on a mesh: at a vertex, within an edge, or within a face. The variant is exact, the numbers are rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfacePoint {
    /// At a vertex.
    Vertex(VertexId),
    /// Strictly within an edge, at `tail + t·(head − tail)`, 0 < t < 1. Either halfedge of the edge may name it.
    Edge {
        /// One of the edge's halfedges; `t` counts from its tail.
        halfedge: HalfedgeId,
        /// Parameter in (0, 1).
        t: f64,
    },
    /// Strictly within a face.
    Face {
        /// The face.
        face: FaceId,
        /// Barycentric coordinates, all positive, summing to 1.
        barycentric: [f64; 3],
    },
}

impl SurfacePoint {
    /// The place in space.
    pub fn position<M: Faces + Positions>(&self, mesh: &M) -> DVec3 {
        match *self {
            Self::Vertex(v) => mesh.position(v),
            Self::Edge { halfedge, t } => {
                let [a, b] = mesh.ends(halfedge);
                a + t * (b - a)
            }
            Self::Face { face, barycentric: [u, v, w] } => {
                let [a, b, c] = mesh.triangle(face);
                u * a + v * b + w * c
            }
        }
    }
}
