//! Conjugate gradients, for systems whose matrix is too dense or too short-lived to factorise.

use glam::DVec3;
use std::ops::{AddAssign, Mul, Sub, SubAssign};

/// An entry of a solution: a number, or a point whose three coordinates are solved for at once.
pub trait Vector: Copy + AddAssign + SubAssign + Sub<Output = Self> + Mul<f64, Output = Self> {
    /// The sum of the products of coordinates.
    #[must_use]
    fn inner(self, other: Self) -> f64;
}

impl Vector for f64 {
    fn inner(self, other: Self) -> f64 {
        self * other
    }
}

impl Vector for DVec3 {
    fn inner(self, other: Self) -> f64 {
        self.dot(other)
    }
}

/// When conjugate gradients stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// The residual's norm as a share of that at the start, both weighed by the inverse diagonal.
    pub share: f64,
    /// The most steps.
    pub steps: usize,
}

/// What conjugate gradients reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converged {
    /// Steps taken.
    pub steps: usize,
    /// The residual's norm as a share of that at the start; 0 where the start was the solution.
    pub share: f64,
}

/// Solves A x = `right` from the `x` given, A symmetric positive semidefinite and given by its action, with its `diagonal` as preconditioner;
/// entries of the diagonal that are not positive count as one. Stops early where A has no inverse along the search direction.
///
/// ```
/// use mesh_operators::{Stop, conjugate_gradients};
/// let apply = |x: &[f64]| vec![4.0 * x[0] + x[1], x[0] + 2.0 * x[1]];
/// let mut x = vec![0.0; 2];
/// let found = conjugate_gradients(apply, &[4.0, 2.0], &[5.0, 3.0], &mut x, Stop { share: 1e-14, steps: 10 });
/// assert!((x[0] - 1.0).abs() + (x[1] - 1.0).abs() < 1e-12 && found.steps <= 3);
/// ```
pub fn conjugate_gradients<T: Vector>(
    apply: impl Fn(&[T]) -> Vec<T>,
    diagonal: &[f64],
    right: &[T],
    x: &mut [T],
    stop: Stop,
) -> Converged {
    let dot = |a: &[T], b: &[T]| a.iter().zip(b).map(|(p, q)| p.inner(*q)).sum::<f64>();
    let scale = |r: &[T]| -> Vec<T> {
        let each = |(r, &d): (&T, &f64)| if d > 0.0 { *r * d.recip() } else { *r };
        r.iter().zip(diagonal).map(each).collect()
    };
    let mut residual: Vec<T> = right.iter().zip(apply(x)).map(|(b, a)| *b - a).collect();
    let mut scaled = scale(&residual);
    let mut direction = scaled.clone();
    let start = dot(&residual, &scaled);
    let mut size = start;
    let mut steps = 0;
    while steps < stop.steps && size > stop.share * stop.share * start {
        let image = apply(&direction);
        let length = size / dot(&direction, &image);
        if !(length > 0.0 && length.is_finite()) {
            break;
        }
        for (((x, r), d), i) in x.iter_mut().zip(&mut residual).zip(&direction).zip(&image) {
            *x += *d * length;
            *r -= *i * length;
        }
        scaled = scale(&residual);
        let next = dot(&residual, &scaled);
        for (d, s) in direction.iter_mut().zip(&scaled) {
            let along = *d * (next / size);
            *d = *s;
            *d += along;
        }
        size = next;
        steps += 1;
    }
    Converged { steps, share: if start > 0.0 { (size / start).sqrt() } else { 0.0 } }
}
