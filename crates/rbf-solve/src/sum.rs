//! Values and gradients of a sum of kernels, directly, many points at a time.
//!
//! Points lie across the lanes and every point adds its centres in their order, so results depend neither on the width of the
//! machine's vectors, nor on threads, nor on what else is in the batch.

use crate::kernel::{Kernel, Radial, with_kernel};
use crate::wide::wide;
use glam::DVec3;
use rayon::prelude::*;

/// Points evaluated together. Eight doubles are one to four vectors of today's machines.
pub(crate) const LANES: usize = 8;
/// Points per task.
const TASK: usize = 32 * LANES;

/// Centres and their weights, in flat arrays. The gradient weights belong to the last centres.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sum {
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) z: Vec<f64>,
    pub(crate) weights: Vec<f64>,
    pub(crate) tilts: [Vec<f64>; 3],
    /// Coefficients of 1, x, y, z.
    pub(crate) affine: [f64; 4],
}

pub(crate) type Block = [[f64; LANES]; 3];

impl Sum {
    /// All weights zero.
    pub(crate) fn new(points: &[DVec3], tilted: usize) -> Self {
        Self {
            x: points.iter().map(|p| p.x).collect(),
            y: points.iter().map(|p| p.y).collect(),
            z: points.iter().map(|p| p.z).collect(),
            weights: vec![0.0; points.len()],
            tilts: [0; 3].map(|_| vec![0.0; tilted]),
            affine: [0.0; 4],
        }
    }

    pub(crate) fn centres(&self) -> Vec<DVec3> {
        let place = |((&x, &y), &z)| DVec3::new(x, y, z);
        self.x.iter().zip(&self.y).zip(&self.z).map(place).collect()
    }

    /// Takes weights in order of unknowns.
    pub(crate) fn set_weights(&mut self, weights: &[f64]) {
        let (values, tilts) = weights.split_at(self.weights.len());
        self.weights.copy_from_slice(values);
        for (k, tilt) in self.tilts.iter_mut().enumerate() {
            let n = tilt.len();
            tilt.copy_from_slice(&tilts[k * n..(k + 1) * n]);
        }
    }

