//! Consistent orientation, on request.

use crate::bounds::Bounds;
use crate::corner_table::{NONE, distinct, in_range};
use crate::edge_groups::visit_edges;
use crate::ids::{FaceId, HalfedgeId};
use crate::map::FaceMap;
use crate::mesh::TriMesh;
use crate::origin::Origins;
use crate::traits::Faces;
use glam::DVec3;

/// Turns faces so that neighbours agree: along every edge with two faces where that is possible. Order and vertices
/// stay.
///
/// Closed components face outward, except a consistent one that faces inward inside another: a cavity. Open components
/// keep the orientation of most of their faces. A one-sided (Möbius) component keeps edges that disagree. O(n).
pub fn orient(mesh: &TriMesh) -> (TriMesh, Origins) {
    let pieces = pieces(mesh);
    let mut out = mesh.clone();
    let mut shells: Vec<(Bounds, &[FaceId])> = vec![];
    for piece in &pieces {
        for &(f, flip) in &piece.faces {
            if flip {
                out.faces[f.index()].swap(1, 2);
            }
        }
    }
    let lists: Vec<Vec<FaceId>> = pieces.iter().map(|p| p.faces.iter().map(|x| x.0).collect()).collect();
    for (piece, faces) in pieces.iter().zip(&lists) {
        // Only closed pieces have an outside, and only they are sure to have corners in range.
        let shell: &[FaceId] = if piece.closed { faces } else { &[] };
        shells.push((Bounds::of(shell.iter().flat_map(|&f| out.triangle(f))), shell));
    }
    let volume = |(bounds, faces): &(Bounds, &[FaceId])| -> f64 {
        let center = bounds.center();
        let term = |&f: &FaceId| {
            let [a, b, c] = out.triangle(f).map(|p| p - center);
            a.dot(b.cross(c))
        };
        faces.iter().map(term).sum()
    };
    let is_cavity = |i: usize| {
        let (inner, at) = (shells[i].0, out.triangle(shells[i].1[0])[0]);
        let around = |(outer, faces): &(Bounds, &[FaceId])| {
            let inside = outer.min.cmplt(inner.min).all() && inner.max.cmplt(outer.max).all();
            inside && faces.iter().map(|&f| solid_angle(out.triangle(f), at)).sum::<f64>().abs() > std::f64::consts::TAU
        };
        shells.iter().any(around)
    };
    let turn: Vec<bool> = (0..shells.len())
        .map(|i| volume(&shells[i]) < 0.0 && !(pieces[i].faces.iter().all(|x| !x.1) && is_cavity(i)))
        .collect();
    for (faces, _) in lists.iter().zip(turn).filter(|x| x.1) {
        for f in faces {
            out.faces[f.index()].swap(1, 2);
        }
    }
    (out, Origins::identity(0, mesh.positions.len(), mesh.faces.len()))
}

/// Faces joined through edges with two faces, and which of them must turn to agree with the most.
struct Piece {
    faces: Vec<(FaceId, bool)>,
    closed: bool,
}

fn pieces(mesh: &TriMesh) -> Vec<Piece> {
    type Pairs = Vec<(HalfedgeId, HalfedgeId)>;
    let pairs = visit_edges(
        mesh,
        |c| in_range(mesh, c) && distinct(c),
        |pairs: &mut Pairs, group| {
            if group.len() == 2 {
                pairs.push((group.halfedge(0), group.halfedge(1)));
            }
        },
    );
    let mut across = vec![NONE; 3 * mesh.faces.len()];
    for (h, t) in pairs.into_iter().flatten() {
        across[h.index()] = t.0;
        across[t.index()] = h.0;
    }
    let mut flips: FaceMap<Option<bool>> = FaceMap::filled(mesh.faces.len(), None);
    let mut pieces = vec![];
    for seed in mesh.face_ids() {
        if flips[seed].is_some() {
            continue;
        }
        flips[seed] = Some(false);
        let mut piece = Piece { faces: vec![(seed, false)], closed: true };
        let mut next = 0;
        while let Some(&(f, flip)) = piece.faces.get(next) {
            next += 1;
            for h in f.halfedges() {
                let t = HalfedgeId(across[h.index()]);
                if t.0 == NONE {
                    piece.closed = false;
                } else if flips[t.face()].is_none() {
                    // Two faces agree when they run along their edge in opposite directions.
                    let other = flip ^ (mesh.tail(h) == mesh.tail(t));
                    flips[t.face()] = Some(other);
                    piece.faces.push((t.face(), other));
                }
            }
        }
        if 2 * piece.faces.iter().filter(|x| x.1).count() > piece.faces.len() {
            piece.faces.iter_mut().for_each(|x| x.1 = !x.1);
        }
        pieces.push(piece);
    }
    pieces
}

/// The signed angle that a triangle fills seen from `at` (\[VanOosterom1983\]), in steradians.
fn solid_angle(corners: [DVec3; 3], at: DVec3) -> f64 {
    let [a, b, c] = corners.map(|p| p - at);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(b.cross(c)).atan2(below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{shapes, validate, volume};
    use proptest::prelude::*;

    fn moved(mesh: TriMesh, by: [f64; 3]) -> TriMesh {
        shapes::posed(mesh, glam::DQuat::IDENTITY, DVec3::from(by))
    }

    proptest! {
        #[test]
        fn randomly_flipped_faces_are_set_right(flips in prop::collection::vec(any::<bool>(), 320)) {
            let ball = shapes::icosphere(1.0, 2);
            let mut mixed = ball.clone();
            for (face, _) in mixed.faces.iter_mut().zip(&flips).filter(|x| *x.1) {
                face.swap(0, 1);
            }
            let (out, origins) = orient(&mixed);
            prop_assert!(validate(&out).is_closed() && (volume(&out) - volume(&ball)).abs() < 1e-12);
            prop_assert_eq!(origins, Origins::identity(0, 162, 320));
        }
    }

    #[test]
    fn cavities_stay_and_inverted_solids_turn() {
        let inverted = |mut mesh: TriMesh| {
            mesh.faces.iter_mut().for_each(|c| c.swap(0, 1));
            mesh
        };
        let outer = shapes::cuboid(DVec3::splat(4.0));
        let hollow = TriMesh::merged(&[outer.clone(), inverted(shapes::icosphere(1.0, 1))]);
        assert_eq!(orient(&hollow).0, hollow);
        let apart = TriMesh::merged(&[outer, inverted(moved(shapes::icosphere(1.0, 1), [9.0, 0.0, 0.0]))]);
        assert!(volume(&orient(&apart).0) > volume(&apart) + 6.0);
        let sheet = inverted(shapes::grid(1.0, 1.0, 3, 3));
        assert_eq!(orient(&sheet).0, sheet);
    }
}
