//! Points in cubic cells: who is near.

use glam::{DVec3, I64Vec3};
use std::collections::HashMap;

/// Points filed by cubic cell. Cells are only looked up, never iterated, so that no order depends on hashing.
pub(crate) struct Cells {
    size: f64,
    filed: HashMap<I64Vec3, Vec<u32>>,
}

impl Cells {
    /// No points yet. A search is fastest for radii somewhat under `size`.
    pub(crate) fn new(size: f64) -> Self {
        Self { size, filed: HashMap::new() }
    }

    fn key(&self, p: DVec3) -> I64Vec3 {
        (p / self.size).floor().as_i64vec3()
    }

    pub(crate) fn insert(&mut self, index: usize, p: DVec3) {
        self.filed.entry(self.key(p)).or_default().push(index as u32);
    }

    /// The filed points of every cell that meets the box of half-width `radius` around `p`, in a fixed order.
    pub(crate) fn around(&self, p: DVec3, radius: f64) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (self.key(p - radius), self.key(p + radius));
        let cells = (low.x..=high.x).flat_map(move |x| {
            (low.y..=high.y).flat_map(move |y| (low.z..=high.z).map(move |z| I64Vec3::new(x, y, z)))
        });
        cells.filter_map(|key| self.filed.get(&key)).flatten().map(|&i| i as usize)
    }
}
