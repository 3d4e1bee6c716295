//! The two meshes with exact points, and names for the points in which they meet.

use crate::error::Error;
use crate::predicate::{largest, scale_for, scaled, vanishing};
use glam::DVec3;
use mesh_core::{Connected, FaceId, Faces, HalfedgeId, TriMesh, VertexId};
use std::borrow::Cow;

/// One of the two meshes, with points on which predicates are exact.
pub(crate) struct Part<'a> {
    pub mesh: &'a Connected<TriMesh>,
    pub points: Cow<'a, [DVec3]>,
    pub(super) scale: f64,
    pub(super) largest: f64,
}

impl Part<'_> {
    pub(crate) fn triangle(&self, f: u32) -> [DVec3; 3] {
        self.mesh.corners(FaceId(f)).map(|v| self.points[v.index()])
    }

    /// Coordinates smaller than this count as zero, in model units.
    pub(crate) fn vanishing(&self) -> f64 {
        vanishing(self.scale)
    }

    pub(super) fn ends(&self, edge: u32) -> [DVec3; 2] {
        let h = HalfedgeId(edge);
        [self.points[self.mesh.tail(h).index()], self.points[self.mesh.head(h).index()]]
    }
}

/// Both meshes, checked for numbers and scaled alike.
pub(crate) fn parts<'a>(a: &'a Connected<TriMesh>, b: &'a Connected<TriMesh>) -> Result<[Part<'a>; 2], Error> {
    let sizes = [a, b].map(|m| largest(&m.mesh().positions));
    for (part, mesh) in [a, b].into_iter().enumerate() {
        if !sizes[part].is_finite() {
            let vertex = mesh.mesh().positions.iter().position(|p| !p.is_finite()).unwrap_or(0);
            return Err(Error::NotFinite { part: part as u32, vertex: VertexId::from(vertex) });
        }
    }
    let size = sizes[0].max(sizes[1]);
    Ok([a, b].map(|mesh| Part {
        mesh,
        points: scaled(&mesh.mesh().positions[..], size),
        scale: scale_for(size),
        largest: size,
    }))
}

/// The part of one mesh that carries a point, in the smallest dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Simplex {
    Vertex(u32),
    Edge(u32),
    Face(u32),
}

/// A point in which two meshes meet, named by what carries it in a and in b.
pub(crate) type Key = [Simplex; 2];
