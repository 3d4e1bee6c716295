//! What cannot be solved.

/// A matrix has no Cholesky factor: it is singular or indefinite to working precision, or is no symmetric matrix at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the system is not positive definite at unknown {unknown}; hold a value in every connected piece, or remove faces without area there"
)]
pub struct NotPositiveDefinite {
    /// The first unknown whose pivot is not positive; the last one where memory or indices run out or the arrays are no matrix.
    pub unknown: usize,
}
