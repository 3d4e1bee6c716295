//! Sparse matrices as they are assembled: by rows, and as lower triangles.

use crate::error::NotPositiveDefinite;
use rayon::prelude::*;

/// Rows per parallel task.
const CHUNK: usize = 512;

/// Some rows of a sparse matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseRows {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl SparseRows {
    /// Row by row, as pairs of a column and a value in any order; values of one column are added up. Parallel; the same bits for any number
    /// of threads.
    pub fn gather(rows: &[u32], row: impl Fn(u32, &mut Vec<(u32, f64)>) + Sync) -> Self {
        let pieces: Vec<(Vec<u32>, Vec<u32>, Vec<f64>)> = rows
            .par_chunks(CHUNK)
            .map(|chunk| {
                let (mut counts, mut columns, mut values, mut one) = (vec![], vec![], vec![], vec![]);
                for &r in chunk {
                    one.clear();
                    row(r, &mut one);
                    Self::add_up(&mut one);
                    counts.push(one.len() as u32);
                    columns.extend(one.iter().map(|e| e.0));
                    values.extend(one.iter().map(|e| e.1));
                }
                (counts, columns, values)
            })
            .collect();
        let mut all = Self { starts: vec![0], columns: vec![], values: vec![] };
        let mut end = 0;
        for (counts, columns, values) in pieces {
            for n in counts {
                end += n;
                all.starts.push(end);
            }
            all.columns.extend(columns);
            all.values.extend(values);
        }
        all
    }

    /// Sorts a row by columns, one entry for each.
    pub fn add_up(row: &mut Vec<(u32, f64)>) {
        // Stable, so that sums have one order.
        row.sort_by_key(|e| e.0);
        row.dedup_by(|next, sum| {
            let same = next.0 == sum.0;
            sum.1 += if same { next.1 } else { 0.0 };
            same
        });
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The columns and values of the `i`-th row gathered, ascending.
    ///
    /// # Panics
    /// If `i` is not below [`SparseRows::len`].
    pub fn row(&self, i: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().copied().zip(self.values[range].iter().copied())
    }
}

/// The lower triangle of a symmetric or Hermitian matrix, filled column by column.
///
/// ```
/// // [4 1; 1 2].
/// let mut lower = mesh_operators::LowerTriangle::default();
/// lower.column(&[(0, 4.0), (1, 1.0)]);
/// lower.column(&[(1, 2.0)]);
/// let factor = mesh_operators::Cholesky::new(&lower)?;
/// let mut x = [5.0, 3.0];
/// factor.solve(&mut x);
/// assert!((x[0] - 1.0).abs() + (x[1] - 1.0).abs() < 1e-14);
/// # Ok::<(), mesh_operators::NotPositiveDefinite>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LowerTriangle<T> {
    starts: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<T>,
}

/// Where columns start, the rows of entries and their values.
type Arrays<'a, T> = (&'a [u32], &'a [u32], &'a [T]);

impl<T> Default for LowerTriangle<T> {
    fn default() -> Self {
        Self { starts: vec![0], rows: vec![], values: vec![] }
    }
}

impl<T: Copy> LowerTriangle<T> {
    /// Adds a column: its row indices, ascending, none above the diagonal, and their values.
    pub fn column(&mut self, entries: &[(u32, T)]) {
        self.rows.extend(entries.iter().map(|e| e.0));
        self.values.extend(entries.iter().map(|e| e.1));
        self.starts.push(self.rows.len() as u32);
    }

    /// How many columns there are.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there is no column.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value on the diagonal of a column that begins with it.
    pub fn diagonal_mut(&mut self, column: usize) -> Option<&mut T> {
        let first = *self.starts.get(column)? as usize;
        if self.rows.get(first) == Some(&(column as u32)) { self.values.get_mut(first) } else { None }
    }

    /// The arrays, once they are known to be those of a lower triangle.
    pub(crate) fn checked(&self) -> Result<Arrays<'_, T>, NotPositiveDefinite> {
        let sorted = |k: usize| {
            let column = &self.rows[self.starts[k] as usize..self.starts[k + 1] as usize];
            let inside = column.iter().all(|&r| r as usize >= k && (r as usize) < self.len());
            inside && column.is_sorted_by(|a, b| a < b)
        };
        match (0..self.len()).find(|&k| !sorted(k)) {
            None => Ok((&self.starts, &self.rows, &self.values)),
            Some(unknown) => Err(NotPositiveDefinite { unknown }),
        }
    }
}
