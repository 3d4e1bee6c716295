//! Radial kernels as functions of the distance.

/// Which radial function the field is a sum of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// φ(r) = r, biharmonic in space (\[Zhu2005\] §2.2). Stiff and free of bumps, but without a gradient at its own centres, so
    /// it cannot take gradient constraints and meets other surfaces with a crease.
    Biharmonic,
    /// φ(r) = r³, triharmonic (\[TurkOBrien2002\], \[Lin2008\] §2). Twice differentiable everywhere. With gradient constraints it is the
    /// Hermite interpolant of least bending.
    #[default]
    Triharmonic,
}

/// A kernel as the inner loops see it. All functions take r² and r, since every caller has both.
pub(crate) trait Radial: Copy + Send + Sync {
    /// The sign that makes the kernel positive definite on weights orthogonal to affine functions.
    const SIGN: f64;
    /// φ(r).
    fn value(r2: f64, r: f64) -> f64;
    /// φ'(r) / r, zero where r is.
    fn slope(r2: f64, r: f64) -> f64;
}

#[derive(Clone, Copy)]
pub(crate) struct Linear;

impl Radial for Linear {
    const SIGN: f64 = -1.0;
    #[inline(always)]
    fn value(_: f64, r: f64) -> f64 {
        r
    }
    #[inline(always)]
    fn slope(_: f64, r: f64) -> f64 {
        if r > 0.0 { 1.0 / r } else { 0.0 }
    }
}

#[derive(Clone, Copy)]
pub(crate) struct Cubic;

impl Radial for Cubic {
    const SIGN: f64 = 1.0;
    #[inline(always)]
    fn value(r2: f64, r: f64) -> f64 {
        r2 * r
    }
    #[inline(always)]
    fn slope(_: f64, r: f64) -> f64 {
        3.0 * r
    }
}

/// Runs an expression with `$K` bound to the type of a [`Kernel`].
macro_rules! with_kernel {
    ($kernel:expr, $K:ident => $body:expr) => {
        match $kernel {
            crate::kernel::Kernel::Biharmonic => {
                type $K = crate::kernel::Linear;
                $body
            }
            crate::kernel::Kernel::Triharmonic => {
                type $K = crate::kernel::Cubic;
                $body
            }
        }
    };
}
pub(crate) use with_kernel;
