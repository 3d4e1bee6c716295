//! Leaves: neighbouring triangles along a space-filling curve, a few to a leaf.
//!
//! The builder (PLOC, \[MeisterBittner2018\]) then has a third of the nodes to join, which halves its time.

use obvhs::Boundable;
use obvhs::aabb::Aabb;
use obvhs::ploc::morton::split_by_3_u64;
use rayon::prelude::*;
use std::ops::Range;

/// Faces per parallel task; a constant, so that nothing depends on the number of threads.
pub(crate) const CHUNK: usize = 1 << 12;

/// Most triangles to a leaf. Measured on spheres of 82k to 1.3M triangles: four to a leaf build in half the time of
/// single ones (102 ms against 263 ms for 1.3M, two cores) and answer pairs and closest points no slower; eight bring
/// nothing more.
const LEAF: u32 = 4;

/// A leaf may be wider than its triangles' boxes laid side by side by this factor, not more.
const LOOSENESS: f32 = 1.5;

/// Bits of the Morton code of one axis; three times this and 31 bits of index fill a word.
const BITS: u32 = 11;

/// Positions 0..count, each with the Morton code of its box centre in [−1, 1]³ above it, in order of both.
pub(crate) fn along_morton_curve(count: usize, box_at: impl Fn(usize) -> Aabb + Sync) -> Vec<u64> {
    let keys = (0..count)
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|i| {
            let cell = ((box_at(i).center() + 1.0) * ((1 << (BITS - 1)) as f32)).as_uvec3();
            let [x, y, z] = cell.to_array().map(|c| split_by_3_u64(c.min((1 << BITS) - 1)));
            (x | y << 1 | z << 2) << 31 | i as u64
        })
        .collect();
    sort_by_code(keys)
}

/// The position in a key of [`along_morton_curve`].
pub(crate) fn index_of(key: u64) -> usize {
    (key & ((1 << 31) - 1)) as usize
}

/// Least-significant-digit radix sort on the code; stable, so positions stay in order within a cell.
fn sort_by_code(mut keys: Vec<u64>) -> Vec<u64> {
    let mut sorted = vec![0; keys.len()];
    for pass in 0..3 {
        let digit = |key: u64| (key >> (31 + pass * BITS)) as usize & ((1 << BITS) - 1);
        let mut next = vec![0u32; 1 << BITS];
        for &key in &keys {
            next[digit(key)] += 1;
        }
        let mut start = 0;
        for n in &mut next {
            start += std::mem::replace(n, start);
        }
        for &key in &keys {
            let slot = &mut next[digit(key)];
            sorted[*slot as usize] = key;
            *slot += 1;
        }
        std::mem::swap(&mut keys, &mut sorted);
    }
    keys
}

/// A few neighbouring triangles: their box and their range along the curve.
#[derive(Clone, Copy)]
pub(crate) struct Leaf {
    pub(crate) bounds: Aabb,
    pub(crate) first: u32,
    pub(crate) count: u32,
}

impl Boundable for Leaf {
    fn aabb(&self) -> Aabb {
        self.bounds
    }
}

/// Cuts the curve into leaves. Chunks are cut apart, so their size must not depend on the number of threads.
pub(crate) fn leaves(count: usize, box_at: impl Fn(usize) -> Aabb + Sync) -> Vec<Leaf> {
    let chunks: Vec<Vec<Leaf>> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| leaves_of_run(chunk * CHUNK..count.min((chunk + 1) * CHUNK), &box_at))
        .collect();
    chunks.concat()
}

fn leaves_of_run(run: Range<usize>, box_at: impl Fn(usize) -> Aabb) -> Vec<Leaf> {
    let mut leaves: Vec<Leaf> = Vec::with_capacity(run.len() / 2);
    let mut area = 0.0;
    for i in run {
        let next = box_at(i);
        if let Some(leaf) = leaves.last_mut()
            && leaf.count < LEAF
        {
            let joined = leaf.bounds.union(&next);
            if joined.half_area() <= LOOSENESS * (area + next.half_area()) {
                leaf.bounds = joined;
                leaf.count += 1;
                area += next.half_area();
                continue;
            }
        }
        leaves.push(Leaf { bounds: next, first: i as u32, count: 1 });
        area = next.half_area();
    }
    leaves
}
