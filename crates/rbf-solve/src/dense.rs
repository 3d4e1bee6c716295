//! The whole system at once, by Cholesky.
//!
//! A conditionally definite kernel is definite on weights orthogonal to affine functions. Such weights are free at all unknowns but
//! four, which they determine; the matrix reduced to the free ones is assembled directly and factored without pivoting, in half
//! the work of an indefinite factorization (\[Beatson2000\] §4).

use crate::admit::System;
use crate::affine::Affine;
use crate::error::Error;
use crate::kernel::{Cubic, Kernel, Linear, Radial};
use crate::sum::Sum;
use crate::wide::wide;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::{MatMut, Par};
use rayon::prelude::*;

/// The field's sum, and what it leaves of every functional: solved once and refined once.
pub(crate) fn solve(
    system: &System,
    affine: &Affine,
    kernel: Kernel,
    step: &dyn Fn(f64) -> Result<(), Error>,
) -> Result<(Sum, Vec<f64>), Error> {
    let dense = Dense::factor(system, affine, kernel)?;
    step(0.9)?;
    let mut sum = Sum::new(&system.points, system.gradients.len());
    let wanted = system.wanted();
    let mut weights = vec![0.0; wanted.len()];
    let mut missing = wanted.clone();
    let mut best = f64::INFINITY;
    for share in [0.95, 0.98] {
        let before = sum.clone();
        dense.correct(&missing, &mut weights, &mut sum, system);
        let got = functionals(&sum, kernel, system);
        let left: Vec<f64> = wanted.iter().zip(&got).map(|(w, g)| w - g).collect();
        // `max` would drop NaN, which must show.
        let worst = left.iter().fold(0.0, |a: f64, v| if v.abs() <= a { a } else { v.abs() });
        if worst >= best || worst.is_nan() {
            sum = before;
            break;
        }
        (missing, best) = (left, worst);
        step(share)?;
    }
    if best.is_finite() { Ok((sum, missing)) } else { Err(system.singular_at(0)) }
}

/// faer's results depend on the number of parts it splits work into; fixed, they do not depend on the threads that do it.
fn parts() -> Par {
    Par::rayon(4)
}

/// A factored system, ready for right-hand sides.
pub(crate) struct Dense<'a> {
    affine: &'a Affine,
    kernel: Kernel,
    factor: Vec<f64>,
    unknowns: usize,
}

impl<'a> Dense<'a> {
    /// Assembles and factors. O(n³/3) time, 8n² bytes.
    pub(crate) fn factor(system: &System, affine: &'a Affine, kernel: Kernel) -> Result<Self, Error> {
        let m = system.unknowns();
        let mut factor = match kernel {
            Kernel::Biharmonic => assemble::<Linear>(system, affine),
            Kernel::Triharmonic => assemble::<Cubic>(system, affine),
        };
        let mut memory =
            MemBuffer::new(llt::factor::cholesky_in_place_scratch::<f64>(m, parts(), faer::Spec::default()));
        llt::factor::cholesky_in_place(
            MatMut::from_column_major_slice_mut(&mut factor, m, m),
            llt::factor::LltRegularization::default(),
            parts(),
            MemStack::new(&mut memory),
            faer::Spec::default(),
        )
        .map_err(|llt::factor::LltError::NonPositivePivot { index }| system.singular_at(index.min(m - 1)))?;
        Ok(Self { affine, kernel, factor, unknowns: m })
    }

    /// Adds to `weights` and to the affine part of `sum` what makes up for `missing`, the wanted functionals less those of `sum`.
    pub(crate) fn correct(&self, missing: &[f64], weights: &mut [f64], sum: &mut Sum, system: &System) {
        let Affine { special, shares, .. } = self.affine;
        let sign = sign(self.kernel);
        let mut rhs: Vec<f64> = (0..self.unknowns)
            .map(|u| sign * (missing[u] - (0..4).map(|k| shares[k][u] * missing[special[k]]).sum::<f64>()))
            .collect();
        for &s in special {
            rhs[s] = 0.0;
        }
        let m = self.unknowns;
        llt::solve::solve_in_place(
            faer::MatRef::from_column_major_slice(&self.factor, m, m),
            MatMut::from_column_major_slice_mut(&mut rhs, m, 1),
            parts(),
            MemStack::new(&mut MemBuffer::new(llt::solve::solve_in_place_scratch::<f64>(m, 1, parts()))),
        );
        for k in 0..4 {
            rhs[special[k]] = -(0..m).filter(|u| !special.contains(u)).map(|u| shares[k][u] * rhs[u]).sum::<f64>();
        }
        for (w, d) in weights.iter_mut().zip(&rhs) {
            *w += d;
        }
        // What the corrected weights leave at the special four is the affine part's.
        let mut change = Sum::new(&system.points, system.gradients.len());
        change.set_weights(&rhs);
        let at = functionals(&change, self.kernel, system);
        let rest = self.affine.coefficients(special.map(|s| missing[s] - at[s]));
        sum.set_weights(weights);
        for (c, d) in sum.affine.iter_mut().zip(rest) {
            *c += d;
        }
    }
}

