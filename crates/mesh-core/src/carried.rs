//! Neighbourhoods of a mesh that was made from connected ones: what whole faces had beside them they have again, and only
//! the rest is matched anew.

use crate::connected::Connected;
use crate::corner_table::{NONE, distinct, fans, in_range};
use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::not_manifold::NotManifold;
use crate::origin::{FaceOrigin, Origins, VertexOrigin};
use crate::traits::{Adjacency, Faces, Positions};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

impl<M: Faces + Positions + Sync> Connected<M> {
    /// [`Connected::new`] for a mesh with known `origins` in `parts`, in two thirds of the time where most faces are whole
    /// ones. The outcome is the same: origins are only taken as hints, and those that mislead cost time.
    ///
    /// # Errors
    /// [`NotManifold`], as [`Connected::new`] gives it.
    #[expect(clippy::result_large_err, reason = "built once per mesh, and its lists are public")]
    pub fn carried<P: Adjacency + Sync>(mesh: M, parts: &[&P], origins: &Origins) -> Result<Self, NotManifold> {
        match carry(&mesh, parts, origins) {
            Some((twins, outgoing)) => Ok(Self::from_table(mesh, twins, outgoing)),
            None => Self::new(mesh),
        }
    }
}

/// Twins and outgoing halfedges as of `corner_table::connect`; `None` if the mesh is no manifold.
fn carry<M, P>(mesh: &M, parts: &[&P], origins: &Origins) -> Option<(Vec<u32>, Vec<u32>)>
where
    M: Faces + Positions + Sync,
    P: Adjacency + Sync,
{
    let n = mesh.face_count();
    if parts.is_empty() || n >= (NONE / 3) as usize || origins.faces.as_slice().len() != n {
        return None;
    }
    let sound = |f: usize| {
        let corners = mesh.corners(FaceId::from(f));
        in_range(mesh, corners) && distinct(corners)
    };
    if !(0..n).into_par_iter().all(sound) {
        return None;
    }
    let now = places(mesh, parts, origins);
    let mut twins = vec![NONE; 3 * n];
    let carried = |f: FaceId| -> Option<[u32; 3]> {
        let FaceOrigin::Input { part, face } = origins.faces[f] else { return None };
        let (old, now) = (parts.get(part as usize)?, now.get(part as usize)?);
        if now.get(face.index()) != Some(&f.0) {
            return None;
        }
        let corners = mesh.corners(f);
        Some([0, 1, 2].map(|k| {
            let Some(twin) = old.twin(HalfedgeId::new(face, k)) else { return NONE };
            let beside = now[twin.face().index()];
            if beside == NONE {
                return NONE;
            }
            // Where a vertex was split, old neighbours are none any more.
            let (there, c) = (mesh.corners(FaceId(beside)), twin.corner());
            let meets = there[c] == corners[(k + 1) % 3] && there[(c + 1) % 3] == corners[k];
            if meets { HalfedgeId::new(FaceId(beside), c).0 } else { NONE }
        }))
    };
    twins.par_chunks_mut(3).enumerate().for_each(|(f, own)| {
        if let Some(found) = carried(FaceId::from(f)) {
            own.copy_from_slice(&found);
        }
    });
    let open = match_rest(mesh, &mut twins)?;
    let outgoing = fans(mesh, &twins).ok()?;
    // An edge matched anew must not also be one that was carried.
    open.par_iter().all(|&h| ring_holds_once(mesh, &twins, &outgoing, h)).then_some((twins, outgoing))
}

/// For each part, which face of the result each of its faces is whose corners are still its own.
fn places<M, P>(mesh: &M, parts: &[&P], origins: &Origins) -> Vec<Vec<u32>>
where
    M: Faces + Sync,
    P: Adjacency + Sync,
{
    // Relaxed atomics: the lowest face wins, whoever comes first.
    let unplaced = |p: &&P| (0..p.face_count()).into_par_iter().map(|_| AtomicU32::new(NONE)).collect();
    let now: Vec<Vec<AtomicU32>> = parts.iter().map(unplaced).collect();
    (0..mesh.face_count() as u32).into_par_iter().map(FaceId).for_each(|f| {
        let FaceOrigin::Input { part, face } = origins.faces[f] else { return };
        let (Some(old), Some(now)) = (parts.get(part as usize), now.get(part as usize)) else { return };
        let Some(slot) = now.get(face.index()) else { return };
        let is = |(v, vertex): (VertexId, VertexId)| {
            origins.vertices.as_slice().get(v.index()) == Some(&VertexOrigin::Input { part, vertex })
        };
        if mesh.corners(f).into_iter().zip(old.corners(face)).all(is) {
            slot.fetch_min(f.0, Ordering::Relaxed);
        }
    });
    now.into_iter().map(|n| n.into_iter().map(AtomicU32::into_inner).collect()).collect()
}