    /// The sum at every point. O(points · centres).
    pub(crate) fn values(&self, kernel: Kernel, points: &[DVec3], out: &mut [f64]) {
        with_kernel!(kernel, K => out.par_chunks_mut(TASK).zip(points.par_chunks(TASK)).for_each(|(out, points)| {
            wide(#[inline(always)] || {
                for (out, points) in out.chunks_mut(LANES).zip(points.chunks(LANES)) {
                    out.copy_from_slice(&self.block_values::<K>(&spread(points))[..points.len()]);
                }
            });
        }));
    }

    /// The gradient of the sum at every point. O(points · centres).
    pub(crate) fn gradients(&self, kernel: Kernel, points: &[DVec3], out: &mut [DVec3]) {
        with_kernel!(kernel, K => out.par_chunks_mut(TASK).zip(points.par_chunks(TASK)).for_each(|(out, points)| {
            wide(#[inline(always)] || {
                for (out, points) in out.chunks_mut(LANES).zip(points.chunks(LANES)) {
                    let [x, y, z] = self.block_gradients::<K>(&spread(points));
                    for (l, out) in out.iter_mut().enumerate() {
                        *out = DVec3::new(x[l], y[l], z[l]);
                    }
                }
            });
        }));
    }

    /// Both at once, in little more time than the gradient alone. O(points · centres).
    pub(crate) fn values_and_gradients(
        &self,
        kernel: Kernel,
        points: &[DVec3],
        values: &mut [f64],
        gradients: &mut [DVec3],
    ) {
        if !self.tilts[0].is_empty() {
            self.values(kernel, points, values);
            return self.gradients(kernel, points, gradients);
        }
        let tasks = values.par_chunks_mut(TASK).zip(gradients.par_chunks_mut(TASK)).zip(points.par_chunks(TASK));
        with_kernel!(kernel, K => tasks.for_each(|((values, gradients), points)| {
            wide(#[inline(always)] || {
                let blocks = values.chunks_mut(LANES).zip(gradients.chunks_mut(LANES)).zip(points.chunks(LANES));
                for ((values, gradients), points) in blocks {
                    let (value, [x, y, z]) = self.block_of_both::<K>(&spread(points));
                    values.copy_from_slice(&value[..points.len()]);
                    for (l, out) in gradients.iter_mut().enumerate() {
                        *out = DVec3::new(x[l], y[l], z[l]);
                    }
                }
            });
        }));
    }

    /// In the same order as each alone, so that it gives the same bits. For centres without gradient weights.
    #[inline(always)]
    pub(crate) fn block_of_both<K: Radial>(&self, at: &Block) -> ([f64; LANES], Block) {
        let [c, cx, cy, cz] = self.affine;
        let mut value: [f64; LANES] = std::array::from_fn(|l| c + cx * at[0][l] + cy * at[1][l] + cz * at[2][l]);
        let mut sum: Block = std::array::from_fn(|k| [self.affine[k + 1]; LANES]);
        for (((&x, &y), &z), &w) in self.x.iter().zip(&self.y).zip(&self.z).zip(&self.weights) {
            for l in 0..LANES {
                let (dx, dy, dz) = (at[0][l] - x, at[1][l] - y, at[2][l] - z);
                let r2 = dx * dx + dy * dy + dz * dz;
                let r = r2.sqrt();
                value[l] += w * K::value(r2, r);
                let s = w * K::slope(r2, r);
                sum[0][l] += s * dx;
                sum[1][l] += s * dy;
                sum[2][l] += s * dz;
            }
        }
        (value, sum)
    }

    #[inline(always)]
    pub(crate) fn block_values<K: Radial>(&self, at: &Block) -> [f64; LANES] {
        let [c, cx, cy, cz] = self.affine;
        let mut sum: [f64; LANES] = std::array::from_fn(|l| c + cx * at[0][l] + cy * at[1][l] + cz * at[2][l]);
        let plain = self.x.len() - self.tilts[0].len();
        let (x, y, z, w) = (&self.x[..plain], &self.y[..plain], &self.z[..plain], &self.weights[..plain]);
        add_block::<K>([x, y, z], w, at, &mut sum);
        for (i, t) in (plain..self.x.len()).zip(0..) {
            let (x, y, z, w) = (self.x[i], self.y[i], self.z[i], self.weights[i]);
            let [bx, by, bz] = [0, 1, 2].map(|k| self.tilts[k][t]);
            for l in 0..LANES {
                let (dx, dy, dz) = (at[0][l] - x, at[1][l] - y, at[2][l] - z);
                let r2 = dx * dx + dy * dy + dz * dz;
                let r = r2.sqrt();
                sum[l] += w * K::value(r2, r) - K::slope(r2, r) * (bx * dx + by * dy + bz * dz);
            }
        }
        sum
    }

    #[inline(always)]
    fn block_gradients<K: Radial>(&self, at: &Block) -> Block {
        let mut sum: Block = std::array::from_fn(|k| [self.affine[k + 1]; LANES]);
        let plain = self.x.len() - self.tilts[0].len();
        let (x, y, z, w) = (&self.x[..plain], &self.y[..plain], &self.z[..plain], &self.weights[..plain]);
        for (((&x, &y), &z), &w) in x.iter().zip(y).zip(z).zip(w) {
            for l in 0..LANES {
                let (dx, dy, dz) = (at[0][l] - x, at[1][l] - y, at[2][l] - z);
                let r2 = dx * dx + dy * dy + dz * dz;
                let s = w * K::slope(r2, r2.sqrt());
                sum[0][l] += s * dx;
                sum[1][l] += s * dy;
                sum[2][l] += s * dz;
            }
        }
        // Only r³ has gradient weights; its Hessian is 3 (r I + d dᵀ / r).
        for (i, t) in (plain..self.x.len()).zip(0..) {
            let (x, y, z, w) = (self.x[i], self.y[i], self.z[i], self.weights[i]);
            let [bx, by, bz] = [0, 1, 2].map(|k| self.tilts[k][t]);
            for l in 0..LANES {
                let (dx, dy, dz) = (at[0][l] - x, at[1][l] - y, at[2][l] - z);
                let r = (dx * dx + dy * dy + dz * dz).sqrt();
                let along = if r > 0.0 { (bx * dx + by * dy + bz * dz) / r } else { 0.0 };
                let s = 3.0 * (w * r - along);
                sum[0][l] += s * dx - 3.0 * r * bx;
                sum[1][l] += s * dy - 3.0 * r * by;
                sum[2][l] += s * dz - 3.0 * r * bz;
            }
        }
        sum
    }
}

/// Adds centres without gradient weights to a block of points.
#[inline(always)]
pub(crate) fn add_block<K: Radial>(centres: [&[f64]; 3], weights: &[f64], at: &Block, sum: &mut [f64; LANES]) {
    let [x, y, z] = centres;
    for (((&x, &y), &z), &w) in x.iter().zip(y).zip(z).zip(weights) {
        for l in 0..LANES {
            let (dx, dy, dz) = (at[0][l] - x, at[1][l] - y, at[2][l] - z);
            let r2 = dx * dx + dy * dy + dz * dz;
            sum[l] += w * K::value(r2, r2.sqrt());
        }
    }
}

/// Puts up to `LANES` points across the lanes, the first filling what is left over.
#[inline(always)]
pub(crate) fn spread(points: &[DVec3]) -> Block {
    std::array::from_fn(|k| std::array::from_fn(|l| points.get(l).unwrap_or(&points[0])[k]))
}
