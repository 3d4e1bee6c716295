//! Sums of kernels over many centres at many points, in time that grows with their number and not with its square.
//!
//! The black-box fast multipole method (\[FongDarve2009\]): what is far is felt through grids of Chebyshev nodes, on cells of an octree.

use crate::kernel::{Radial, with_kernel};
use crate::meet::Meetings;
use crate::octree::{Frame, Octree};
use crate::sum::{LANES, add_block};
use crate::translations::{Pose, Translations};
use crate::wide::wide;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use glam::DVec3;
use rayon::prelude::*;

/// Points per leaf: with so many, sums over those nearby take about as much time as expansions.
const LEAF: usize = 400;
/// Pairs of cells per matrix product, at least.
const BATCH: usize = 64;

/// Two cells apart, and how the one lies from the other.
struct Pair {
    pose: Pose,
    target: u32,
    source: u32,
}

/// Targets that one matrix product serves, each with its sources.
#[derive(Default)]
struct Batch<'a> {
    targets: Vec<(&'a mut [f64], &'a [Pair])>,
    columns: usize,
}

/// Two trees, and how their cells meet; ready for any weights.
pub(crate) struct Plan<'a> {
    translations: &'a Translations,
    frame: Frame,
    sources: Octree,
    /// None where the points are the centres themselves.
    targets: Option<Octree>,
    meetings: Meetings,
    /// The meetings apart, by matrix and target, so that a product knows no other's targets.
    far: Vec<Pair>,
}

impl<'a> Plan<'a> {
    /// Sums over `sources` at `targets`, or at the sources themselves.
    pub(crate) fn new(translations: &'a Translations, sources: &[DVec3], targets: Option<&[DVec3]>) -> Self {
        let frame = Frame::around(sources.iter().chain(targets.unwrap_or_default()));
        let source_tree = Octree::new(sources, &frame, LEAF);
        let target_tree = targets.map(|t| Octree::new(t, &frame, LEAF));
        let mut meetings = Meetings::new(
            target_tree.as_ref().unwrap_or(&source_tree),
            &source_tree,
            translations.basis.nodes.len().pow(3),
        );
        let pair = |(offset, target, source)| Pair { pose: Pose::of(offset), target, source };
        let mut far: Vec<Pair> = std::mem::take(&mut meetings.far).into_iter().map(pair).collect();
        far.par_sort_unstable_by_key(|p| (p.pose.matrix, p.target, p.pose, p.source));
        Self { translations, frame, sources: source_tree, targets: target_tree, meetings, far }
    }

    /// Σ wⱼ φ(|x − cⱼ|) at every target, in their own order.
    pub(crate) fn sums(&self, weights: &[f64]) -> Vec<f64> {
        with_kernel!(self.translations.kernel, K => self.sums_of::<K>(weights))
    }

    fn sums_of<K: Radial>(&self, weights: &[f64]) -> Vec<f64> {
        let targets = self.targets.as_ref().unwrap_or(&self.sources);
        let weights: Vec<f64> = self.sources.order.iter().map(|&i| weights[i as usize]).collect();
        let outer = self.gather(&weights);
        let mut inner = vec![0.0; targets.cells.len() * self.translations.basis.len()];
        self.translate::<K>(&outer, &mut inner);
        self.take_up::<K>(targets, &weights, &mut inner);
        self.hand_down(targets, &mut inner);
        let leaves: Vec<usize> = (0..targets.cells.len()).filter(|&c| targets.cells[c].is_leaf()).collect();
        let found: Vec<Vec<f64>> =
            leaves.par_iter().map(|&leaf| self.leaf_sums::<K>(targets, leaf, &weights, &outer, &inner)).collect();
        let mut out = vec![0.0; targets.order.len()];
        for (&leaf, values) in leaves.iter().zip(found) {
            for (&i, v) in targets.order[targets.cells[leaf].start..].iter().zip(values) {
                out[i as usize] = v;
            }
        }
        out
    }

    /// Where a place is in a cell's own cube [-1, 1]³.
    fn local(&self, tree: &Octree, cell: usize, at: usize) -> DVec3 {
        let cell = &tree.cells[cell];
        (tree.place(at) - self.frame.cell_centre(cell)) * (2.0 / self.frame.cell_width(cell.level))
    }

    /// Moments of every source cell, from the leaves up.
    fn gather(&self, weights: &[f64]) -> Vec<f64> {
        let (basis, tree) = (&self.translations.basis, &self.sources);
        let q = basis.len();
        let mut outer = vec![0.0; tree.cells.len() * q];
        outer.par_chunks_mut(q).enumerate().filter(|(c, _)| tree.cells[*c].is_leaf()).for_each(|(c, out)| {
            wide(
                #[inline(always)]
                || {
                    let cell = &tree.cells[c];
                    for (at, &weight) in (cell.start..cell.end).zip(&weights[cell.start..cell.end]) {
                        basis.gather_point(self.local(tree, c, at), weight, out);
                    }
                },
            );
        });
        for (first, last) in levels(tree).into_iter().rev() {
            let (above, below) = outer.split_at_mut(last * q);
            above[first * q..].par_chunks_mut(q).enumerate().for_each(|(i, parent)| {
                wide(
                    #[inline(always)]
                    || {
                        for kid in tree.cells[first + i].kids() {
                            basis.gather(&below[(kid - last) * q..][..q], octant(tree, kid), parent);
                        }
                    },
                );
            });
        }
        outer
    }

