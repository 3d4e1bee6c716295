//! Sparse systems with three right-hand sides.

use glam::DVec3;
use param_conformal::SparseFactor;

/// The lower triangle of a symmetric matrix, filled column by column.
#[derive(Default)]
pub(crate) struct Lower {
    starts: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Lower {
    /// Begins the next column.
    pub fn begin(&mut self) {
        self.starts.push(self.rows.len() as u32);
    }

    /// Adds an entry below those that the column has.
    pub fn push(&mut self, row: usize, value: f64) {
        self.rows.push(row as u32);
        self.values.push(value);
    }

    /// Factorises; `None` where the matrix is not positive definite to working precision.
    pub fn factor(mut self) -> Option<Cholesky> {
        self.begin();
        SparseFactor::new(self.starts, self.rows, self.values).ok().map(Cholesky)
    }
}

/// A factorised matrix.
pub(crate) struct Cholesky(SparseFactor);

impl Cholesky {
    /// Solves for the three coordinates at once.
    pub fn solve(&self, right: &[DVec3]) -> Vec<DVec3> {
        let n = right.len();
        let mut x: Vec<f64> = (0..3).flat_map(|c| right.iter().map(move |v| v[c])).collect();
        self.0.solve(&mut x, 3);
        (0..n).map(|i| DVec3::new(x[i], x[n + i], x[2 * n + i])).collect()
    }
}
