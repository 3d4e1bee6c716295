//! Loops compiled for the widest vectors of the machine they run on.

use faer::traits::pulp::{Arch, NullaryFnOnce};

/// A job that is inlined wherever it is called. As a plain closure its call stays a function of its own, compiled for narrow
/// vectors, if the optimiser likes it that way.
struct Inlined<F>(F);

impl<R, F: FnMut() -> R> NullaryFnOnce for Inlined<F> {
    type Output = R;

    #[inline(always)]
    fn call(mut self) -> R {
        (self.0)()
    }
}

/// Runs a job, whose closure must be `#[inline(always)]`, as must be all that its inner loops call. Results have the same bits
/// for any width: nothing is reordered or contracted.
#[inline(always)]
pub(crate) fn wide<R>(job: impl FnMut() -> R) -> R {
    Arch::new().dispatch(Inlined(job))
}