    /// Grid to grid, one matrix after the other.
    fn translate<K: Radial>(&self, outer: &[f64], inner: &mut [f64]) {
        let q = self.translations.basis.len();
        for pairs in self.far.chunk_by(|a, b| a.pose.matrix == b.pose.matrix) {
            let mut targets = inner.chunks_mut(q).enumerate();
            let mut batches: Vec<Batch<'_>> = vec![];
            for of_target in pairs.chunk_by(|a, b| a.target == b.target) {
                let Some((_, expansion)) = targets.find(|(c, _)| *c == of_target[0].target as usize) else { continue };
                if batches.last().is_none_or(|batch| batch.columns >= BATCH) {
                    batches.push(Batch::default());
                }
                if let Some(batch) = batches.last_mut() {
                    batch.columns += of_target.len();
                    batch.targets.push((expansion, of_target));
                }
            }
            batches.into_par_iter().for_each(|batch| self.translate_batch::<K>(outer, batch));
        }
    }

    fn translate_batch<K: Radial>(&self, outer: &[f64], batch: Batch<'_>) {
        let Some(Pair { pose, .. }) = batch.targets.first().and_then(|t| t.1.first()) else { return };
        let (q, count, matrix) =
            (self.translations.basis.len(), batch.columns, &self.translations.matrices[pose.matrix]);
        let mut from = vec![0.0; q * count];
        let mut columns = from.chunks_mut(q);
        for (pair, column) in batch.targets.iter().flat_map(|t| t.1).zip(&mut columns) {
            let width = self.frame.cell_width(self.sources.cells[pair.source as usize].level);
            let scale = K::value(0.25 * width * width, 0.5 * width);
            for ((n, sign), v) in self.translations.names(pair.pose).zip(&outer[pair.source as usize * q..]) {
                column[n] = sign * v * scale;
            }
        }
        let mut to = vec![0.0; q * count];
        for &(first, last, columns) in &self.translations.blocks {
            matmul(
                MatMut::from_column_major_slice_mut(&mut to, q, count).subrows_mut(first, last - first),
                Accum::Replace,
                MatRef::from_column_major_slice(matrix, q, q).submatrix(first, 0, last - first, columns),
                MatRef::from_column_major_slice(&from, q, count).subrows(0, columns),
                1.0,
                Par::Seq,
            );
        }
        let mut columns = to.chunks(q);
        for (expansion, pairs) in batch.targets {
            for (pair, column) in pairs.iter().zip(&mut columns) {
                for (t, (n, sign)) in expansion.iter_mut().zip(self.translations.names(pair.pose)) {
                    *t += sign * column[n];
                }
            }
        }
    }

    /// The nodes of a cell, as flat arrays.
    fn nodes(&self, tree: &Octree, cell: usize) -> [Vec<f64>; 3] {
        let cell = &tree.cells[cell];
        let places =
            self.translations.basis.places(self.frame.cell_centre(cell), 0.5 * self.frame.cell_width(cell.level));
        [0, 1, 2].map(|k| places.iter().map(|p| p[k]).collect())
    }

    /// Points of large leaves to the grids of small cells far from them.
    fn take_up<K: Radial>(&self, targets: &Octree, weights: &[f64], inner: &mut [f64]) {
        let q = self.translations.basis.len();
        for pairs in self.meetings.up.chunk_by(|a, b| a.0 == b.0) {
            let t = pairs[0].0 as usize;
            let at = self.nodes(targets, t);
            let mut values = vec![0.0; at[0].len()];
            for &(_, s) in pairs {
                let cell = &self.sources.cells[s as usize];
                self.add_run::<K>(&at, cell.start..cell.end, weights, &mut values);
            }
            self.translations.basis.analyse(values, &mut inner[t * q..][..q]);
        }
    }

    /// Adds the sum over a run of sorted sources at places given by flat arrays.
    fn add_run<K: Radial>(&self, at: &[Vec<f64>; 3], run: std::ops::Range<usize>, weights: &[f64], out: &mut [f64]) {
        let tree = &self.sources;
        add_all::<K>(at, [&tree.x[run.clone()], &tree.y[run.clone()], &tree.z[run.clone()]], &weights[run], out);
    }

