//! On which side of a curve faces lie, where one smooth patch reaches from one to the other: around the end of a valley that
//! opens, say.

use mesh_core::{Adjacency, Connected, FaceId, FaceMap, Faces, HalfedgeId, Positions, TriMesh};
use spine::BlendCurve;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How far from a curve faces have a side, in radii.
const REACH: f64 = 3.0;

/// Twice the number of the nearest curve on the same patch, and whether it is to the right.
pub(super) struct Sides(FaceMap<Option<u32>>);

impl Sides {
    /// The sides of those faces near `curves` whose patch, `of`, lies on both sides of one. Nothing is passed on across
    /// `walls`.
    pub fn new<'a>(
        mesh: &Connected<TriMesh>,
        curves: impl IntoIterator<Item = &'a BlendCurve>,
        of: &FaceMap<u32>,
        walls: &[bool],
        r: f64,
    ) -> Self {
        let mut sides = FaceMap::filled(mesh.face_count(), None);
        let mut front = BinaryHeap::new();
        for (i, curve) in (0u32..).zip(curves) {
            let pairs = || curve.halfedges.iter().filter_map(|&h| mesh.twin(h).map(|t| [h, t].map(HalfedgeId::face)));
            if pairs().all(|[left, right]| of[left] != of[right]) {
                continue;
            }
            for (side, f) in pairs().flat_map(|pair| (0u32..).zip(pair)) {
                front.push(Reverse((Distance(0.0), f, 2 * i + side)));
            }
        }
        while let Some(Reverse((Distance(d), f, side))) = front.pop() {
            if sides[f].is_some() {
                continue;
            }
            sides[f] = Some(side);
            for h in f.halfedges().into_iter().filter(|h| !walls[h.index()]) {
                let Some(next) = mesh.twin(h).map(HalfedgeId::face).filter(|g| sides[*g].is_none()) else { continue };
                let further = d + centroid(mesh, f).distance(centroid(mesh, next));
                if further <= REACH * r {
                    front.push(Reverse((Distance(further), next, side)));
                }
            }
        }
        Self(sides)
    }

    /// Whether two faces lie on different sides of the same curve.
    pub fn part(&self, f: FaceId, g: FaceId) -> bool {
        matches!((self.0[f], self.0[g]), (Some(a), Some(b)) if a != b && a / 2 == b / 2)
    }
}

fn centroid(mesh: &Connected<TriMesh>, f: FaceId) -> glam::DVec3 {
    mesh.triangle(f).iter().sum::<glam::DVec3>() / 3.0
}

/// A length, in order.
#[derive(PartialEq)]
struct Distance(f64);

impl Eq for Distance {}

impl PartialOrd for Distance {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Distance {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::patches::Patches;
    use super::*;
    use glam::DVec3;
    use mesh_core::VertexId;

    /// A valley that opens until it is flat: one patch lies on both sides of it, told apart near the valley and nowhere else.
    #[test]
    fn a_patch_around_the_end_of_a_valley_has_two_sides_beside_it() {
        let n = 20u32;
        let place = |i: u32, j: u32| {
            let (x, y) = (f64::from(i) - 10.0, f64::from(j));
            DVec3::new(x, y, (1.0 - y / 15.0).max(0.0) * x.abs())
        };
        let id = |i: u32, j: u32| VertexId(j * (n + 1) + i);
        let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| place(i, j))).collect();
        let square = |i, j| [[id(i, j), id(i + 1, j), id(i + 1, j + 1)], [id(i, j), id(i + 1, j + 1), id(i, j + 1)]];
        let faces = (0..n).flat_map(|j| (0..n).flat_map(move |i| square(i, j))).collect();
        let mesh = Connected::new(TriMesh { positions, faces }).unwrap();
        let halfedges: Vec<HalfedgeId> = (0..10).map(|j| mesh.halfedge(id(10, j), id(10, j + 1)).unwrap()).collect();
        let curve = BlendCurve { halfedges, closed: false };
        let chosen = super::super::halfedges_of(&mesh, [&curve]);
        let patches = Patches::new(&mesh, &chosen, [&curve], 1.0);
        let [left, right] = [8, 11].map(|i| mesh.halfedge(id(i, 3), id(i + 1, 3)).unwrap().face());
        assert_eq!(patches.of(left), patches.of(right));
        assert!(!patches.join(left, right) && patches.may_block(left, right));
        let far = mesh.halfedge(id(18, 18), id(19, 18)).unwrap().face();
        assert!(patches.join(left, far) && patches.join(right, far));
    }
}
