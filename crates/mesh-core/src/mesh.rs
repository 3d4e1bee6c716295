//! `TriMesh`: positions and triangles, nothing derived.

use crate::ids::{FaceId, VertexId};
use crate::traits::{Faces, MeshSink, Positions};
use glam::DVec3;

/// Passive triangle-mesh data. Anything may be in it; [`crate::validate`] and [`crate::Connected`] judge it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// One point per vertex, in model units.
    pub positions: Vec<DVec3>,
    /// Corners of each triangle, counter-clockwise seen from outside.
    pub faces: Vec<[VertexId; 3]>,
}

impl TriMesh {
    /// A mesh from plain arrays.
    pub fn from_arrays(positions: Vec<DVec3>, faces: impl IntoIterator<Item = [u32; 3]>) -> Self {
        Self { positions, faces: faces.into_iter().map(|c| c.map(VertexId)).collect() }
    }

    /// Several meshes as one, their vertices and faces one mesh after the other.
    pub fn merged<'a>(parts: impl IntoIterator<Item = &'a Self>) -> Self {
        let mut all = Self::default();
        parts.into_iter().for_each(|part| all.append(part));
        all
    }

    /// Adds another mesh's vertices and faces after its own.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.faces.extend(other.faces.iter().map(|c| c.map(|v| VertexId(v.0 + first))));
    }

    /// The three corner points of a triangle.
    #[inline]
    pub fn triangle(&self, f: FaceId) -> [DVec3; 3] {
        self.faces[f.index()].map(|v| self.positions[v.index()])
    }
}

impl Faces for TriMesh {
    fn vertex_count(&self) -> usize {
        self.positions.len()
    }
    fn face_count(&self) -> usize {
        self.faces.len()
    }
    #[inline]
    fn corners(&self, f: FaceId) -> [VertexId; 3] {
        self.faces[f.index()]
    }
}

impl Positions for TriMesh {
    #[inline]
    fn position(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }
}

impl MeshSink for TriMesh {
    type Error = std::convert::Infallible;
    fn vertex(&mut self, p: DVec3) -> Result<VertexId, Self::Error> {
        self.positions.push(p);
        Ok(VertexId::from(self.positions.len() - 1))
    }
    fn face(&mut self, corners: [VertexId; 3]) -> Result<FaceId, Self::Error> {
        self.faces.push(corners);
        Ok(FaceId::from(self.faces.len() - 1))
    }
}
