//! Provenance: where every vertex and face of a result came from, composable across stages.

use crate::ids::{FaceId, VertexId};
use crate::map::{FaceMap, VertexMap};

/// Where a vertex came from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VertexOrigin {
    /// The same point as a vertex of input `part`, bit for bit.
    Input {
        /// Which input, counting from 0.
        part: u32,
        /// The vertex there.
        vertex: VertexId,
    },
    /// A point on an edge of input `part`: `a + t·(b − a)`.
    Edge {
        /// Which input, counting from 0.
        part: u32,
        /// The edge's end points.
        ends: [VertexId; 2],
        /// Parameter in [0, 1] from the first end.
        t: f64,
    },
    /// A point inside a face of input `part`.
    Face {
        /// Which input, counting from 0.
        part: u32,
        /// The face there.
        face: FaceId,
        /// Barycentric coordinates in that face, summing to 1.
        barycentric: [f64; 3],
    },
    /// Made by a stage, on no input.
    New {
        /// The stage that made it, such as `"blend"`.
        stage: &'static str,
    },
}

impl VertexOrigin {
    /// Barycentric coordinates in the face with these corners, for a vertex on that face; `None` for one on no input.
    pub fn barycentric(&self, corners: [VertexId; 3]) -> Option<[f64; 3]> {
        let at = |v: VertexId, w: f64| corners.map(|c| if c == v { w } else { 0.0 });
        match *self {
            Self::Input { vertex, .. } => Some(at(vertex, 1.0)),
            Self::Edge { ends, t, .. } => {
                let (a, b) = (at(ends[0], 1.0 - t), at(ends[1], t));
                Some([0, 1, 2].map(|k| a[k] + b[k]))
            }
            Self::Face { barycentric, .. } => Some(barycentric),
            Self::New { .. } => None,
        }
    }
}

/// Where a face came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceOrigin {
    /// The whole of a face of input `part`, same corners.
    Input {
        /// Which input, counting from 0.
        part: u32,
        /// The face there.
        face: FaceId,
    },
    /// A piece of a face of input `part`.
    Piece {
        /// Which input, counting from 0.
        part: u32,
        /// The face there.
        face: FaceId,
    },
    /// Made by a stage.
    New {
        /// The stage that made it, such as `"blend"`.
        stage: &'static str,
    },
}

/// The origins of all vertices and faces of one mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origins {
    /// One per vertex.
    pub vertices: VertexMap<VertexOrigin>,
    /// One per face.
    pub faces: FaceMap<FaceOrigin>,
}

impl Origins {
    /// Every vertex and face is that of input `part`.
    pub fn identity(part: u32, vertex_count: usize, face_count: usize) -> Self {
        Self {
            vertices: (0..vertex_count as u32)
                .map(|v| VertexOrigin::Input { part, vertex: VertexId(v) })
                .collect::<Vec<_>>()
                .into(),
            faces: (0..face_count as u32)
                .map(|f| FaceOrigin::Input { part, face: FaceId(f) })
                .collect::<Vec<_>>()
                .into(),
        }
    }
}
