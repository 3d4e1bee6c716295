//! Factors of sparse symmetric systems, for other crates: whoever uses faer's solver compiles it, at length, once more.

use crate::cholesky::{Cholesky, Lower};

/// A sparse symmetric positive definite matrix, factorised once for many right-hand sides. The same bits for any thread count.
///
/// ```
/// use param_conformal::SparseFactor;
/// // The lower triangle of [4 1; 1 2], by columns.
/// let factor = SparseFactor::new(vec![0, 2, 3], vec![0, 1, 1], vec![4.0, 1.0, 2.0]).unwrap();
/// let mut x = [5.0, 3.0];
/// factor.solve(&mut x, 1);
/// assert!((x[0] - 1.0).abs() + (x[1] - 1.0).abs() < 1e-14);
/// ```
#[derive(Debug)]
pub struct SparseFactor {
    factor: Cholesky<f64>,
    size: usize,
}

impl SparseFactor {
    /// Factorises the matrix whose lower triangle has, in column j, the entries `starts[j]..starts[j + 1]` of `rows` and `values`, rows
    /// ascending. Time as [`crate::Harmonic::new`] for meshes.
    ///
    /// # Errors
    /// The unknown whose pivot is not positive; 0 where the arrays are no such matrix.
    pub fn new(starts: Vec<u32>, rows: Vec<u32>, values: Vec<f64>) -> Result<Self, usize> {
        let size = starts.len().saturating_sub(1);
        let total = starts.last().map_or(usize::MAX, |&n| n as usize);
        let in_order = |w: &[u32]| {
            w[0] <= w[1]
                && rows.get(w[0] as usize..w[1] as usize).is_some_and(|column| column.is_sorted_by(|a, b| a < b))
        };
        let inside = rows.iter().all(|&r| (r as usize) < size);
        if starts.first() != Some(&0) || rows.len() != total || values.len() != total || !inside {
            return Err(0);
        }
        if !starts.windows(2).all(in_order) {
            return Err(0);
        }
        let factor = Cholesky::real(&Lower { starts, rows, values })?;
        Ok(Self { factor, size })
    }

    /// Solves for `columns` right-hand sides, one after the other in `x`, in place. Does nothing where `x` is of another length.
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        if x.len() == self.size * columns {
            self.factor.solve_real(x, columns);
        }
    }
}
