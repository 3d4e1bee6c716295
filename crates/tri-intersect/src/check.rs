//! The exact check of a result before it is handed out: pieces must not meet each other or any whole face near them.

use crate::arrange::{Arrangement, Part};
use crate::assemble::Assembly;
use crate::cut::Pieces;
use crate::error::Error;
use crate::self_test::faces_clash;
use mesh_core::{Adjacency, FaceId, FaceOrigin, Faces, HalfedgeId};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// Tests all pieces against each other and against the kept whole faces that are `near` the other part or share a vertex
/// with a cut face. Pieces differ from their faces by the rounding of new vertices alone, so nothing else can have
/// come to meet them.
pub(crate) fn check(
    result: &Assembly,
    arrangement: &Arrangement,
    parts: &[Part; 2],
    pieces: &[Pieces; 2],
    near: &[Vec<FaceId>; 2],
) -> Result<(), Error> {
    let [start, _, end] = result.pieces;
    let ids: Vec<FaceId> = (start..end).map(FaceId::from).collect();
    let mut whole = vec![];
    let mut offset = 0;
    for w in 0..2 {
        let mesh = parts[w].mesh;
        let mut faces: Vec<u32> = pieces[w]
            .faces
            .par_iter()
            .flat_map_iter(|&f| mesh.corners(FaceId(f)))
            .flat_map_iter(|v| mesh.ring(v).map(HalfedgeId::face).map(|f| f.0))
            .collect();
        faces.extend(near[w].iter().map(|f| f.0));
        faces.par_sort_unstable();
        faces.dedup();
        let kept = |f: &u32| result.whole[w].binary_search(f).ok();
        whole.extend(faces.iter().filter_map(kept).map(|place| FaceId::from(offset + place)));
        offset += result.whole[w].len();
    }
    let trees = rayon::join(|| TriBvh::build_subset(&result.mesh, &ids), || TriBvh::build_subset(&result.mesh, &whole));
    let (Ok(tree), Ok(others)) = trees else { return Ok(()) };
    let mut pairs = tree.self_overlapping_pairs(&result.mesh);
    pairs.extend(tree.overlapping_pairs(&result.mesh, &others, &result.mesh));
    let parent = |f: FaceId| match result.origins.faces[f] {
        FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face } => (part, face.0),
        FaceOrigin::New { .. } => (2, 0),
    };
    // Known contacts in a single point are reported as such, not as intersections.
    let touch = |pair: &[FaceId; 2]| {
        let [p, q] = pair.map(parent);
        let faces = [p.min(q).1, p.max(q).1];
        p.0 != q.0 && arrangement.touches.binary_search_by_key(&faces, |t| t.0).is_ok()
    };
    let bad = |pair: &&[FaceId; 2]| {
        // Pieces of one face tile it: the triangulation saw to that.
        if parent(pair[0]) == parent(pair[1]) || (!arrangement.touches.is_empty() && touch(pair)) {
            return false;
        }
        let [p, q] = pair.map(|f| result.mesh.corners(f));
        faces_clash(p, q, |v| arrangement.scaled_position(parts, result.nodes[v.index()]))
    };
    match pairs.par_iter().find_first(bad) {
        Some(&faces) => {
            let at = result.mesh.triangle(faces[0])[0];
            Err(Error::SelfIntersecting { faces, at })
        }
        None => Ok(()),
    }
}
