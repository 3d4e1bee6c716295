//! Triangles that meet a box, and pairs of triangles whose boxes meet.
//!
//! Boxes of the tree are compared in model coordinates. Rounding is monotone and a box of the tree contains its
//! triangles before rounding, so it contains them after; the last word is the exact box of each triangle.

use crate::build::TriBvh;
use glam::DVec3;
use mesh_core::{Bounds, FaceId, Faces, Positions};
use obvhs::bvh2::node::Bvh2Node;
use rayon::prelude::*;

/// How many node pairs the parallel traversal is split into, at least. A constant: the split must not depend on the
/// number of threads, and each part is still large where time matters.
const TASKS: usize = 256;

impl TriBvh {
    /// Collects into `out` (cleared first) the faces whose own box shares a point with `bounds`, in order of id.
    pub fn faces_in_box<M: Faces + Positions>(&self, mesh: &M, bounds: &Bounds, out: &mut Vec<FaceId>) {
        out.clear();
        self.visit_box(mesh, bounds, |f| out.push(f));
        out.sort_unstable();
    }

    /// Hands every such face to `visit`, in no particular order.
    pub fn visit_box<M: Faces + Positions>(&self, mesh: &M, bounds: &Bounds, mut visit: impl FnMut(FaceId)) {
        if self.nodes.is_empty() || bounds.is_empty() {
            return;
        }
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !self.node_bounds(node).overlaps(bounds) {
                continue;
            }
            if node.is_leaf() {
                self.leaf(node).iter().filter(|&&f| triangle_bounds(mesh, f).overlaps(bounds)).for_each(|&f| visit(f));
            } else {
                stack.extend([node.first_index, node.first_index + 1]);
            }
        }
    }

    /// The pairs (face of `a`, face of `b`) whose boxes share a point (touching counts), in order. `self` is the tree
    /// of `a`, `other` that of `b`. Runs in parallel; O(pairs + log n) for seams that are small beside the meshes.
    pub fn overlapping_pairs<MA, MB>(&self, a: &MA, other: &TriBvh, b: &MB) -> Vec<[FaceId; 2]>
    where
        MA: Faces + Positions + Sync,
        MB: Faces + Positions + Sync,
    {
        if self.nodes.is_empty() || other.nodes.is_empty() {
            return Vec::new();
        }
        let crossing = Crossing { left: self, right: other, a, b, keep: |_, _| true };
        crossing.pairs(vec![(0, 0)])
    }

    /// The pairs f < g of faces whose boxes share a point, in order. Neighbours, whose boxes always do, are included.
    pub fn self_overlapping_pairs<M: Faces + Positions + Sync>(&self, mesh: &M) -> Vec<[FaceId; 2]> {
        // Every pair of faces parts at exactly one inner node, or shares a leaf.
        let starts = (0..self.nodes.len() as u32)
            .filter_map(|i| {
                let node = &self.nodes[i as usize];
                if !node.is_leaf() {
                    Some((node.first_index, node.first_index + 1))
                } else if node.prim_count > 1 {
                    Some((i, i))
                } else {
                    None
                }
            })
            .collect();
        let crossing = Crossing { left: self, right: self, a: mesh, b: mesh, keep: |f, g| f != g };
        let mut pairs = crossing.pairs(starts);
        pairs.par_iter_mut().for_each(|pair| pair.sort_unstable());
        pairs.par_sort_unstable();
        pairs.dedup();
        pairs
    }

    /// The box of a node in model coordinates, rounded.
    #[inline]
    fn node_bounds(&self, node: &Bvh2Node) -> Bounds {
        let aabb = node.aabb();
        let unit = self.frame.scale.recip();
        Bounds {
            min: aabb.min.as_dvec3() * unit + self.frame.center,
            max: aabb.max.as_dvec3() * unit + self.frame.center,
        }
    }
}

/// Two trees walked against each other.
struct Crossing<'a, MA, MB, K> {
    left: &'a TriBvh,
    right: &'a TriBvh,
    a: &'a MA,
    b: &'a MB,
    keep: K,
}

impl<MA, MB, K> Crossing<'_, MA, MB, K>
where
    MA: Faces + Positions + Sync,
    MB: Faces + Positions + Sync,
    K: Fn(FaceId, FaceId) -> bool + Sync,
{
    /// Every kept pair below the given node pairs, sorted.
    fn pairs(&self, mut front: Vec<(u32, u32)>) -> Vec<[FaceId; 2]> {
        let mut pairs = Vec::new();
        // Breadth first until there is work to share out, then depth first in parallel.
        while !front.is_empty() && front.len() < TASKS {
            let mut next = Vec::with_capacity(2 * front.len());
            for pair in front {
                self.open(pair, &mut next, &mut pairs);
            }
            front = next;
        }
        let parts: Vec<Vec<[FaceId; 2]>> = front
            .par_chunks(front.len().div_ceil(4 * TASKS).max(1))
            .map(|part| {
                let (mut stack, mut found) = (part.to_vec(), Vec::new());
                while let Some(pair) = stack.pop() {
                    self.open(pair, &mut stack, &mut found);
                }
                found
            })
            .collect();
        pairs.reserve(parts.iter().map(Vec::len).sum());
        for part in &parts {
            pairs.extend_from_slice(part);
        }
        pairs.par_sort_unstable();
        pairs
    }

    /// Replaces a node pair by pairs one level down, or by the triangles in it.
    #[inline]
    fn open(&self, (i, j): (u32, u32), next: &mut Vec<(u32, u32)>, found: &mut Vec<[FaceId; 2]>) {
        let (m, n) = (&self.left.nodes[i as usize], &self.right.nodes[j as usize]);
        let (bm, bn) = (self.left.node_bounds(m), self.right.node_bounds(n));
        if !bm.overlaps(&bn) {
            return;
        }
        match (m.is_leaf(), n.is_leaf()) {
            (true, true) => self.compare_leaves(m, n, found),
            (false, leaf) if leaf || size(&bm) >= size(&bn) => {
                next.extend([(m.first_index, j), (m.first_index + 1, j)]);
            }
            _ => next.extend([(i, n.first_index), (i, n.first_index + 1)]),
        }
    }

    #[inline]
    fn compare_leaves(&self, m: &Bvh2Node, n: &Bvh2Node, found: &mut Vec<[FaceId; 2]>) {
        for &f in self.left.leaf(m) {
            let bf = triangle_bounds(self.a, f);
            for &g in self.right.leaf(n) {
                if (self.keep)(f, g) && bf.overlaps(&triangle_bounds(self.b, g)) {
                    found.push([f, g]);
                }
            }
        }
    }
}

#[inline]
fn size(bounds: &Bounds) -> f64 {
    (bounds.max - bounds.min).element_sum()
}

#[inline]
fn triangle_bounds<M: Faces + Positions>(mesh: &M, face: FaceId) -> Bounds {
    let [a, b, c]: [DVec3; 3] = mesh.triangle(face);
    Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
}
