//! The exact check of a result before it is handed out: pieces must not meet each other or any whole face.

use crate::arrange::{Arrangement, Part};
use crate::assemble::Assembly;
use crate::error::Error;
use crate::self_test::faces_clash;
use mesh_core::{FaceId, FaceOrigin, Faces};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// Tests all pieces against each other and against the kept whole faces of both parts, whose trees are `trees`.
pub(crate) fn check(
    result: &Assembly,
    arrangement: &Arrangement,
    parts: &[Part; 2],
    trees: &[TriBvh; 2],
) -> Result<(), Error> {
    let [start, _, end] = result.pieces;
    let ids: Vec<FaceId> = (start..end).map(FaceId::from).collect();
    let Ok(tree) = TriBvh::build_subset(&result.mesh, &ids) else { return Ok(()) };
    let mut pairs = tree.self_overlapping_pairs(&result.mesh);
    let mut offset = 0;
    for w in 0..2 {
        let near = tree.overlapping_pairs(&result.mesh, &trees[w], parts[w].mesh.mesh());
        pairs.extend(near.into_iter().filter_map(|[piece, face]| {
            let place = result.whole[w].binary_search(&face.0).ok()?;
            Some([piece, FaceId::from(offset + place)])
        }));
        offset += result.whole[w].len();
    }
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
        if !arrangement.touches.is_empty() && touch(pair) {
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