    /// Values on every target cell's grid, from the root down.
    fn hand_down(&self, tree: &Octree, inner: &mut [f64]) {
        let q = self.translations.basis.len();
        let mut parent = vec![0; tree.cells.len()];
        for (c, cell) in tree.cells.iter().enumerate() {
            parent[cell.kids()].fill(c);
        }
        for (first, last) in levels(tree).into_iter().skip(1) {
            let (above, below) = inner.split_at_mut(first * q);
            below[..(last - first) * q].par_chunks_mut(q).enumerate().for_each(|(i, child)| {
                let kid = first + i;
                wide(
                    #[inline(always)]
                    || {
                        self.translations.basis.scatter(&above[parent[kid] * q..][..q], octant(tree, kid), child);
                    },
                );
            });
        }
    }

    /// All sums at the points of one leaf.
    fn leaf_sums<K: Radial>(
        &self,
        targets: &Octree,
        leaf: usize,
        weights: &[f64],
        outer: &[f64],
        inner: &[f64],
    ) -> Vec<f64> {
        let (basis, cell) = (&self.translations.basis, &targets.cells[leaf]);
        let q = basis.len();
        let values = &inner[leaf * q..][..q];
        let mut out = vec![0.0; cell.len()];
        wide(
            #[inline(always)]
            || {
                for (out, at) in out.iter_mut().zip(cell.start..) {
                    *out = basis.value(self.local(targets, leaf, at), values);
                }
            },
        );
        let at = [&targets.x, &targets.y, &targets.z].map(|a| a[cell.start..cell.end].to_vec());
        for &(_, s) in of(&self.meetings.near, leaf) {
            let source = &self.sources.cells[s as usize];
            self.add_run::<K>(&at, source.start..source.end, weights, &mut out);
        }
        for &(_, s) in of(&self.meetings.down, leaf) {
            let [x, y, z] = self.nodes(&self.sources, s as usize);
            let weights = basis.node_weights(&outer[s as usize * q..][..q]);
            add_all::<K>(&at, [&x, &y, &z], &weights, &mut out);
        }
        out
    }
}

fn add_all<K: Radial>(at: &[Vec<f64>; 3], centres: [&[f64]; 3], weights: &[f64], out: &mut [f64]) {
    wide(
        #[inline(always)]
        || {
            for (b, out) in out.chunks_mut(LANES).enumerate() {
                let block =
                    std::array::from_fn(|k| std::array::from_fn(|l| at[k].get(b * LANES + l).copied().unwrap_or(0.0)));
                let mut sum = [0.0; LANES];
                add_block::<K>(centres, weights, &block, &mut sum);
                out.iter_mut().zip(&sum).for_each(|(o, s)| *o += s);
            }
        },
    );
}

/// The pairs of one target in a sorted list.
fn of(pairs: &[(u32, u32)], target: usize) -> &[(u32, u32)] {
    let from = pairs.partition_point(|p| (p.0 as usize) < target);
    let to = pairs.partition_point(|p| (p.0 as usize) <= target);
    &pairs[from..to]
}

/// First and last cell of every level.
fn levels(tree: &Octree) -> Vec<(usize, usize)> {
    let mut at = 0;
    tree.cells
        .chunk_by(|a, b| a.level == b.level)
        .map(|run| {
            at += run.len();
            (at - run.len(), at)
        })
        .collect()
}

fn octant(tree: &Octree, cell: usize) -> [usize; 3] {
    (tree.cells[cell].index & 1).to_array().map(|v| v as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Kernel;
    use crate::sum::Sum;

    fn spiral(n: usize) -> Vec<DVec3> {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        (0..n)
            .map(|i| {
                let z = 1.0 - (2.0 * i as f64 + 1.0) / n as f64;
                let (s, c) = (golden * i as f64).sin_cos();
                let r = (1.0 - z * z).sqrt();
                // Crowded towards one end, so that leaves of very different sizes meet.
                DVec3::new(r * c, r * s, z) * (1.0 - z).powi(3) + DVec3::X * z
            })
            .collect()
    }

    /// The twin that adds everything directly.
    #[test]
    fn far_sums_are_the_direct_sums() {
        let (sources, targets) = (spiral(5000), spiral(3000).iter().map(|p| p * 0.9).collect::<Vec<_>>());
        let weights: Vec<f64> = (0..sources.len()).map(|i| ((i * 7919) % 13) as f64 - 6.0).collect();
        for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
            let mut before = f64::INFINITY;
            for order in [3, 5, 7] {
                let translations = Translations::new(kernel, order);
                for (plan, at) in [
                    (Plan::new(&translations, &sources, None), &sources),
                    (Plan::new(&translations, &sources, Some(&targets)), &targets),
                ] {
                    let mut direct = vec![0.0; at.len()];
                    let mut sum = Sum::new(&sources, 0);
                    sum.set_weights(&weights);
                    sum.values(kernel, at, &mut direct);
                    let scale = direct.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
                    let error =
                        plan.sums(&weights).iter().zip(&direct).fold(0.0, |a: f64, (f, d)| a.max((f - d).abs()))
                            / scale;
                    assert!(error < before, "{kernel:?} {order}: {error:e}");
                    if at.len() == targets.len() {
                        before = error / 10.0;
                    }
                }
            }
            assert!(before < 1e-6, "{before:e}");
        }
    }
}
