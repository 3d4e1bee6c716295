//! Faces on the same three vertices.

use crate::mended::Mended;
use crate::sides::edge;
use mesh_core::{FaceId, Faces, TriMesh, VertexId};
use rustc_hash::FxHashMap;

/// Drops faces that repeat another. Counts those that went. Corners must be in range and distinct. O(n log n).
///
/// Of faces that look the same way the first stays. Faces that look opposite ways bound nothing between them: they go in pairs,
/// unless the surface would then have a hole that it has not with one of them, as where a whole surface is given twice.
pub fn drop_duplicates(mesh: &TriMesh) -> Mended {
    let mut keyed: Vec<([VertexId; 3], FaceId)> = mesh.face_ids().map(|f| (sorted(mesh.corners(f)), f)).collect();
    keyed.sort_unstable();
    let groups: Vec<&[([VertexId; 3], FaceId)]> = keyed.chunk_by(|a, b| a.0 == b.0).collect();
    if groups.len() == mesh.face_count() {
        return Mended::unchanged(mesh);
    }
    let balance = |group: &[([VertexId; 3], FaceId)]| {
        group.iter().map(|(_, f)| if is_even(mesh.corners(*f)) { 1i64 } else { -1 }).sum::<i64>()
    };
    let balanced: Vec<usize> = (0..groups.len()).filter(|&g| balance(groups[g]) == 0).collect();
    let stays = worth_keeping(&groups, &balanced);
    let mut keep = vec![false; mesh.face_count()];
    for (g, group) in groups.iter().enumerate() {
        let net = balance(group);
        let kept = match balanced.binary_search(&g) {
            Ok(place) => stays[place].then(|| group[0].1),
            Err(_) => group.iter().map(|x| x.1).find(|&f| is_even(mesh.corners(f)) == (net > 0)),
        };
        if let Some(f) = kept {
            keep[f.index()] = true;
        }
    }
    Mended::kept(mesh, |f| keep[f.index()])
}

/// For each group of faces that cancel, whether one of them is needed. Groups that share edges are decided together.
fn worth_keeping(groups: &[&[([VertexId; 3], FaceId)]], balanced: &[usize]) -> Vec<bool> {
    let edges = |g: usize| {
        let [a, b, c] = groups[g][0].0;
        [edge(a, b), edge(b, c), edge(a, c)]
    };
    let mut at: FxHashMap<[VertexId; 2], (Vec<usize>, usize)> = FxHashMap::default();
    for (place, &g) in balanced.iter().enumerate() {
        for e in edges(g) {
            at.entry(e).or_default().0.push(place);
        }
    }
    for g in (0..groups.len()).filter(|g| balanced.binary_search(g).is_err()) {
        for e in edges(g) {
            at.entry(e).and_modify(|x| x.1 += 1);
        }
    }
    let mut decided: Vec<Option<bool>> = vec![None; balanced.len()];
    for seed in 0..balanced.len() {
        if decided[seed].is_some() {
            continue;
        }
        let (mut patch, mut next) = (vec![seed], 0);
        decided[seed] = Some(false);
        // Edges of the patch's outline with an odd number of other faces, against those with an even one.
        let mut votes = 0i64;
        while let Some(&place) = patch.get(next) {
            next += 1;
            for e in edges(balanced[place]) {
                let Some((own, others)) = at.get(&e) else { continue };
                if own.len() == 1 {
                    votes += if others % 2 == 1 { 1 } else { -1 };
                }
                for &o in own {
                    if decided[o].is_none() {
                        decided[o] = Some(false);
                        patch.push(o);
                    }
                }
            }
        }
        for place in patch {
            decided[place] = Some(votes >= 0);
        }
    }
    decided.into_iter().map(|d| d == Some(true)).collect()
}

fn sorted(mut corners: [VertexId; 3]) -> [VertexId; 3] {
    corners.sort_unstable();
    corners
}

/// Whether corners are a rotation of their ascending order.
fn is_even([a, b, c]: [VertexId; 3]) -> bool {
    [a < b, b < c, c < a].into_iter().filter(|up| *up).count() == 2
}
