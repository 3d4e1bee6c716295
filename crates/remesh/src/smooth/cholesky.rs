//! Sparse Cholesky factors of real matrices, compiled here once: nothing of it is generic.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// One setting whatever the machine, since faer's bits depend on it.
const PAR: Par = Par::Seq;

/// The lower triangle of a symmetric matrix by columns, rows ascending within each.
#[derive(Default)]
pub(super) struct Lower {
    pub starts: Vec<u32>,
    pub rows: Vec<u32>,
    pub values: Vec<f64>,
}

/// L·Lᵀ of a positive definite matrix.
pub(super) struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
}

impl Cholesky {
    /// Factorises, with the elimination order of `like` where that is a factor of the same pattern.
    ///
    /// # Errors
    /// The unknown whose pivot is not positive, or the last one where memory or indices run out.
    pub fn new(matrix: &Lower, like: Option<Self>) -> Result<Self, usize> {
        let n = matrix.starts.len() - 1;
        let last = n.saturating_sub(1);
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let symbolic = match like {
            Some(old) => old.symbolic,
            None => factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, faer::prelude::default())
                .map_err(|_| last)?,
        };
        let mut values = vec![0.0; symbolic.len_val()];
        let need = symbolic.factorize_numeric_llt_scratch::<f64>(PAR, faer::prelude::default());
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
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        let n = self.symbolic.nrows();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns, PAR));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, n, columns),
            PAR,
            MemStack::new(&mut memory),
        );
    }
}
