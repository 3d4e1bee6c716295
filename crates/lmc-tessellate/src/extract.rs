//! Triangles from the cells of a zero set, with vertices on it.

use crate::cell::{axis, low_corner, signs};
use crate::grid::{Field, Grid, Surface};
use crate::tile::tiling;
use glam::DVec3;
use mesh_core::{TriMesh, VertexId};

/// Vertices keep this share of a grid edge off its ends, so that no triangle is degenerate.
const MARGIN: f64 = 1e-3;

/// The zero set as a mesh, positive side outward. `steps` rounds of root finding place the vertices on the true field;
/// without any they are where linear interpolation puts them.
pub(crate) fn extract(field: &impl Field, grid: &Grid, surface: &Surface, steps: u32) -> TriMesh {
    const NONE: u32 = u32::MAX;
    let mut mesh = TriMesh::default();
    let mut on_edge = vec![[NONE; 3]; surface.nodes.len()];
    // The field at both ends of every crossed grid edge.
    let mut brackets: Vec<Bracket> = vec![];
    let mut inner: Vec<(Vec<u32>, Option<u32>)> = vec![];
    for nodes in &surface.cells {
        let values = nodes.map(|n| surface.values[n as usize]);
        let mask = signs(&values);
        let mut local = [NONE; 12];
        for (e, vertex) in local.iter_mut().enumerate() {
            let (low, a) = (low_corner(e), axis(e));
            if (mask >> low ^ mask >> (low | 1 << a)) & 1 == 0 {
                continue;
            }
            let slot = &mut on_edge[nodes[low] as usize][a];
            if *slot == NONE {
                *slot = brackets.len() as u32;
                brackets.push(Bracket::new(
                    grid.node(surface.nodes[nodes[low] as usize]),
                    a,
                    [values[low], values[low | 1 << a]],
                ));
            }
            *vertex = *slot;
        }
        let made = tiling(&values);
        let first = inner.len() as u32;
        for p in &made.inner {
            inner.push((p.all.iter().map(|&e| local[e as usize]).collect(), p.near.map(|e| local[e as usize])));
        }
        // Inner points are numbered after all others, below.
        let id =
            |v: u8| if v < 12 { VertexId(local[v as usize]) } else { VertexId(NONE - 1 - first - u32::from(v - 12)) };
        mesh.faces.extend(made.triangles.iter().map(|t| t.map(id)));
    }
    place(field, grid.size, &mut brackets, steps);
    mesh.positions = brackets.iter().map(|b| b.point(grid.size)).collect();
    let edge_points = mesh.positions.len() as u32;
    for (all, near) in &inner {
        let mean = all.iter().map(|&v| mesh.positions[v as usize]).sum::<DVec3>() / all.len() as f64;
        mesh.positions.push(near.map_or(mean, |v| 0.5 * (mean + mesh.positions[v as usize])));
    }
    if !inner.is_empty() {
        for v in mesh.faces.as_flattened_mut().iter_mut().filter(|v| v.0 >= edge_points) {
            *v = VertexId(edge_points + (NONE - 1 - v.0));
        }
    }
    mesh
}

/// A root between the ends of a grid edge.
struct Bracket {
    low: DVec3,
    axis: usize,
    /// The parameters between which the sign changes, and the field there.
    ends: [f64; 2],
    values: [f64; 2],
    /// The end moved last, whose opposite is weighed down (\[DowellJarratt1971\]).
    moved: usize,
    t: f64,
}

impl Bracket {
    fn new(low: DVec3, axis: usize, values: [f64; 2]) -> Self {
        let mut root = Self { low, axis, ends: [0.0, 1.0], values, moved: 2, t: 0.5 };
        root.aim();
        root
    }
    fn aim(&mut self) {
        let [u, v] = self.values;
        let share = u / (u - v);
        let share = if share.is_finite() { share } else { 0.5 };
        self.t = (self.ends[0] + share * (self.ends[1] - self.ends[0])).clamp(MARGIN, 1.0 - MARGIN);
    }
    fn point(&self, size: f64) -> DVec3 {
        let mut p = self.low;
        p[self.axis] += self.t * size;
        p
    }
    fn narrow(&mut self, value: f64) {
        if value == 0.0 || value.is_nan() {
            return;
        }
        let end = usize::from((value < 0.0) != (self.values[0] < 0.0));
        if self.moved == end {
            self.values[1 - end] *= 0.5;
        }
        (self.ends[end], self.values[end], self.moved) = (self.t, value, end);
        self.aim();
    }
}

fn place(field: &impl Field, size: f64, brackets: &mut [Bracket], steps: u32) {
    let mut values = vec![0.0; brackets.len()];
    for _ in 0..steps {
        let points: Vec<DVec3> = brackets.iter().map(|b| b.point(size)).collect();
        field.values(&points, &mut values);
        for (b, &v) in brackets.iter_mut().zip(&values) {
            b.narrow(v);
        }
    }
}
