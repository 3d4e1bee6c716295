//! Symmetric systems over all vertices, some of which are held at their values.

use crate::cholesky::Cholesky;
use crate::error::NotPositiveDefinite;
use crate::sparse::{LowerTriangle, SparseRows};
use crate::unknowns::Unknowns;
use glam::DVec3;
use rayon::prelude::*;

/// Rows per parallel task.
const CHUNK: usize = 512;

/// A symmetric operator on a vector of points, positive definite on the free ones, prepared to find them for many held values and
/// right-hand sides.
#[derive(Debug)]
pub struct HeldSystem {
    unknowns: Unknowns,
    rows: SparseRows,
    factor: Option<Cholesky>,
}

impl HeldSystem {
    /// Factorises the operator, whose `row` pushes pairs of a column and a value in any order; it is asked for free entries only.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] with the entry of the vector as its unknown.
    pub fn new(
        unknowns: Unknowns,
        row: impl Fn(u32, &mut Vec<(u32, f64)>) + Sync,
    ) -> Result<Self, NotPositiveDefinite> {
        Self::prepare(unknowns, row, None)
    }

    /// Factorises an operator with entries at the same places as this one's, in the same elimination order.
    ///
    /// # Errors
    /// As [`HeldSystem::new`].
    pub fn renew(self, row: impl Fn(u32, &mut Vec<(u32, f64)>) + Sync) -> Result<Self, NotPositiveDefinite> {
        Self::prepare(self.unknowns, row, self.factor)
    }

    fn prepare(
        unknowns: Unknowns,
        row: impl Fn(u32, &mut Vec<(u32, f64)>) + Sync,
        like: Option<Cholesky>,
    ) -> Result<Self, NotPositiveDefinite> {
        let rows = SparseRows::gather(unknowns.free(), row);
        if let Some(unknown) = loose(&rows, &unknowns) {
            return Err(NotPositiveDefinite { unknown });
        }
        let mut lower = LowerTriangle::default();
        let mut column = vec![];
        for i in 0..rows.len() {
            column.clear();
            // Free entries ascend, so columns ascend among them too.
            let numbered = rows.row(i).filter_map(|(c, x)| Some((unknowns.number(c as usize)?, x)));
            column.extend(numbered.filter(|&(c, _)| c as usize >= i));
            lower.column(&column);
        }
        let factor = match like {
            _ if lower.is_empty() => None,
            Some(like) => Some(like.refactor(&lower)),
            None => Some(Cholesky::new(&lower)),
        };
        let entry = |e: NotPositiveDefinite| NotPositiveDefinite { unknown: unknowns.free()[e.unknown] as usize };
        let factor = factor.transpose().map_err(entry)?;
        Ok(Self { unknowns, rows, factor })
    }

    /// The free entries.
    pub fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// Moves the free points so that the operator gives `right` there, one for each free entry and zero where missing; the others stay. Of
    /// the `steps`, those after the first remove what rounding left.
    pub fn solve(&self, points: &mut [DVec3], right: &[DVec3], steps: usize) {
        let Some(factor) = &self.factor else { return };
        for _ in 0..steps {
            let moves = factor.solve_points(&self.residual(points, right));
            for (&v, step) in self.unknowns.free().iter().zip(moves) {
                points[v as usize] += step;
            }
        }
    }

    /// `right` minus the operator at `points`, at each free entry.
    fn residual(&self, points: &[DVec3], right: &[DVec3]) -> Vec<DVec3> {
        let right = |i: usize| right.get(i).copied().unwrap_or_default();
        let at = |i: usize| self.rows.row(i).fold(right(i), |r, (c, x)| r - x * points[c as usize]);
        (0..self.rows.len()).into_par_iter().with_min_len(CHUNK).map(at).collect()
    }
}

/// The sum of a row that counts as zero, as a share of its entries' sizes.
const NOTHING: f64 = 1e-12;

/// The first entry of a connected piece on which the operator gives nothing for a constant. Rounding may leave such a system positive
/// pivots, and so a factor whose solutions mean nothing. O(n) in the entries of the rows.
fn loose(rows: &SparseRows, unknowns: &Unknowns) -> Option<usize> {
    let free = |i: usize| rows.row(i).filter_map(|(c, x)| Some((unknowns.number(c as usize)? as usize, x)));
    let holds = |i: usize| {
        let (sum, size) = free(i).fold((0.0, 0.0), |(sum, size), (_, x)| (sum + x, size + x.abs()));
        sum.abs() > NOTHING * size
    };
    let mut seen = vec![false; rows.len()];
    for first in 0..rows.len() {
        let (mut stack, mut held) = (vec![first], std::mem::replace(&mut seen[first], true));
        while let Some(i) = stack.pop() {
            held = held || holds(i);
            for (next, _) in free(i) {
                if !std::mem::replace(&mut seen[next], true) {
                    stack.push(next);
                }
            }
        }
        if !held {
            return Some(unknowns.free()[first] as usize);
        }
    }
    None
}
