//! Laplacians row by row.

use crate::cotangent::{cotangent_weight, cotangents};
use crate::mean_value::corner_weights;
use mesh_core::{Adjacency, HalfedgeId, Positions, VertexId};
use rayon::prelude::*;
use std::ops::{Add, Mul, Sub};

/// Rows per parallel task.
const CHUNK: usize = 512;

/// Some rows: where each ends among the entries, and the entries.
type Piece = (Vec<u32>, Vec<(u32, f64)>);

/// Edge weights w of the operator (L x)_i = Σ w_ij (x_i − x_j) over all vertices, zero on constants.
///
/// Rows hold the neighbours counter-clockwise, on the boundary the neighbour along the last edge at the end; vertices without faces
/// have empty ones. The same bits for any number of threads.
#[derive(Clone, Debug, PartialEq)]
pub struct Laplacian {
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
    diagonal: Vec<f64>,
}

impl Laplacian {
    /// The cotangent Laplacian: symmetric, positive semidefinite, and exact on linear functions in the plane (\[PinkallPolthier1993\]).
    /// Integrated over each vertex's area; divide by [`crate::vertex_areas`] for values per square unit. Weights have no unit. O(n), parallel.
    pub fn cotangent<M: Adjacency + Positions + Sync>(mesh: &M) -> Self {
        let corner = cotangents(mesh);
        Self::gather(mesh, |v, row| {
            for h in mesh.ring(v) {
                row.push((mesh.head(h).0, cotangent_weight(mesh, &corner, h)));
                if mesh.twin(h.prev()).is_none() {
                    row.push((mesh.tail(h.prev()).0, cotangent_weight(mesh, &corner, h.prev())));
                }
            }
        })
    }

    /// The mean value Laplacian: positive weights, so that no value leaves the range of its neighbours', and exact on linear functions in
    /// the plane; not symmetric (\[Floater2003\]). Weights in one over model units. O(n), parallel.
    pub fn mean_value<M: Adjacency + Positions + Sync>(mesh: &M) -> Self {
        // Of the triangle that `h` leaves: towards its head, and towards the third corner.
        let weights = |h: HalfedgeId| {
            let (p, k) = (mesh.triangle(h.face()), h.corner());
            corner_weights([p[k], p[(k + 1) % 3], p[(k + 2) % 3]])
        };
        Self::gather(mesh, |v, row| {
            for h in mesh.ring(v) {
                // `h` is the second side of the triangle before it.
                let before = mesh.twin(h).map_or(0.0, |t| weights(t.next())[1]);
                row.push((mesh.head(h).0, weights(h)[0] + before));
                if mesh.twin(h.prev()).is_none() {
                    row.push((mesh.tail(h.prev()).0, weights(h)[1]));
                }
            }
        })
    }

    fn gather<M: Adjacency + Sync>(mesh: &M, row: impl Fn(VertexId, &mut Vec<(u32, f64)>) + Sync) -> Self {
        let ids: Vec<VertexId> = mesh.vertex_ids().collect();
        let pieces: Vec<Piece> = ids
            .par_chunks(CHUNK)
            .map(|chunk| {
                let (mut ends, mut entries) = (vec![], vec![]);
                for &v in chunk {
                    row(v, &mut entries);
                    ends.push(entries.len() as u32);
                }
                (ends, entries)
            })
            .collect();
        let mut all = Self { starts: vec![0], neighbours: vec![], weights: vec![], diagonal: vec![] };
        for (ends, entries) in pieces {
            let before = all.neighbours.len() as u32;
            all.starts.extend(ends.into_iter().map(|end| before + end));
            all.neighbours.extend(entries.iter().map(|e| e.0));
            all.weights.extend(entries.iter().map(|e| e.1));
        }
        all.diagonal = (0..ids.len()).map(|v| all.weights[all.range(v)].iter().sum()).collect();
        all
    }

    fn range(&self, v: usize) -> std::ops::Range<usize> {
        self.starts[v] as usize..self.starts[v + 1] as usize
    }

    /// How many vertices it has rows for.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// Whether there is no vertex.
    pub fn is_empty(&self) -> bool {
        self.diagonal.is_empty()
    }

