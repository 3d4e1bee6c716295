//! Which vertices of a boundary become one.

use crate::sides::{Side, edge};
use glam::DVec3;
use mesh_core::{TriMesh, VertexId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Vertices that are looked at around one, at most: a gap wider than the triangles would compare all with all.
const MOST: usize = 256;

/// For every vertex the one that it becomes: of two boundary vertices no farther apart than `gap` the lower one, nearest pairs first.
/// Ends of one edge stay two, so that no face shrinks to a line. O(n) while few vertices share a cube of that size.
pub(crate) fn joined(mesh: &TriMesh, sides: &[Side], boundary: &[Side], gap: f64) -> Vec<VertexId> {
    let mut vertices: Vec<VertexId> = boundary.iter().flat_map(|s| s.0).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut pairs = near_pairs(mesh, &vertices, gap);
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let on_boundary: FxHashSet<VertexId> = vertices.iter().copied().collect();
    let edges: FxHashSet<[VertexId; 2]> =
        sides.iter().map(|s| s.0).filter(|e| e.iter().all(|v| on_boundary.contains(v))).collect();
    let mut name: FxHashMap<VertexId, VertexId> = FxHashMap::default();
    let mut members: FxHashMap<VertexId, Vec<VertexId>> = vertices.iter().map(|&v| (v, vec![v])).collect();
    for (_, a, b) in pairs {
        let [a, b] = [a, b].map(|v| name.get(&v).copied().unwrap_or(v));
        let (low, high) = (a.min(b), a.max(b));
        let apart = |x: &VertexId, y: &VertexId| edges.contains(&edge(*x, *y));
        let (Some(one), Some(other)) = (members.get(&low), members.get(&high)) else { continue };
        // Chains must not creep: all of a class are near its first.
        let near = |v: &VertexId| mesh.positions[v.index()].distance(mesh.positions[low.index()]) <= gap;
        if low == high || one.iter().any(|x| other.iter().any(|y| apart(x, y))) || !other.iter().all(near) {
            continue;
        }
        let moved = members.remove(&high).unwrap_or_default();
        name.extend(moved.iter().map(|&v| (v, low)));
        members.entry(low).or_default().extend(moved);
    }
    let all = 0..mesh.positions.len() as u32;
    all.map(VertexId).map(|v| name.get(&v).copied().unwrap_or(v)).collect()
}

fn near_pairs(mesh: &TriMesh, vertices: &[VertexId], gap: f64) -> Vec<(f64, VertexId, VertexId)> {
    // Equal places are in equal cells, whatever the gap.
    let cell = |p: DVec3| {
        if gap > 0.0 {
            (p / gap).floor().to_array().map(|x| (x + 0.0).to_bits())
        } else {
            p.to_array().map(|x| (x + 0.0).to_bits())
        }
    };
    let mut cells: FxHashMap<[u64; 3], Vec<VertexId>> = FxHashMap::default();
    let mut pairs = vec![];
    for &v in vertices {
        let p = mesh.positions[v.index()];
        let mut looked = 0;
        for i in 0..27 {
            let step = DVec3::new(f64::from(i % 3 - 1), f64::from(i / 3 % 3 - 1), f64::from(i / 9 - 1));
            if gap == 0.0 && i != 13 {
                continue;
            }
            let near = (p / gap).floor() + step;
            let key = if gap > 0.0 { near.to_array().map(|x| (x + 0.0).to_bits()) } else { cell(p) };
            for &other in cells.get(&key).into_iter().flatten() {
                looked += 1;
                let distance = mesh.positions[other.index()].distance(p);
                if distance <= gap && looked <= MOST {
                    pairs.push((distance, other, v));
                }
            }
        }
        cells.entry(cell(p)).or_default().push(v);
    }
    pairs
}
