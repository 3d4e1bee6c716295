//! The cotangent Laplacian row by row, and symmetric systems in the positions of free vertices.

use super::cholesky::{Cholesky, Lower};
use glam::DVec3;
use mesh_core::{Adjacency, Positions, VertexId, cotangent_weight, cotangents, mixed_areas};
use rayon::prelude::*;

/// Corners of triangles thinner than this cotangent count for less. Scaling all three of a triangle keeps its energy
/// from becoming negative, which cutting them off one by one would not.
const THINNEST: f64 = 1e4;
/// No vertex counts for less than this share of the mean area around a vertex.
const LEAST_AREA: f64 = 1e-4;
/// Rows per parallel task.
const CHUNK: usize = 512;

/// Cotangent weights and areas of the inner vertices. Rows of boundary vertices are empty.
pub(super) struct Laplacian {
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
    /// Area around each vertex; 0 on the boundary.
    pub areas: Vec<f64>,
}

impl Laplacian {
    pub fn new<M: Adjacency + Positions + Sync>(mesh: &M) -> Self {
        let mut corner = cotangents(mesh);
        corner.as_mut_slice().par_chunks_mut(3).for_each(|c| {
            let worst = c.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            if worst > THINNEST {
                for x in c {
                    *x *= THINNEST / worst;
                }
            }
        });
        let ids = 0..mesh.vertex_count() as u32;
        let inner = |v: u32| mesh.outgoing(VertexId(v)).is_some_and(|h| mesh.twin(h).is_some());
        let mut areas = mixed_areas(mesh).into_vec();
        areas.iter_mut().zip(ids.clone()).filter(|a| !inner(a.1)).for_each(|(a, _)| *a = 0.0);
        let inside = areas.iter().filter(|a| **a > 0.0).count().max(1);
        let least = LEAST_AREA * areas.iter().sum::<f64>() / inside as f64;
        areas.iter_mut().zip(ids.clone()).filter(|a| inner(a.1)).for_each(|(a, _)| *a = a.max(least));
        let degree = |v: u32| if inner(v) { mesh.ring(VertexId(v)).count() as u32 } else { 0 };
        let mut starts = vec![0];
        starts.extend(ids.clone().map(degree).scan(0, |at, n| {
            *at += n;
            Some(*at)
        }));
        let rows: Vec<(Vec<u32>, Vec<f64>)> = ids
            .collect::<Vec<_>>()
            .par_chunks(CHUNK)
            .map(|chunk| {
                let ring = |&v: &u32| mesh.ring(VertexId(v)).filter(move |_| inner(v));
                chunk.iter().flat_map(ring).map(|h| (mesh.head(h).0, cotangent_weight(mesh, &corner, h))).unzip()
            })
            .collect();
        let mut all = Self { starts, neighbours: vec![], weights: vec![], areas };
        for (neighbours, weights) in rows {
            all.neighbours.extend(neighbours);
            all.weights.extend(weights);
        }
        all
    }

    /// Adds `factor` times row `v` of the positive semidefinite Laplacian: Σ w (x_v − x_n).
    pub fn add_row(&self, v: u32, factor: f64, row: &mut Vec<(u32, f64)>) {
        let range = self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize;
        let own = row.len();
        row.push((v, 0.0));
        let mut sum = 0.0;
        for (&n, &w) in self.neighbours[range.clone()].iter().zip(&self.weights[range]) {
            row.push((n, -factor * w));
            sum += w;
        }
        row[own].1 = factor * sum;
    }
}

/// One entry for each vertex, in order.
pub(super) fn add_up(row: &mut Vec<(u32, f64)>) {
    // Stable, so that sums have one order.
    row.sort_by_key(|e| e.0);
    row.dedup_by(|next, sum| {
        let same = next.0 == sum.0;
        sum.1 += if same { next.1 } else { 0.0 };
        same
    });
}

/// Rows of a symmetric operator over all vertices, those of some vertices only.
pub(super) struct Rows<'a> {
    free: &'a [u32],
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// Row by row, as pairs of a vertex and a value in any order, to be added up.
    pub fn gather(free: &'a [u32], row: impl Fn(u32, &mut Vec<(u32, f64)>) + Sync) -> Self {
        let pieces: Vec<(Vec<u32>, Vec<u32>, Vec<f64>)> = free
            .par_chunks(CHUNK)
            .map(|chunk| {
                let (mut counts, mut columns, mut values, mut one) = (vec![], vec![], vec![], vec![]);
                for &v in chunk {
                    one.clear();
                    row(v, &mut one);
                    add_up(&mut one);
                    counts.push(one.len() as u32);
                    columns.extend(one.iter().map(|e| e.0));
                    values.extend(one.iter().map(|e| e.1));
                }
                (counts, columns, values)
            })
            .collect();
        let mut rows = Self { free, starts: vec![0], columns: vec![], values: vec![] };
        for (counts, columns, values) in pieces {
            for n in counts {
                rows.starts.push(rows.starts[rows.starts.len() - 1] + n);
            }
            rows.columns.extend(columns);
            rows.values.extend(values);
        }
        rows
    }

    fn row(&self, i: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }

    /// `right` minus the operator at `points`, at each free vertex.
    fn residual(&self, points: &[DVec3], right: &[DVec3]) -> Vec<DVec3> {
        let at = |i: usize| self.row(i).fold(right[i], |r, (c, x)| r - x * points[c as usize]);
        (0..self.free.len()).into_par_iter().with_min_len(CHUNK).map(at).collect()
    }

    /// Moves the free vertices so that the operator gives `right` there, the others staying, and returns the factor. Of the
    /// `steps`, those after the first mend what rounding left.
    ///
    /// # Errors
    /// A free vertex at which the operator is not positive definite.
    pub fn solve(
        &self,
        points: &mut [DVec3],
        right: &[DVec3],
        steps: usize,
        like: Option<Cholesky>,
    ) -> Result<Cholesky, u32> {
        let mut index = vec![u32::MAX; points.len()];
        for (i, &v) in self.free.iter().enumerate() {
            index[v as usize] = i as u32;
        }
        let mut lower = Lower { starts: vec![0], ..Lower::default() };
        for i in 0..self.free.len() {
            // Free vertices ascend, so columns ascend among them too.
            for (c, x) in self.row(i).map(|(c, x)| (index[c as usize], x)) {
                if c != u32::MAX && c as usize >= i {
                    lower.rows.push(c);
                    lower.values.push(x);
                }
            }
            lower.starts.push(lower.rows.len() as u32);
        }
        let factor = Cholesky::new(&lower, like).map_err(|i| self.free[i.min(self.free.len() - 1)])?;
        let n = self.free.len();
        let mut x = vec![0.0; 3 * n];
        for _ in 0..steps {
            for (i, r) in self.residual(points, right).iter().enumerate() {
                [x[i], x[n + i], x[2 * n + i]] = r.to_array();
            }
            factor.solve(&mut x, 3);
            for (i, &v) in self.free.iter().enumerate() {
                points[v as usize] += DVec3::new(x[i], x[n + i], x[2 * n + i]);
            }
        }
        Ok(factor)
    }
}
