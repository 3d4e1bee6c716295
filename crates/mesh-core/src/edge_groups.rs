//! Halfedges grouped by undirected edge, in parallel: the counting sort under the corner table and the validator.

use crate::ids::{HalfedgeId, VertexId};
use crate::traits::Faces;
use rayon::prelude::*;

/// Below this many faces one thread is faster than several.
const SMALL: usize = 20_000;
/// Every task reads all faces, so more tasks than this only add reading.
const MAX_TASKS: usize = 16;

/// All halfedges of one undirected edge, in ascending order.
#[derive(Clone, Copy)]
pub(crate) struct EdgeGroup<'a> {
    /// End points (low, high).
    pub ends: [VertexId; 2],
    packed: &'a [u64],
}

impl EdgeGroup<'_> {
    pub fn len(&self) -> usize {
        self.packed.len()
    }

    pub fn halfedge(&self, i: usize) -> HalfedgeId {
        HalfedgeId(self.packed[i] as u32)
    }
}

/// The end that files an edge. Taking now the lower, now the higher id spreads edges evenly over the id range.
fn home(a: u32, b: u32) -> u32 {
    if (a ^ b) & 1 == 0 { a.min(b) } else { a.max(b) }
}

/// Size of the vertex ranges that tasks own; depends on the thread count, so callers must not let it show.
pub(crate) fn range_len<M: Faces>(mesh: &M) -> usize {
    let tasks = if mesh.face_count() < SMALL { 1 } else { rayon::current_num_threads().clamp(1, MAX_TASKS) };
    mesh.vertex_count().div_ceil(tasks).max(1)
}

/// Calls `visit` once for every undirected edge of the faces that `uses` admits, and returns the tasks' accumulators.
///
/// Which edges share an accumulator, and their order, depend on the thread count: sort what is gathered.
/// Admitted faces must have corners in range, no two alike. O(n) time, 8 bytes per halfedge.
pub(crate) fn visit_edges<M, A>(
    mesh: &M,
    uses: impl Fn([VertexId; 3]) -> bool + Sync,
    visit: impl Fn(&mut A, EdgeGroup<'_>) + Sync,
) -> Vec<A>
where
    M: Faces + Sync,
    A: Default + Send,
{
    let range = range_len(mesh);
    (0..mesh.vertex_count().div_ceil(range))
        .into_par_iter()
        .map(|task| {
            let low = (task * range) as u32;
            let size = range.min(mesh.vertex_count() - task * range);
            let (starts, mut entries) = file_edges(mesh, low, size, &uses);
            let mut accumulator = A::default();
            for slot in 0..size {
                let bucket = &mut entries[starts[slot] as usize..starts[slot + 1] as usize];
                bucket.sort_unstable();
                let here = low + slot as u32;
                for packed in bucket.chunk_by(|a, b| a >> 32 == b >> 32) {
                    let other = (packed[0] >> 32) as u32;
                    let ends = [VertexId(here.min(other)), VertexId(here.max(other))];
                    visit(&mut accumulator, EdgeGroup { ends, packed });
                }
            }
            accumulator
        })
        .collect()
}

/// Buckets of `other end << 32 | halfedge` for the home vertices `low .. low + size`.
fn file_edges<M: Faces>(
    mesh: &M,
    low: u32,
    size: usize,
    uses: &impl Fn([VertexId; 3]) -> bool,
) -> (Vec<u32>, Vec<u64>) {
    let mut starts = vec![0u32; size + 1];
    each_at_home(mesh, low, size, uses, |slot, _, _| starts[slot + 1] += 1);
    for i in 0..size {
        starts[i + 1] += starts[i];
    }
    let mut entries = vec![0u64; starts[size] as usize];
    let mut next = starts.clone();
    each_at_home(mesh, low, size, uses, |slot, other, h| {
        entries[next[slot] as usize] = u64::from(other) << 32 | u64::from(h);
        next[slot] += 1;
    });
    (starts, entries)
}

#[inline]
fn each_at_home<M: Faces>(
    mesh: &M,
    low: u32,
    size: usize,
    uses: &impl Fn([VertexId; 3]) -> bool,
    mut put: impl FnMut(usize, u32, u32),
) {
    for f in mesh.face_ids() {
        let c = mesh.corners(f);
        if uses(c) {
            for k in 0..3 {
                let (a, b) = (c[k].0, c[(k + 1) % 3].0);
                let home = home(a, b);
                let slot = home.wrapping_sub(low) as usize;
                if slot < size {
                    put(slot, a ^ b ^ home, HalfedgeId::new(f, k).0);
                }
            }
        }
    }
}