fn sign(kernel: Kernel) -> f64 {
    match kernel {
        Kernel::Biharmonic => Linear::SIGN,
        Kernel::Triharmonic => Cubic::SIGN,
    }
}

/// Every unknown's functional of a sum: values at all points, then gradients at the last ones.
pub(crate) fn functionals(sum: &Sum, kernel: Kernel, system: &System) -> Vec<f64> {
    let mut values = vec![0.0; system.points.len()];
    sum.values(kernel, &system.points, &mut values);
    let tilted = &system.points[system.plain()..];
    let mut gradients = vec![glam::DVec3::ZERO; tilted.len()];
    sum.gradients(kernel, tilted, &mut gradients);
    for k in 0..3 {
        values.extend(gradients.iter().map(|g| g[k]));
    }
    values
}

/// The lower triangle of the reduced matrix, by columns. The special four keep rows of their own, of the identity.
fn assemble<K: Radial>(system: &System, affine: &Affine) -> Vec<f64> {
    let m = system.unknowns();
    let Affine { special, shares, .. } = affine;
    let axes: [Vec<f64>; 3] = [0, 1, 2].map(|k| system.points.iter().map(|p| p[k]).collect());
    let columns = special.map(|s| {
        let mut column = vec![0.0; m];
        fill_column::<K>(system, &axes, s, 0, &mut column);
        column
    });
    let mut matrix = vec![0.0; m * m];
    matrix.par_chunks_mut(m).enumerate().for_each(|(j, column)| {
        if special.contains(&j) {
            column[j] = 1.0;
            return;
        }
        wide(
            #[inline(always)]
            || {
                fill_column::<K>(system, &axes, j, j, column);
                // (I − shares)ᵀ A (I − shares), one column of it.
                let own: [f64; 4] = [0, 1, 2, 3].map(|k| shares[k][j]);
                let rest: [f64; 4] =
                    [0, 1, 2, 3].map(|k| columns[k][j] - (0..4).map(|l| columns[l][special[k]] * own[l]).sum::<f64>());
                let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|k| &shares[k][j..m]);
                let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|k| &columns[k][j..m]);
                for (i, out) in column[j..].iter_mut().enumerate() {
                    let left = s0[i] * rest[0] + s1[i] * rest[1] + s2[i] * rest[2] + s3[i] * rest[3];
                    let right = c0[i] * own[0] + c1[i] * own[1] + c2[i] * own[2] + c3[i] * own[3];
                    *out = K::SIGN * (*out - (left + right));
                }
            },
        );
        for &s in special {
            if s > j {
                column[s] = 0.0;
            }
        }
    });
    matrix
}

/// Functionals `from..` of the kernel that belongs to unknown `column`.
#[inline(always)]
fn fill_column<K: Radial>(system: &System, axes: &[Vec<f64>; 3], column: usize, from: usize, out: &mut [f64]) {
    let (n, plain, tilted) = (system.points.len(), system.plain(), system.gradients.len());
    let c = system.points[system.point_of(column)];
    let [x, y, z] = axes;
    // A gradient's component taken at the centre's side turns the sign.
    let along = (column >= n).then(|| (column - n) / tilted);
    for i in from..n {
        let d = [x[i] - c.x, y[i] - c.y, z[i] - c.z];
        let r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let r = r2.sqrt();
        out[i] = match along {
            None => K::value(r2, r),
            Some(k) => -K::slope(r2, r) * d[k],
        };
    }
    for (k, row) in (0..3).flat_map(|k| (0..tilted).map(move |t| (k, n + k * tilted + t))) {
        if row < from {
            continue;
        }
        let d = system.points[plain + (row - n) % tilted] - c;
        let r2 = d.length_squared();
        let r = r2.sqrt();
        out[row] = match along {
            None => K::slope(r2, r) * d[k],
            // Only r³ is asked for second derivatives, 3 (δ r + d dᵀ / r).
            Some(l) => {
                let across = if k == l { r } else { 0.0 };
                let both = if r > 0.0 { d[k] * d[l] / r } else { 0.0 };
                -3.0 * (across + both)
            }
        };
    }
}
