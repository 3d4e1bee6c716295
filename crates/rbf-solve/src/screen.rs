//! A sparse approximate inverse of the reduced matrix.
//!
//! Kernels that are Green's functions screen: given its neighbours, a value hardly depends on what is farther away. So each unknown,
//! in coarse-to-fine order, is regressed on the nearest ones before it only, which gives a sparse factor of the inverse
//! (\[Schafer2021\]).

use crate::affine::Affine;
use crate::kernel::Radial;
use crate::order::CoarseToFine;
use crate::wide::wide;
use glam::DVec3;
use rayon::prelude::*;

/// How many points each one is regressed on.
const NEIGHBOURS: usize = 64;
/// Pivots below this share of the diagonal are lost in rounding; their points are passed over.
const LOST: f64 = 1e-14;

/// The factor: row i holds the regression of one point on those before it.
pub(crate) struct Screen {
    ordered: CoarseToFine,
    weights: Vec<f64>,
    precisions: Vec<f64>,
}

impl Screen {
    /// Regresses every point but the special four. O(n k³) for k neighbours.
    pub(crate) fn new<K: Radial>(points: &[DVec3], affine: &Affine) -> Self {
        let free: Vec<u32> = (0..points.len() as u32).filter(|&i| !affine.special.contains(&(i as usize))).collect();
        let ordered = CoarseToFine::new(points, &free, NEIGHBOURS);
        let reduced = Reduced::<K>::new(points, affine);
        let rows: Vec<(Vec<f64>, f64)> = (0..free.len())
            .into_par_iter()
            .map(|at| reduced.regress(ordered.order[at], ordered.neighbours(at)))
            .collect();
        let precisions = rows.iter().map(|r| r.1).collect();
        Self { weights: rows.into_iter().flat_map(|r| r.0).collect(), precisions, ordered }
    }

    /// Applies the approximate inverse. O(n k).
    pub(crate) fn apply(&self, r: &[f64]) -> Vec<f64> {
        let mut z = vec![0.0; r.len()];
        let mut start = 0;
        for (at, &i) in self.ordered.order.iter().enumerate() {
            let (near, weights) = (self.ordered.neighbours(at), &self.weights[start..self.ordered.ends[at]]);
            start = self.ordered.ends[at];
            let known: f64 = near.iter().zip(weights).map(|(&j, w)| w * r[j as usize]).sum();
            let u = (r[i as usize] - known) * self.precisions[at];
            z[i as usize] += u;
            for (&j, w) in near.iter().zip(weights) {
                z[j as usize] -= w * u;
            }
        }
        z
    }
}

/// Entries of the reduced matrix, one at a time.
struct Reduced<'a, K> {
    points: &'a [DVec3],
    affine: &'a Affine,
    /// The kernel between each special point and all points, with half of the special points' own part taken off.
    columns: [Vec<f64>; 4],
    kernel: std::marker::PhantomData<K>,
}

impl<'a, K: Radial> Reduced<'a, K> {
    fn new(points: &'a [DVec3], affine: &'a Affine) -> Self {
        let Affine { special, shares, .. } = affine;
        let columns = special.map(|s| {
            let own: [f64; 4] = special.map(|t| phi::<K>(points[s], points[t]));
            (0..points.len())
                .map(|i| phi::<K>(points[s], points[i]) - 0.5 * (0..4).map(|l| own[l] * shares[l][i]).sum::<f64>())
                .collect()
        });
        Self { points, affine, columns, kernel: std::marker::PhantomData }
    }

    /// The weights with which `near` predict `i`, and the reciprocal of what variance is left.
    fn regress(&self, i: u32, near: &[u32]) -> (Vec<f64>, f64) {
        let all: Vec<usize> = near.iter().chain([&i]).map(|&j| j as usize).collect();
        let (k, n) = (near.len(), all.len());
        let [x, y, z] = [0, 1, 2].map(|a| all.iter().map(|&j| self.points[j][a]).collect::<Vec<_>>());
        let shares = [0, 1, 2, 3].map(|a| all.iter().map(|&j| self.affine.shares[a][j]).collect::<Vec<_>>());
        let columns = [0, 1, 2, 3].map(|a| all.iter().map(|&j| self.columns[a][j]).collect::<Vec<_>>());
        // Lower triangle by columns, the point itself in the last row.
        let mut l = vec![0.0; n * n];
        let mut lost = LOST;
        wide(
            #[inline(always)]
            || {
                for c in 0..n {
                    let (done, rest) = l.split_at_mut(c * n);
                    let column = &mut rest[c..n];
                    let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|a| &shares[a][c..]);
                    let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|a| &columns[a][c..]);
                    let (x, y, z) = (&x[c..], &y[c..], &z[c..]);
                    for (r, out) in column.iter_mut().enumerate() {
                        let (dx, dy, dz) = (x[r] - x[0], y[r] - y[0], z[r] - z[0]);
                        let r2 = dx * dx + dy * dy + dz * dz;
                        let left = s0[r] * c0[0] + s1[r] * c1[0] + s2[r] * c2[0] + s3[r] * c3[0];
                        let right = c0[r] * s0[0] + c1[r] * s1[0] + c2[r] * s2[0] + c3[r] * s3[0];
                        *out = K::SIGN * (K::value(r2, r2.sqrt()) - (left + right));
                    }
                    let whole = column[0];
                    for before in done.chunks(n) {
                        let factor = before[c];
                        column.iter_mut().zip(&before[c..]).for_each(|(v, b)| *v -= factor * b);
                    }
                    // A point that those before it determine to working precision is passed over.
                    let kept = column[0] > LOST * whole;
                    let scale = if kept { 1.0 / column[0].sqrt() } else { 0.0 };
                    for v in column.iter_mut() {
                        *v *= scale;
                    }
                    if c == k {
                        lost = if kept { column[0] } else { (LOST * whole.abs()).sqrt() };
                    }
                }
                // The last row solved backwards for the weights.
                let mut weights: Vec<f64> = (0..k).map(|c| l[c * n + k]).collect();
                for c in (0..k).rev() {
                    let column = &l[c * n..][..n];
                    let known: f64 = weights[c + 1..].iter().zip(&column[c + 1..k]).map(|(w, v)| w * v).sum();
                    weights[c] = if column[c] > 0.0 { (weights[c] - known) / column[c] } else { 0.0 };
                }
                (weights, if lost > 0.0 { 1.0 / (lost * lost) } else { 1.0 })
            },
        )
    }
}

fn phi<K: Radial>(a: DVec3, b: DVec3) -> f64 {
    let r2 = a.distance_squared(b);
    K::value(r2, r2.sqrt())
}
