//! Boundary loops with stable ids.

use crate::ids::HalfedgeId;
use crate::traits::Adjacency;

/// Every boundary loop as its halfedges in order, the surface on the left.
///
/// Stable: each loop starts at its lowest halfedge, and loops are ordered by it, so that loop ids survive any change
/// that keeps the faces. O(n).
pub fn boundary_loops(mesh: &impl Adjacency) -> Vec<Vec<HalfedgeId>> {
    let halfedges = 3 * mesh.face_count() as u32;
    let mut seen = vec![0u64; (halfedges as usize).div_ceil(64)];
    let mut loops = vec![];
    for start in (0..halfedges).map(HalfedgeId) {
        if mesh.twin(start).is_some() || seen[start.index() / 64] >> (start.0 % 64) & 1 == 1 {
            continue;
        }
        let mut walk = vec![];
        let mut h = Some(start);
        while let Some(here) = h.filter(|h| seen[h.index() / 64] >> (h.0 % 64) & 1 == 0) {
            seen[here.index() / 64] |= 1 << (here.0 % 64);
            walk.push(here);
            // At a boundary vertex `outgoing` is the one boundary halfedge that leaves it.
            h = mesh.outgoing(mesh.head(here));
        }
        loops.push(walk);
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, Faces, TriMesh, shapes};
    use glam::DVec3;

    #[test]
    fn a_closed_mesh_has_none_and_a_torn_one_follows_each_hole() {
        let ball = shapes::icosphere(1.0, 2);
        assert!(boundary_loops(&Connected::new(&ball).unwrap()).is_empty());
        let open = TriMesh {
            faces: ball.faces.iter().copied().enumerate().filter(|(f, _)| ![7, 200].contains(f)).map(|f| f.1).collect(),
            ..ball
        };
        let mesh = Connected::new(&open).unwrap();
        let loops = boundary_loops(&mesh);
        assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
        assert!(loops[0][0] < loops[1][0]);
        for walk in &loops {
            assert_eq!(walk.iter().min(), walk.first());
            for (i, &h) in walk.iter().enumerate() {
                assert_eq!(mesh.twin(h), None);
                assert_eq!(mesh.head(h), mesh.tail(walk[(i + 1) % walk.len()]));
            }
        }
    }

    #[test]
    fn one_triangle_is_one_loop() {
        let mesh = Connected::new(TriMesh::from_arrays(vec![DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]])).unwrap();
        assert_eq!(boundary_loops(&mesh), [[HalfedgeId(0), HalfedgeId(1), HalfedgeId(2)]]);
    }
}
