//! Sparse Cholesky factors with a fixed degree of parallelism.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::traits::ComplexField;
use faer::{Conj, MatMut, Par, Side, c64};

/// One setting whatever the machine, since faer's bits depend on it. Most of these systems are solved within
/// milliseconds by plain columns, which have no work to share.
const PAR: Par = Par::Seq;

/// The lower triangle of a Hermitian matrix by columns, rows ascending within each.
pub(crate) struct Lower<T> {
    pub starts: Vec<u32>,
    pub rows: Vec<u32>,
    pub values: Vec<T>,
}

/// L·Lᴴ of a positive definite matrix.
#[derive(Debug)]
pub(crate) struct Cholesky<T> {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<T>,
}

// Compiled here, once. Left generic, the solver would be compiled anew, at length, by every crate that calls a function
// of this one for a mesh of its own.

impl Cholesky<f64> {
    /// Factorises.
    ///
    /// # Errors
    /// The unknown whose pivot is not positive, or the last one where memory or indices run out.
    #[inline(never)]
    pub fn real(matrix: &Lower<f64>) -> Result<Self, usize> {
        Self::new(matrix)
    }

    /// Solves for `columns` right-hand sides, one after the other in `x`, in place.
    #[inline(never)]
    pub fn solve_real(&self, x: &mut [f64], columns: usize) {
        self.solve(x, columns);
    }
}

impl Cholesky<c64> {
    /// Factorises.
    ///
    /// # Errors
    /// The unknown whose pivot is not positive, or the last one where memory or indices run out.
    #[inline(never)]
    pub fn complex(matrix: &Lower<c64>) -> Result<Self, usize> {
        Self::new(matrix)
    }
}

impl<T: ComplexField + Copy> Cholesky<T> {
    fn new(matrix: &Lower<T>) -> Result<Self, usize> {
        let n = matrix.starts.len() - 1;
        let last = n.saturating_sub(1);
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let symbolic =
            factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, faer::prelude::default())
                .map_err(|_| last)?;
        let mut values = vec![T::zero_impl(); symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<T>(PAR, faer::prelude::default());
        let mut memory = MemBuffer::try_new(need).map_err(|_| last)?;
        let factored = symbolic.factorize_numeric_llt(
            &mut values,
            SparseColMatRef::new(pattern, &matrix.values),
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
                Err(order.and_then(|o| o.get(index)).map_or(index, |&i| i as usize).min(last))
            }
        }
    }

    /// Solves for `columns` right-hand sides, one after the other in `x`, in place.
    pub fn solve(&self, x: &mut [T], columns: usize) {
        let n = self.symbolic.nrows();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<T>(columns, PAR));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, columns),
            PAR,
            MemStack::new(&mut memory),
        );
    }
}
