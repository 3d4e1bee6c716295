//! Points sorted into cubes of halving width.

use glam::{DVec3, UVec3};
use rayon::prelude::*;

/// Halvings that a 63-bit key can tell apart.
const DEEPEST: u32 = 20;

/// A cube, and the run of sorted points in it.
pub(crate) struct Cell {
    pub(crate) level: u32,
    /// Which cube of its level, counted along the axes.
    pub(crate) index: UVec3,
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// First child and how many there are; none in a leaf.
    pub(crate) children: (u32, u32),
}

impl Cell {
    pub(crate) fn is_leaf(&self) -> bool {
        self.children.1 == 0
    }

    pub(crate) fn len(&self) -> usize {
        self.end - self.start
    }

    pub(crate) fn kids(&self) -> std::ops::Range<usize> {
        self.children.0 as usize..(self.children.0 + self.children.1) as usize
    }
}

/// The cube that everything lies in.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) low: DVec3,
    pub(crate) width: f64,
}

impl Frame {
    /// A cube around points, with a little room so that rounding leaves none outside.
    pub(crate) fn around<'a>(points: impl Iterator<Item = &'a DVec3>) -> Self {
        let (low, high) = points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
        let width = (high - low).max_element() * 1.001;
        Self { low: low.midpoint(high) - 0.5 * width, width: if width > 0.0 { width } else { 1.0 } }
    }

    pub(crate) fn cell_width(&self, level: u32) -> f64 {
        self.width / f64::from(1u32 << level)
    }

    pub(crate) fn cell_centre(&self, cell: &Cell) -> DVec3 {
        self.low + (cell.index.as_dvec3() + 0.5) * self.cell_width(cell.level)
    }
}

/// Cells by level, coarse first; siblings are neighbours in the list.
pub(crate) struct Octree {
    pub(crate) cells: Vec<Cell>,
    /// Which point stands at each sorted place.
    pub(crate) order: Vec<u32>,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

impl Octree {
    /// Sorts points and splits cells until they hold `most` points at most. O(n log n).
    pub(crate) fn new(points: &[DVec3], frame: &Frame, most: usize) -> Self {
        let scale = f64::from(1u32 << DEEPEST) / frame.width;
        let top = f64::from((1u32 << DEEPEST) - 1);
        let key = |p: DVec3| {
            let q = ((p - frame.low) * scale).clamp(DVec3::ZERO, DVec3::splat(top)).as_uvec3();
            spread(q.x) << 2 | spread(q.y) << 1 | spread(q.z)
        };
        let mut keyed: Vec<(u64, u32)> = points.par_iter().enumerate().map(|(i, &p)| (key(p), i as u32)).collect();
        keyed.par_sort_unstable();
        let mut cells = vec![Cell { level: 0, index: UVec3::ZERO, start: 0, end: points.len(), children: (0, 0) }];
        let mut at = 0;
        while at < cells.len() {
            let Cell { level, index, start, end, .. } = cells[at];
            if end - start > most && level < DEEPEST {
                let shift = 3 * (DEEPEST - level - 1);
                let first = cells.len();
                let mut from = start;
                while from < end {
                    let octant = keyed[from].0 >> shift & 7;
                    let to = from + keyed[from..end].partition_point(|k| k.0 >> shift & 7 == octant);
                    let step = UVec3::new((octant >> 2) as u32, (octant >> 1 & 1) as u32, (octant & 1) as u32);
                    cells.push(Cell {
                        level: level + 1,
                        index: 2 * index + step,
                        start: from,
                        end: to,
                        children: (0, 0),
                    });
                    from = to;
                }
                cells[at].children = (first as u32, (cells.len() - first) as u32);
            }
            at += 1;
        }
        let axis = |k: usize| keyed.iter().map(|&(_, i)| points[i as usize][k]).collect();
        Self { cells, x: axis(0), y: axis(1), z: axis(2), order: keyed.iter().map(|k| k.1).collect() }
    }

    pub(crate) fn place(&self, at: usize) -> DVec3 {
        DVec3::new(self.x[at], self.y[at], self.z[at])
    }
}

/// Puts two zero bits between the bits of a number below 2²¹.
fn spread(v: u32) -> u64 {
    let mut v = u64::from(v);
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        v = (v | v << shift) & mask;
    }
    v
}
