//! Finds the faces of two meshes that can meet at all, before any tree is built: both mark the cells of one coarse grid
//! over their common box, and only faces in cells marked by the other remain.

use mesh_core::{Bounds, FaceId, TriMesh};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// Below this many faces in both meshes together a grid costs more than it saves.
const FEW: usize = 4000;
/// Cells along the longest side of the grid, at most.
const FINEST: f64 = 128.0;
const CHUNK: usize = 1 << 13;

/// Candidate pairs of two meshes, and the faces among which they were sought.
pub(crate) struct Near {
    pub pairs: Vec<[FaceId; 2]>,
    pub faces: [Vec<FaceId>; 2],
}

/// Pairs of faces whose boxes overlap, in order. `bounds` are the boxes of the meshes.
pub(crate) fn near(a: &TriMesh, b: &TriMesh, bounds: [Bounds; 2]) -> Near {
    let common = Bounds { min: bounds[0].min.max(bounds[1].min), max: bounds[0].max.min(bounds[1].max) };
    if common.is_empty() {
        return Near { pairs: vec![], faces: [vec![], vec![]] };
    }
    let cells = if a.faces.len() + b.faces.len() < FEW {
        1.0
    } else {
        (a.faces.len().min(b.faces.len()) as f64).sqrt().clamp(16.0, FINEST)
    };
    let grid = Grid::new(&common, cells);
    let (in_a, in_b) = rayon::join(|| grid.boxes(a), || grid.boxes(b));
    let (marks_a, marks_b) = rayon::join(|| grid.mark(&in_a), || grid.mark(&in_b));
    let (fa, fb) = rayon::join(|| grid.among(&in_a, &marks_b), || grid.among(&in_b, &marks_a));
    let (ta, tb) = rayon::join(|| TriBvh::build_subset(a, &fa), || TriBvh::build_subset(b, &fb));
    let pairs = match (ta, tb) {
        (Ok(ta), Ok(tb)) => ta.overlapping_pairs(a, &tb, b),
        _ => vec![],
    };
    Near { pairs, faces: [fa, fb] }
}

/// A range of cells, and the face that spans it.
type Span = ([u8; 3], [u8; 3], FaceId);

/// A grid over a box. Cells are found by a monotone function of each coordinate, so boxes that share a point of the
/// grid share a cell, whatever the rounding.
struct Grid {
    bounds: Bounds,
    scale: glam::DVec3,
    counts: [usize; 3],
}

impl Grid {
    fn new(bounds: &Bounds, cells: f64) -> Self {
        let extent = bounds.max - bounds.min;
        let size = extent.max_element() / cells;
        let count = |x: f64| if size > 0.0 { (x / size).ceil().clamp(1.0, cells) } else { 1.0 };
        let counts = extent.to_array().map(count);
        let scale = |i: usize| if extent[i] > 0.0 { counts[i] / extent[i] } else { 0.0 };
        Self {
            bounds: *bounds,
            scale: glam::DVec3::new(scale(0), scale(1), scale(2)),
            counts: counts.map(|c| c as usize),
        }
    }

    fn cell(&self, p: glam::DVec3) -> [u8; 3] {
        let q = (p - self.bounds.min) * self.scale;
        [0, 1, 2].map(|i| q[i].clamp(0.0, self.counts[i] as f64 - 1.0) as u8)
    }

    /// The faces that reach into the grid.
    fn boxes(&self, mesh: &TriMesh) -> Vec<Span> {
        let span = |(f, c): (usize, &[mesh_core::VertexId; 3])| {
            let [p, q, r] = c.map(|v| mesh.positions[v.index()]);
            let b = Bounds { min: p.min(q).min(r), max: p.max(q).max(r) };
            b.overlaps(&self.bounds).then(|| (self.cell(b.min), self.cell(b.max), FaceId::from(f)))
        };
        let chunk = |(i, faces): (usize, &[[mesh_core::VertexId; 3]])| {
            faces.iter().enumerate().filter_map(|(j, c)| span((i * CHUNK + j, c))).collect::<Vec<_>>()
        };
        let chunks: Vec<Vec<Span>> = mesh.faces.par_chunks(CHUNK).enumerate().map(chunk).collect();
        chunks.concat()
    }

    /// The rows of cells in a span, as index ranges.
    fn rows(&self, (low, high, _): &Span) -> impl Iterator<Item = std::ops::RangeInclusive<usize>> {
        let [nx, ny, _] = self.counts;
        let [x0, y0, z0] = low.map(usize::from);
        let [x1, y1, z1] = high.map(usize::from);
        (z0..=z1).flat_map(move |z| (y0..=y1).map(move |y| ((z * ny + y) * nx + x0)..=((z * ny + y) * nx + x1)))
    }

    fn mark(&self, spans: &[Span]) -> Vec<bool> {
        let mut marks = vec![false; self.counts.iter().product()];
        for span in spans {
            self.rows(span).for_each(|row| marks[row].fill(true));
        }
        marks
    }

    fn among(&self, spans: &[Span], marks: &[bool]) -> Vec<FaceId> {
        spans.iter().filter(|s| self.rows(s).any(|row| marks[row].contains(&true))).map(|s| s.2).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::shapes;

    #[test]
    fn finds_what_whole_trees_find() {
        let a = shapes::icosphere(1.0, 4);
        for by in [DVec3::new(0.7, 0.3, 0.2), DVec3::new(1.9, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.01)] {
            let mut b = shapes::icosphere(0.9, 4);
            b.positions.iter_mut().for_each(|p| *p += by);
            let near = near(&a, &b, [&a, &b].map(|m| Bounds::of(m.positions.iter().copied())));
            let (ta, tb) = (TriBvh::build(&a).unwrap(), TriBvh::build(&b).unwrap());
            assert_eq!(near.pairs, ta.overlapping_pairs(&a, &tb, &b));
        }
    }
}
