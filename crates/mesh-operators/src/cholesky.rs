//! Sparse Cholesky factors with a fixed degree of parallelism.

use crate::error::NotPositiveDefinite;
use crate::sparse::LowerTriangle;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::ComplexField;
use faer::{Conj, MatMut, Par, Side};
use glam::DVec3;
use num_complex::Complex64;

/// One setting whatever the machine, since faer's bits depend on it. Most of these systems are solved within milliseconds by
/// plain columns, which have no work to share.
const PAR: Par = Par::Seq;

// Compiled here, once for real and once for complex numbers. Left generic, the solver would be compiled again, at length, by every crate
// that calls a function of this one for a mesh of its own.

/// L·Lᵀ of a sparse symmetric positive definite matrix, prepared once for many right-hand sides.
///
/// Of the system of a mesh with n vertices, time and memory are about O(n^1.5) and O(n log n); a solution takes the memory's time. The
/// same bits for any number of threads.
#[derive(Debug)]
pub struct Cholesky(Factor<f64>);

impl Cholesky {
    /// Factorises.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] names the unknown.
    #[inline(never)]
    pub fn new(matrix: &LowerTriangle<f64>) -> Result<Self, NotPositiveDefinite> {
        Factor::new(matrix, None).map(Self)
    }

    /// Factorises a matrix with entries at the same places as the one before, whose elimination order is used again.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] names the unknown; the last one where the matrix has another size.
    #[inline(never)]
    pub fn refactor(self, matrix: &LowerTriangle<f64>) -> Result<Self, NotPositiveDefinite> {
        Factor::new(matrix, Some(self.0)).map(Self)
    }

    /// How many unknowns there are.
    pub fn len(&self) -> usize {
        self.0.symbolic.nrows()
    }

    /// Whether there is no unknown.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Solves in place for the right-hand sides that `x` holds one after the other. What is beyond a multiple of [`Cholesky::len`] is left
    /// as it is.
    #[inline(never)]
    pub fn solve(&self, x: &mut [f64]) {
        self.0.solve(x);
    }

    /// Solves for points, one for each unknown; missing ones count as zero.
    pub fn solve_points(&self, right: &[DVec3]) -> Vec<DVec3> {
        let n = self.len();
        let mut x = vec![0.0; 3 * n];
        for (i, r) in right.iter().take(n).enumerate() {
            [x[i], x[n + i], x[2 * n + i]] = r.to_array();
        }
        self.solve(&mut x);
        (0..n).map(|i| DVec3::new(x[i], x[n + i], x[2 * n + i])).collect()
    }
}

/// L·Lᴴ of a sparse Hermitian positive definite matrix; see [`Cholesky`].
#[derive(Debug)]
pub struct HermitianCholesky(Factor<Complex64>);

impl HermitianCholesky {
    /// Factorises.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] names the unknown.
    #[inline(never)]
    pub fn new(matrix: &LowerTriangle<Complex64>) -> Result<Self, NotPositiveDefinite> {
        Factor::new(matrix, None).map(Self)
    }

    /// As [`Cholesky::solve`].
    #[inline(never)]
    pub fn solve(&self, x: &mut [Complex64]) {
        self.0.solve(x);
    }
}

#[derive(Debug)]
struct Factor<T> {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<T>,
}

impl<T: ComplexField + Copy> Factor<T> {
    fn new(matrix: &LowerTriangle<T>, like: Option<Self>) -> Result<Self, NotPositiveDefinite> {
        let (starts, rows, entries) = matrix.checked()?;
        let n = matrix.len();
        let last = NotPositiveDefinite { unknown: n.saturating_sub(1) };
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, starts, None, rows);
        let symbolic = match like {
            Some(old) if old.symbolic.nrows() != n => return Err(last),
            Some(old) => old.symbolic,
            None => factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, faer::prelude::default())
                .map_err(|_| last)?,
        };
        let mut values = vec![T::zero_impl(); symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<T>(PAR, faer::prelude::default());
        let mut memory = MemBuffer::try_new(need).map_err(|_| last)?;
        let factored = symbolic.factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, entries),
            Side::Lower,
            faer::prelude::default(),
            PAR,
            MemStack::new(&mut memory),
            faer::prelude::default(),
        );
        match factored.map(|_| ()) {
            Ok(()) => Ok(Self { symbolic, values }),
            Err(LltError::NonPositivePivot { index }) => {
                let order = symbolic.perm().map(|p| p.arrays().0);
                let unknown = order.and_then(|o| o.get(index)).map_or(index, |&i| i as usize);
                Err(NotPositiveDefinite { unknown: unknown.min(last.unknown) })
            }
        }
    }

    fn solve(&self, x: &mut [T]) {
        let n = self.symbolic.nrows();
        let columns = x.len().checked_div(n).unwrap_or(0);
        if columns == 0 {
            return;
        }
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<T>(columns, PAR));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x[..n * columns], n, columns),
            PAR,
            MemStack::new(&mut memory),
        );
    }
}
