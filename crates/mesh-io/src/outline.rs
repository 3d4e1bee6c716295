//! The faces as a writer emits them: the model's polygons where they still describe the mesh, else its triangles.

use crate::model::Model;
use mesh_core::VertexId;

/// Polygons as lists of triangle corners (`3·face + k`), which name both the vertex and its attributes.
pub(crate) struct Outline {
    /// Where each polygon starts in `corners`, and the end; `None` for plain triangles.
    starts: Option<Vec<u32>>,
    corners: Vec<u32>,
    triangles: usize,
}

impl Outline {
    pub fn of(model: &Model) -> Self {
        let Some(polygons) = model.polygons.as_ref().filter(|p| p.fit(&model.mesh)) else {
            return Self::triangles(model);
        };
        let (mut starts, mut corners) = (vec![0u32], Vec::with_capacity(polygons.corners.len()));
        let mut by_vertex: Vec<(VertexId, u32)> = vec![];
        let mut face = 0;
        for group in polygons.of_face.as_slice().chunk_by(|a, b| a == b) {
            let inside = 3 * face as u32..3 * (face + group.len()) as u32;
            face += group.len();
            by_vertex.clear();
            by_vertex.extend(inside.clone().map(|c| (model.mesh.faces[c as usize / 3][c as usize % 3], c)));
            by_vertex.sort_unstable();
            let find = |v: &VertexId| {
                let at = by_vertex.partition_point(|(w, _)| w < v);
                by_vertex.get(at).filter(|(w, _)| w == v).map(|&(_, c)| c)
            };
            let from = corners.len();
            let outline: Option<Vec<u32>> = polygons.corners(group[0] as usize).iter().map(find).collect();
            // A polygon with a spike has corners in no triangle; it goes out as its triangles.
            if let Some(outline) = outline.filter(|o| o.len() >= 3) {
                corners.extend(outline);
                starts.push(corners.len() as u32);
            } else {
                corners.extend(inside);
                starts.extend((from + 3..=corners.len()).step_by(3).map(|end| end as u32));
            }
        }
        Self { starts: Some(starts), corners, triangles: model.mesh.faces.len() }
    }

    /// The triangles, whatever polygons they were cut from.
    pub fn triangles(model: &Model) -> Self {
        Self { starts: None, corners: vec![], triangles: model.mesh.faces.len() }
    }

    /// Whether all polygons have the same number of corners.
    pub fn is_uniform(&self) -> bool {
        self.starts.as_ref().is_none_or(|s| s.windows(3).all(|w| w[1] - w[0] == w[2] - w[1]))
    }

    /// How many polygons.
    pub fn len(&self) -> usize {
        self.starts.as_ref().map_or(self.triangles, |s| s.len() - 1)
    }

    /// The corners of one polygon, in order; the first names its face.
    pub fn corners(&self, polygon: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        let range = match &self.starts {
            None => 3 * polygon..3 * polygon + 3,
            Some(starts) => starts[polygon] as usize..starts[polygon + 1] as usize,
        };
        range.map(|i| if self.starts.is_none() { i } else { self.corners[i] as usize })
    }

    /// The most corners a polygon has.
    pub fn largest(&self) -> usize {
        self.starts.as_ref().map_or(3, |s| s.windows(2).map(|w| (w[1] - w[0]) as usize).max().unwrap_or(3))
    }
}
