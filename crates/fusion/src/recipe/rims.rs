//! Openings by the names of the parts they came with.
//!
//! Loops are numbered once, when each part is cut and posed. A part may be joined several times, and its other loops get other numbers
//! by that; so a loop is remembered by the origin of one of its vertices, which every join keeps.

use mesh_core::{Connected, Faces, Origins, TriMesh, VertexId, VertexOrigin, boundary_loops};

/// The part and, where given, the number of a loop written as `part:0` or `part`.
pub(super) fn split_loop(text: &str) -> Option<(&str, Option<usize>)> {
    match text.rsplit_once(':') {
        None => Some((text, None)),
        Some((part, number)) => Some((part, Some(number.parse().ok()?))),
    }
}

/// The loops that one part had, each by the origin of a vertex.
pub(super) struct Rims {
    pub(super) part: String,
    pub(super) marks: Vec<VertexOrigin>,
}

impl Rims {
    /// Remembers the loops of a part. A mesh that is no manifold has none.
    pub(super) fn of(part: &str, mesh: &TriMesh, origins: &Origins) -> Self {
        let marks = loops(mesh).iter().map(|l| origins.vertices[l[0]]).collect();
        Self { part: part.to_string(), marks }
    }
}

/// The loop of a mesh that passes a vertex of this origin.
pub(super) fn find(mesh: &TriMesh, origins: &Origins, mark: &VertexOrigin) -> Option<usize> {
    loops(mesh).iter().position(|l| l.iter().any(|&v| origins.vertices[v] == *mark))
}

fn loops(mesh: &TriMesh) -> Vec<Vec<VertexId>> {
    let Ok(mesh) = Connected::new(mesh) else { return vec![] };
    boundary_loops(&mesh).iter().map(|l| l.iter().map(|&h| mesh.tail(h)).collect()).collect()
}
