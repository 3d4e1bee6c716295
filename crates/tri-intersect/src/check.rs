//! The exact check of a result before it is handed out: pieces must not meet each other or any whole face.

use crate::arrange::{Arrangement, Part};
use crate::assemble::Assembly;
use crate::error::Error;
use crate::self_test::faces_clash;
use mesh_core::{FaceId, Faces};
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
    let bad = |pair: &&[FaceId; 2]| {
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
