//! Wanted edge lengths that join boundaries of different fineness.

use crate::Error;
use mesh_core::{Adjacency, Positions, VertexId, VertexMap};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// One wanted edge length per vertex: at the boundary the mean of the boundary edges there, and from it towards
/// `edge_length` inside, changing by at most `slope` per unit of length.
///
/// A fine boundary spreads its fineness inward, a coarse one its coarseness; where both reach, the finer wins. 0.2 to
/// 0.4 is a good slope: larger ones leave flatter triangles where sizes change. Distances are along edges.
/// O(n log n).
///
/// # Errors
/// [`Error::NotPositive`] for the edge length or the slope.
pub fn graded_sizes<M: Adjacency + Positions>(mesh: &M, edge_length: f64, slope: f64) -> Result<VertexMap<f64>, Error> {
    for (name, value) in [("edge length", edge_length), ("slope", slope)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::NotPositive { name, value });
        }
    }
    let rims: Vec<(VertexId, f64)> = mesh.vertex_ids().filter_map(|v| Some((v, rim_length(mesh, v)?))).collect();
    // Coarse boundaries first: they lift what is around them, and nothing that a fine one will lower again matters.
    let mut sizes = spread(mesh, rims.iter().map(|&(v, s)| (v, -s)), slope);
    for size in sizes.as_mut_slice() {
        *size = if size.is_finite() { (-*size).max(edge_length) } else { edge_length };
    }
    let fine = spread(mesh, rims.iter().copied(), slope);
    for (size, fine) in sizes.as_mut_slice().iter_mut().zip(fine.as_slice()) {
        *size = size.min(*fine);
    }
    Ok(sizes)
}

/// The mean length of the boundary edges at `v`.
fn rim_length<M: Adjacency + Positions>(mesh: &M, v: VertexId) -> Option<f64> {
    let out = mesh.outgoing(v).filter(|&h| mesh.twin(h).is_none())?;
    let last = mesh.ring(v).last()?;
    let (a, b) = (mesh.position(mesh.head(out)), mesh.position(mesh.tail(last.prev())));
    let p = mesh.position(v);
    Some(0.5 * (p.distance(a) + p.distance(b)))
}

/// The least, over all sources, of its value plus `slope` times the distance to it; infinite where none reaches.
fn spread<M: Adjacency + Positions>(
    mesh: &M,
    sources: impl Iterator<Item = (VertexId, f64)>,
    slope: f64,
) -> VertexMap<f64> {
    let mut values = VertexMap::filled(mesh.vertex_count(), f64::INFINITY);
    let mut queue = BinaryHeap::new();
    for (v, value) in sources.filter(|s| s.1.is_finite()) {
        values[v] = value;
        queue.push(Reverse((Ordered(value), v)));
    }
    while let Some(Reverse((Ordered(value), v))) = queue.pop() {
        if value > values[v] {
            continue;
        }
        for h in mesh.ring(v) {
            for n in [mesh.head(h), mesh.tail(h.prev())] {
                let there = value + slope * mesh.position(v).distance(mesh.position(n));
                if there < values[n] {
                    values[n] = there;
                    queue.push(Reverse((Ordered(there), n)));
                }
            }
        }
    }
    values
}

#[derive(PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
