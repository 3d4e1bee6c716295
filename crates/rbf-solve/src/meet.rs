//! Which cells of two trees meet how.

use crate::octree::{Cell, Octree};
use glam::IVec3;

/// Pairs of (target cell, source cell), by how the one feels the other.
#[derive(Default)]
pub(crate) struct Meetings {
    /// Cells of one level, apart by at least one cell: grid to grid, with the source's offset in cells.
    pub(crate) far: Vec<(IVec3, u32, u32)>,
    /// Adjacent leaves: point to point.
    pub(crate) near: Vec<(u32, u32)>,
    /// A leaf and a smaller cell far from it: the source's grid to the target's points.
    pub(crate) down: Vec<(u32, u32)>,
    /// A small cell and a larger leaf far from it: the source's points to the target's grid.
    pub(crate) up: Vec<(u32, u32)>,
}

impl Meetings {
    /// Finds all pairs; `nodes` is what a grid costs, in points. O(cells).
    pub(crate) fn new(targets: &Octree, sources: &Octree, nodes: usize) -> Self {
        let mut out = Self::default();
        let mut pairs = vec![(0u32, 0u32)];
        while let Some((t, s)) = pairs.pop() {
            let (target, source) = (&targets.cells[t as usize], &sources.cells[s as usize]);
            if apart(target, source) {
                match target.level.cmp(&source.level) {
                    std::cmp::Ordering::Equal => {
                        out.far.push((source.index.as_ivec3() - target.index.as_ivec3(), t, s));
                    }
                    std::cmp::Ordering::Less if source.len() > nodes => out.down.push((t, s)),
                    std::cmp::Ordering::Greater if target.len() > nodes => out.up.push((t, s)),
                    _ => out.near_all(targets, t, s),
                }
            } else if target.is_leaf() && source.is_leaf() {
                out.near.push((t, s));
            } else {
                let split_target = !target.is_leaf() && (source.is_leaf() || target.level <= source.level);
                let split_source = !source.is_leaf() && (target.is_leaf() || source.level <= target.level);
                let ts = if split_target { target.kids() } else { t as usize..t as usize + 1 };
                for t in ts {
                    let ss = if split_source { source.kids() } else { s as usize..s as usize + 1 };
                    pairs.extend(ss.map(|s| (t as u32, s as u32)));
                }
            }
        }
        out.near.sort_unstable();
        out.down.sort_unstable();
        out.up.sort_unstable();
        out.far.sort_unstable_by_key(|f| (f.0.to_array(), f.1));
        out
    }

    /// Points of a whole source cell to points of all leaves of the target.
    fn near_all(&mut self, targets: &Octree, t: u32, s: u32) {
        let mut cells = vec![t];
        while let Some(t) = cells.pop() {
            let cell = &targets.cells[t as usize];
            if cell.is_leaf() {
                self.near.push((t, s));
            }
            cells.extend(cell.kids().map(|k| k as u32));
        }
    }
}

/// Whether the larger cell lies outside the three cells' width around the smaller one.
fn apart(a: &Cell, b: &Cell) -> bool {
    let level = a.level.max(b.level);
    let span = |c: &Cell| {
        let shift = level - c.level;
        let low = c.index.as_i64vec3() * (1i64 << shift);
        (low, low + ((1i64 << shift) - 1))
    };
    let ((al, ah), (bl, bh)) = (span(a), span(b));
    (al - bh).max(bl - ah).max_element() >= 2
}