/// Pairs the halfedges that have no twin yet, and returns them all; `None` if three share an edge or two run alike.
fn match_rest<M: Faces + Sync>(mesh: &M, twins: &mut [u32]) -> Option<Vec<HalfedgeId>> {
    let key = |h: u32| {
        let (a, b) = (mesh.tail(HalfedgeId(h)), mesh.head(HalfedgeId(h)));
        (a.min(b), a.max(b), h)
    };
    let mut open: Vec<_> =
        (0..twins.len() as u32).into_par_iter().filter(|&h| twins[h as usize] == NONE).map(key).collect();
    open.par_sort_unstable();
    for group in open.chunk_by(|p, q| (p.0, p.1) == (q.0, q.1)) {
        match *group {
            [_] => {}
            [(.., h), (.., t)] if mesh.tail(HalfedgeId(h)) != mesh.tail(HalfedgeId(t)) => {
                twins[h as usize] = t;
                twins[t as usize] = h;
            }
            _ => return None,
        }
    }
    Some(open.into_iter().map(|(.., h)| HalfedgeId(h)).collect())
}

/// Whether the edge of `h` is met once in the fans of both its ends.
fn ring_holds_once<M: Faces>(mesh: &M, twins: &[u32], outgoing: &[u32], h: HalfedgeId) -> bool {
    let (a, b) = (mesh.tail(h), mesh.head(h));
    [[a, b], [b, a]].into_iter().all(|[around, other]| {
        let (first, mut met) = (outgoing[around.index()], 0);
        let mut at = first;
        loop {
            // `at` leaves; the edge before it in the same face arrives.
            let (leaving, arriving) = (HalfedgeId(at), HalfedgeId(at).prev());
            met += usize::from(mesh.head(leaving) == other);
            let next = twins[arriving.index()];
            if next == NONE {
                met += usize::from(mesh.tail(arriving) == other);
                break;
            }
            if next == first {
                break;
            }
            at = next;
        }
        met == 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::TriMesh;
    use crate::shapes;
    use proptest::prelude::*;

    /// A mesh made from two bodies: some faces left out, their openings perhaps closed again by faces around a new vertex,
    /// faces in any order, and perhaps damaged.
    fn made(parts: &[&Connected<TriMesh>], seed: u64, out: usize, close: bool, damage: usize) -> (TriMesh, Origins) {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut random = |n: usize| rng.usize(..n);
        let (mut mesh, mut vertices, mut faces) = (TriMesh::default(), vec![], vec![]);
        for (p, part) in parts.iter().enumerate() {
            let (first, p) = (mesh.positions.len() as u32, p as u32);
            let moved = |corners: [VertexId; 3]| corners.map(|v| VertexId(v.0 + first));
            mesh.positions.extend(part.vertex_ids().map(|v| part.position(v)));
            vertices.extend(part.vertex_ids().map(|vertex| VertexOrigin::Input { part: p, vertex }));
            let left_out: Vec<usize> = (0..out).map(|_| random(part.face_count())).collect();
            for face in part.face_ids() {
                let corners = moved(part.corners(face));
                if !left_out.contains(&face.index()) {
                    faces.push((corners, FaceOrigin::Input { part: p, face }));
                } else if close {
                    let middle = VertexId::from(mesh.positions.len());
                    mesh.positions.push(part.position(part.corners(face)[0]));
                    vertices.push(VertexOrigin::New { stage: "test" });
                    let around = |k: usize| [corners[k], corners[(k + 1) % 3], middle];
                    faces.extend((0..3).map(|k| (around(k), FaceOrigin::New { stage: "test" })));
                }
            }
        }
        for i in (1..faces.len()).rev() {
            faces.swap(i, random(i + 1));
        }
        for _ in 0..damage {
            let (f, v) = (random(faces.len()), VertexId::from(random(mesh.positions.len())));
            match random(4) {
                0 => faces[f].0[random(3)] = v,
                1 => faces[f].0.swap(0, 1),
                2 => faces.push(faces[f]),
                _ => faces[f].1 = faces[random(faces.len())].1,
            }
        }
        mesh.faces = faces.iter().map(|f| f.0).collect();
        (mesh, Origins { vertices: vertices.into(), faces: faces.into_iter().map(|f| f.1).collect::<Vec<_>>().into() })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        #[test]
        fn what_is_carried_is_what_is_found_anew(seed: u64, out in 0usize..6, close: bool, damage in 0usize..3) {
            let parts = [shapes::icosphere(1.0, 1), shapes::cuboid_grid(glam::DVec3::ONE, [2; 3])];
            let parts = parts.map(|p| Connected::new(p).unwrap());
            let parts = [&parts[0], &parts[1]];
            let (mesh, origins) = made(&parts, seed, out, close, damage);
            let (anew, carried) = (Connected::new(&mesh), Connected::carried(&mesh, &parts, &origins));
            prop_assert!(damage > 0 || out > 1 || carry(&mesh, &parts, &origins).is_some());
            match (anew, carried) {
                (Ok(anew), Ok(carried)) => {
                    for h in mesh.halfedge_ids() {
                        prop_assert_eq!(anew.twin(h), carried.twin(h));
                    }
                    for v in mesh.vertex_ids() {
                        prop_assert_eq!(anew.outgoing(v), carried.outgoing(v));
                    }
                }
                (anew, carried) => prop_assert_eq!(anew.err(), carried.err()),
            }
        }
    }
}
