//! Merges vertices at the same place. Corner attributes stay as they are.

use crate::model::Model;
use glam::DVec3;
use mesh_core::{VertexId, VertexMap};
use rayon::prelude::*;

/// What a weld did.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    /// The new vertex of each old one.
    pub vertex_of: VertexMap<VertexId>,
    /// How many vertices went into others.
    pub merged: usize,
    /// How many faces were dropped because two of their corners became one.
    pub dropped: usize,
}

/// Merges vertices whose coordinates are equal (−0 equals 0). The first of each place stays, in order; faces that
/// lose a corner are dropped. O(n).
///
/// ```
/// use mesh_core::TriMesh;
/// let mut split = mesh_io::Model::from(TriMesh::from_arrays(
///     [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 0., 0.], [1., 1., 0.], [-0., 1., 0.]].map(Into::into).to_vec(),
///     [[0, 1, 2], [3, 4, 5]],
/// ));
/// assert_eq!(mesh_io::weld_exact(&mut split).merged, 2);
/// assert_eq!(split.mesh.positions.len(), 4);
/// ```
pub fn weld_exact(model: &mut Model) -> Welded {
    let vertex_of = same_places(&model.mesh.positions);
    apply(model, &vertex_of)
}

/// Merges each vertex into the first kept one within `tolerance` (model units) of it, in vertex order. Chains do not
/// creep: no vertex moves farther than `tolerance`. Faces that lose a corner are dropped. O(n) while few vertices
/// share a cell of that size. A tolerance that is not positive and finite welds exactly.
pub fn weld_within(model: &mut Model, tolerance: f64) -> Welded {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return weld_exact(model);
    }
    let vertex_of = near_places(&model.mesh.positions, tolerance);
    apply(model, &vertex_of)
}

/// The first vertex at each vertex's place.
///
/// Places are dealt out by their hash, so that each share is searched for itself, in parallel and within the cache.
pub(crate) fn same_places(positions: &[DVec3]) -> Vec<u32> {
    const SHARES: usize = 16;
    let key = |v: u32| (positions[v as usize] + 0.0).to_array().map(f64::to_bits); // −0 + 0 = 0
    let hashes: Vec<u64> = (0..positions.len() as u32).into_par_iter().map(|v| hash(key(v))).collect();
    // The low bits choose the slot.
    let share = |hash: u64| (hash >> 60) as usize % SHARES;
    let mut sizes = [0; SHARES];
    for &h in &hashes {
        sizes[share(h)] += 1;
    }
    let mut dealt: Vec<Vec<u32>> = sizes.iter().map(|&n| Vec::with_capacity(n)).collect();
    for (v, &h) in hashes.iter().enumerate() {
        dealt[share(h)].push(v as u32);
    }
    let search = |vertices: &Vec<u32>| {
        let mut table = Table::new(vertices.len());
        let first = |&v: &u32| table.first(hashes[v as usize], v, |other| key(other) == key(v));
        vertices.iter().map(first).collect()
    };
    let firsts: Vec<Vec<u32>> = dealt.par_iter().map(search).collect();
    let mut first_of = vec![0; positions.len()];
    for (v, first) in dealt.iter().flatten().zip(firsts.iter().flatten()) {
        first_of[*v as usize] = *first;
    }
    first_of
}

fn near_places(positions: &[DVec3], tolerance: f64) -> Vec<u32> {
    let cell = |p: DVec3| (p / tolerance).floor();
    let key = |c: DVec3| hash((c + 0.0).to_array().map(f64::to_bits));
    let mut cells = Table::new(positions.len());
    // Kept vertices of one cell form a list: the table holds its first, `next` the others.
    let mut next = vec![NONE; positions.len()];
    let mut last = vec![NONE; positions.len()];
    let mut vertex_of = Vec::with_capacity(positions.len());
    for v in 0..positions.len() as u32 {
        let p = positions[v as usize];
        let home = cell(p);
        let mut best = NONE;
        for i in 0..27 {
            let near = home + DVec3::new(f64::from(i % 3 - 1), f64::from(i / 3 % 3 - 1), f64::from(i / 9 - 1));
            let mut at = cells.find(key(near), |other| cell(positions[other as usize]) == near);
            while at != NONE && at < best {
                if positions[at as usize].distance(p) <= tolerance {
                    best = at;
                }
                at = next[at as usize];
            }
        }
        if best == NONE {
            best = v;
            let first = cells.first(key(home), v, |other| cell(positions[other as usize]) == home);
            if first != v {
                let tail = if last[first as usize] == NONE { first } else { last[first as usize] };
                next[tail as usize] = v;
                last[first as usize] = v;
            }
        }
        vertex_of.push(best);
    }
    vertex_of
}

/// Renumbers the kept vertices (those with `first[v] == v`) and the faces.
pub(crate) fn apply(model: &mut Model, first: &[u32]) -> Welded {
    let mut kept = 0u32;
    let mut vertex_of: Vec<VertexId> = Vec::with_capacity(first.len());
    for (v, &f) in first.iter().enumerate() {
        let id = if f as usize == v { kept } else { vertex_of[f as usize].0 };
        vertex_of.push(VertexId(id));
        if f as usize == v {
            model.mesh.positions[kept as usize] = model.mesh.positions[v];
            kept += 1;
        }
    }
    let merged = first.len() - kept as usize;
    if merged == 0 {
        return Welded { vertex_of: vertex_of.into(), merged, dropped: 0 };
    }
    model.mesh.positions.truncate(kept as usize);
    for v in model.mesh.faces.as_flattened_mut() {
        *v = vertex_of[v.index()];
    }
    if let Some(polygons) = &mut model.polygons {
        for v in &mut polygons.corners {
            *v = vertex_of[v.index()];
        }
    }
    let dropped = model.drop_degenerate_faces();
    Welded { vertex_of: vertex_of.into(), merged, dropped }
}

const NONE: u32 = u32::MAX;

/// An open-addressing table from places to the first vertex there.
struct Table {
    slots: Vec<u32>,
    mask: usize,
}

impl Table {
    fn new(count: usize) -> Self {
        let size = (2 * count).next_power_of_two().max(16);
        Self { slots: vec![NONE; size], mask: size - 1 }
    }

    fn slot(&self, hash: u64, same: impl Fn(u32) -> bool) -> usize {
        let mut at = hash as usize & self.mask;
        while self.slots[at] != NONE && !same(self.slots[at]) {
            at = (at + 1) & self.mask;
        }
        at
    }

    /// The vertex entered for this place before, or `NONE`.
    fn find(&self, hash: u64, same: impl Fn(u32) -> bool) -> u32 {
        self.slots[self.slot(hash, same)]
    }

    /// The vertex entered for this place before, or `v`, entered now.
    fn first(&mut self, hash: u64, v: u32, same: impl Fn(u32) -> bool) -> u32 {
        let at = self.slot(hash, same);
        if self.slots[at] == NONE {
            self.slots[at] = v;
        }
        self.slots[at]
    }
}

fn hash(key: [u64; 3]) -> u64 {
    // Multiply and fold high bits down, so that coordinates with few mantissa bits still spread over the low bits.
    let mix = |h: u64, x: u64| {
        let product = u128::from(h ^ x) * 0x9e37_79b9_7f4a_7c15;
        (product as u64) ^ ((product >> 64) as u64)
    };
    mix(mix(mix(0x243f_6a88_85a3_08d3, key[0]), key[1]), key[2])
}
