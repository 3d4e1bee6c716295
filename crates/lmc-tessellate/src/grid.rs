//! A sparse grid of cubic cells, explored along a zero set.

use crate::cell::signs;
use crate::error::Error;
use glam::{DVec3, IVec3};
use mesh_core::{Bounds, Watch};
use rustc_hash::{FxHashMap, FxHashSet};

/// A scalar field, sampled at many points at once: `field(points, values)` fills `values`, negative inside.
pub trait Field: Sync {
    /// Fills one value per point.
    fn values(&self, points: &[DVec3], values: &mut [f64]);
}

impl<F: Fn(&[DVec3], &mut [f64]) + Sync> Field for F {
    fn values(&self, points: &[DVec3], values: &mut [f64]) {
        self(points, values);
    }
}

/// Where cells are. Cell `k` is the cube from `origin + k·size` to `origin + (k + 1)·size`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub origin: DVec3,
    pub size: f64,
}

impl Grid {
    pub fn cell_at(&self, p: DVec3) -> IVec3 {
        ((p - self.origin) / self.size).floor().as_ivec3()
    }
    pub fn node(&self, k: IVec3) -> DVec3 {
        self.origin + k.as_dvec3() * self.size
    }
    pub fn center(&self, k: IVec3) -> DVec3 {
        self.origin + (k.as_dvec3() + 0.5) * self.size
    }
}

/// The corner of a cell by its bits.
pub(crate) fn corner(k: IVec3, c: usize) -> IVec3 {
    k + IVec3::from([0, 1, 2].map(|bit| i32::from(c >> bit & 1 == 1)))
}

/// Integer coordinates in 21 bits each.
pub(crate) fn key(k: IVec3) -> u64 {
    let bits = |x: i32| u64::from((x + (1 << 20)) as u32) & 0x1f_ffff;
    bits(k.x) | bits(k.y) << 21 | bits(k.z) << 42
}

/// A hash map from packed keys. Looked up only, never iterated.
pub(crate) type KeyMap<T> = FxHashMap<u64, T>;

/// A set of packed keys.
pub(crate) type KeySet = FxHashSet<u64>;

/// The cells that a zero set passes through, and the field at their corners.
#[derive(Default)]
pub(crate) struct Surface {
    /// Every node visited, and the field there.
    pub nodes: Vec<IVec3>,
    pub values: Vec<f64>,
    /// The corners of each cell with both signs, in the order of discovery.
    pub cells: Vec<[u32; 8]>,
}

/// How far to explore.
pub(crate) struct Limits {
    pub space: Bounds,
    pub cells: usize,
}

/// Explores the cells that the zero set passes through, from `seeds` through faces with both signs, breadth first.
/// Cells for which `enter` is false are walls.
pub(crate) fn follow(
    field: &impl Field,
    grid: &Grid,
    seeds: &[IVec3],
    enter: impl Fn(IVec3) -> bool,
    limits: &Limits,
    watch: &Watch,
) -> Result<Surface, Error> {
    let mut found = Surface::default();
    let mut node_ids: KeyMap<u32> = KeyMap::default();
    let mut seen: KeySet = KeySet::default();
    let mut front: Vec<IVec3> = seeds.iter().copied().filter(|&k| seen.insert(key(k))).collect();
    let mut corners: Vec<[u32; 8]> = vec![];
    let mut points: Vec<DVec3> = vec![];
    let mut wave = 0u32;
    while !front.is_empty() {
        watch.step("follow the surface", 1.0 - 1.0 / f64::from(1 + wave))?;
        wave += 1;
        corners.clear();
        points.clear();
        for &k in &front {
            corners.push(std::array::from_fn(|c| {
                let n = corner(k, c);
                *node_ids.entry(key(n)).or_insert_with(|| {
                    found.nodes.push(n);
                    points.push(grid.node(n));
                    (found.nodes.len() - 1) as u32
                })
            }));
        }
        let known = found.values.len();
        found.values.resize(known + points.len(), 0.0);
        field.values(&points, &mut found.values[known..]);
        if let Some(i) = found.values[known..].iter().position(|v| v.is_nan()) {
            return Err(Error::NotANumber { at: points[i] });
        }
        let mut next = vec![];
        for (&k, c) in front.iter().zip(&corners) {
            let mask = signs(&c.map(|n| found.values[n as usize]));
            if mask == 0 || mask == 255 {
                continue;
            }
            found.cells.push(*c);
            if !limits.space.overlaps(&Bounds::of([grid.center(k)])) {
                return Err(Error::Unbounded { at: grid.center(k) });
            }
            for (axis, low_side) in [0b0101_0101, 0b0011_0011, 0b0000_1111].into_iter().enumerate() {
                for (side, step) in [(low_side, -1), (!low_side, 1)] {
                    let mut beside = k;
                    beside[axis] += step;
                    if mask & side != 0 && mask & side != side && enter(beside) && seen.insert(key(beside)) {
                        next.push(beside);
                    }
                }
            }
        }
        if found.cells.len() > limits.cells {
            let at = front.first().map_or(grid.origin, |&k| grid.center(k));
            return Err(Error::TooLarge { cells: limits.cells, at });
        }
        front = next;
    }
    Ok(found)
}