    /// The neighbours of a vertex, by index, and the weights of the edges to them.
    ///
    /// # Panics
    /// If `v` is not below [`Laplacian::len`].
    pub fn neighbours(&self, v: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.range(v).map(|k| (self.neighbours[k] as usize, self.weights[k]))
    }

    /// A row of the matrix: its own entry first, then the neighbours' negative weights.
    ///
    /// # Panics
    /// If `v` is not below [`Laplacian::len`].
    pub fn row(&self, v: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        std::iter::once((v, self.diagonal[v])).chain(self.neighbours(v).map(|(n, w)| (n, -w)))
    }

    /// Adds `factor` times row `v` to a row in the making.
    ///
    /// # Panics
    /// If `v` is not below [`Laplacian::len`].
    pub fn add_row(&self, v: u32, factor: f64, row: &mut Vec<(u32, f64)>) {
        row.push((v, factor * self.diagonal[v as usize]));
        row.extend(self.neighbours(v as usize).map(|(n, w)| (n as u32, -factor * w)));
    }

    /// Σ w (x_v − x_n), numbers or points.
    ///
    /// # Panics
    /// If `v` or a neighbour is not an index of `x`.
    pub fn apply<T>(&self, x: &[T], v: usize) -> T
    where
        T: Copy + Default + Add<Output = T> + Sub<Output = T>,
        f64: Mul<T, Output = T>,
    {
        self.neighbours(v).fold(T::default(), |sum, (n, w)| sum + w * (x[v] - x[n]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{Connected, Faces, TriMesh, shapes};

    fn inner(mesh: &Connected<TriMesh>) -> impl Iterator<Item = VertexId> + '_ {
        mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_some_and(|h| mesh.twin(h).is_some()))
    }

    /// Linear functions in the plane have no Laplacian, whichever the weights, and constants have none anywhere.
    #[test]
    fn planes_are_harmonic() {
        let mut sheet = shapes::grid(2.0, 1.0, 9, 6);
        for (i, p) in sheet.positions.iter_mut().enumerate() {
            *p += 0.03 * glam::DVec3::new((7.0 * i as f64).sin(), (11.0 * i as f64).cos(), 0.0);
        }
        let sheet = Connected::new(sheet).unwrap();
        let points = &sheet.mesh().positions;
        for laplacian in [Laplacian::cotangent(&sheet), Laplacian::mean_value(&sheet)] {
            for v in inner(&sheet) {
                let size = laplacian.row(v.index()).next().unwrap().1;
                assert!(laplacian.apply(points, v.index()).length() < 1e-13 * size);
            }
            for v in 0..laplacian.len() {
                assert!(laplacian.row(v).map(|e| e.1).sum::<f64>().abs() < 1e-12);
            }
        }
    }

    /// x² + y² has the Laplacian 4: the flow out of each vertex is minus four times its area, on a regular grid.
    #[test]
    fn a_paraboloid_has_the_laplacian_four() {
        let plane = Connected::new(shapes::grid(2.0, 1.0, 7, 5)).unwrap();
        let squares: Vec<f64> = plane.mesh().positions.iter().map(|p| p.length_squared()).collect();
        let (laplacian, areas) = (Laplacian::cotangent(&plane), crate::vertex_areas(&plane));
        for v in inner(&plane) {
            assert!((laplacian.apply(&squares, v.index()) + 4.0 * areas[v]).abs() < 1e-12);
            assert!((areas[v] - (2.0 / 7.0) * (1.0 / 5.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn cotangent_rows_are_symmetric_and_mean_value_weights_positive() {
        let blob = Connected::new(shapes::blob(1.0, 3, 0.6, 4)).unwrap();
        let cotangent = Laplacian::cotangent(&blob);
        for v in 0..cotangent.len() {
            for (n, w) in cotangent.neighbours(v) {
                assert!(cotangent.neighbours(n).any(|(back, same)| back == v && same == w));
            }
        }
        let mean_value = Laplacian::mean_value(&blob);
        assert!((0..mean_value.len()).all(|v| mean_value.neighbours(v).all(|(_, w)| w > 0.0)));
    }
}
