//! How expansions on cells apart act on each other.
//!
//! Kernels that are powers of the distance need one set of matrices for all levels, and mirrored and turned pairs of cells share theirs.

use crate::chebyshev::Basis;
use crate::kernel::{Kernel, Radial, with_kernel};
use crate::wide::wide;
use glam::{DVec3, IVec3};
use rayon::prelude::*;

/// The ways to turn a cube's axes.
const TURNS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
/// Blocks of rows with a common number of columns.
const BLOCKS: usize = 6;
/// Products of target and source matter up to this sum of squared degrees, as a share of the largest squared degree of one.
const JOINT: f64 = 1.3;

/// How expansions on cells of width two act on each other, and the expansions themselves.
pub(crate) struct Translations {
    pub(crate) basis: Basis,
    pub(crate) kernel: Kernel,
    /// By sorted absolute offset (a ≥ b ≥ c, a in 2..4): column-major, targets down, products in order of their degree.
    pub(crate) matrices: Vec<Vec<f64>>,
    /// Rows of every matrix in blocks: first row, last row, and how many columns matter to them.
    pub(crate) blocks: Vec<(usize, usize, usize)>,
    /// For each of the [`TURNS`], where each product of the turned axes stands by degree.
    turned: [Vec<u32>; 6],
    /// For each set of mirrored axes, the sign of each product: odd polynomials change theirs.
    signs: [Vec<f64>; 8],
}

/// How an offset comes from a sorted absolute one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Pose {
    pub(crate) matrix: usize,
    turn: usize,
    mirror: usize,
}

impl Pose {
    pub(crate) fn of(offset: IVec3) -> Self {
        let o = offset.to_array();
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|&k| (-o[k].abs(), k));
        let key = IVec3::from(axes.map(|k| o[k].abs()));
        Self {
            matrix: canonical().iter().position(|&c| c == key).unwrap_or(0),
            turn: TURNS.iter().position(|&t| t == axes).unwrap_or(0),
            mirror: (0..3).filter(|&k| o[k] < 0).map(|k| 1 << k).sum(),
        }
    }
}

impl Translations {
    /// Tabulates. O(degree⁷).
    pub(crate) fn new(kernel: Kernel, degree: usize) -> Self {
        let basis = Basis::new(degree);
        let squared = |i: usize| basis.degrees[i].iter().map(|d| d * d).sum::<usize>();
        let mut sorted: Vec<usize> = (0..basis.len()).collect();
        sorted.sort_by_key(|&i| (squared(i), i));
        let mut rank = vec![0; basis.len()];
        sorted.iter().enumerate().for_each(|(at, &i)| rank[i] = at);
        let nodes = basis.places(DVec3::ZERO, 1.0);
        let matrices = with_kernel!(kernel, K => canonical()
            .into_par_iter()
            .map(|o| {
                let mut table = vec![0.0; nodes.len() * nodes.len()];
                wide(#[inline(always)] || {
                    for (row, &t) in table.chunks_mut(nodes.len()).zip(&nodes) {
                        let from = t - 2.0 * o.as_dvec3();
                        for (out, &s) in row.iter_mut().zip(&nodes) {
                            let r2 = s.distance_squared(from);
                            *out = K::value(r2, r2.sqrt());
                        }
                    }
                });
                wide(#[inline(always)] || basis.analyse_pairs(&table, &sorted))
            })
            .collect());
        // A product of high degree in the target is felt with products of low degree in the source only.
        let joint = JOINT * (degree * degree) as f64;
        let cuts: Vec<usize> = (0..=BLOCKS)
            .map(|b| {
                sorted.partition_point(|&i| (squared(i) * BLOCKS) < b * degree * degree + usize::from(b == BLOCKS))
            })
            .collect();
        let blocks = cuts
            .windows(2)
            .filter(|w| w[0] < w[1])
            .map(|w| {
                let least = squared(sorted[w[0]]) as f64;
                (w[0], w[1], sorted.partition_point(|&i| squared(i) as f64 + least <= joint))
            })
            .collect();
        let p = basis.order;
        let place = |[a, b, c]: [usize; 3]| (a * p + b) * p + c;
        let mut full = vec![0; p * p * p];
        for (d, &rank) in basis.degrees.iter().zip(&rank) {
            full[place(*d)] = rank as u32;
        }
        let turned = TURNS.map(|axes| basis.degrees.iter().map(|d| full[place(axes.map(|k| d[k]))]).collect());
        let odd =
            |d: &[usize; 3], mirror: usize| (0..3).filter(|k| mirror >> k & 1 == 1).map(|k| d[k]).sum::<usize>() % 2;
        let sign = |mirror: usize| basis.degrees.iter().map(|d| if odd(d, mirror) == 1 { -1.0 } else { 1.0 }).collect();
        let signs = [0, 1, 2, 3, 4, 5, 6, 7].map(sign);
        Self { basis, kernel, matrices, blocks, turned, signs }
    }

    /// Where each product stands in the matrix of a pose, and its sign there.
    pub(crate) fn names(&self, pose: Pose) -> impl Iterator<Item = (usize, f64)> {
        self.turned[pose.turn].iter().map(|&n| n as usize).zip(self.signs[pose.mirror].iter().copied())
    }
}

/// Offsets of cells that are apart while their parents are not, up to mirroring and turning.
fn canonical() -> Vec<IVec3> {
    let all = (2..4).flat_map(|a| (0..=a).flat_map(move |b| (0..=b).map(move |c| IVec3::new(a, b, c))));
    all.collect()
}

/// The degree of expansions that lose less than a fit does, at 1e-6 of the extent.
pub(crate) fn degree(kernel: Kernel) -> usize {
    match kernel {
        Kernel::Biharmonic => 7,
        Kernel::Triharmonic => 9,
    }
}
