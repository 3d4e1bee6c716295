//! The exact self-intersection report.

use crate::contact::{fold, meet, meet_beyond_corner};
use crate::error::Error;
use crate::predicate::{facing, largest, scaled};
use glam::DVec3;
use mesh_core::{Bounds, FaceId, Faces, Positions, VertexId, Watch};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// Pairs tested between two looks at the watch.
const BATCH: usize = 1 << 16;

/// Every pair of faces that meet where they should not: sharing no vertex and touching at all; sharing a vertex and
/// meeting elsewhere; sharing an edge and folded flat onto each other; sharing all three. A face without area is listed
/// with itself. In order, lower id first. Exact, and the same criterion as CGAL's and libigl's.
///
/// # Errors
/// [`Error::NotFinite`], [`Error::Cancelled`].
pub fn self_intersections<M: Faces + Positions + Sync>(mesh: &M, watch: &Watch) -> Result<Vec<[FaceId; 2]>, Error> {
    let points = finite_points(mesh)?;
    let Ok(tree) = TriBvh::build(mesh) else { return Ok(vec![]) };
    let candidates = tree.self_overlapping_pairs(mesh);
    let mut found = degenerate(mesh, &points, mesh.face_ids().collect());
    found.extend(meeting(mesh, &points, &candidates, watch)?);
    found.sort_unstable();
    Ok(found)
}

/// The pairs of [`self_intersections`] of which at least one face is listed. Costs a tree over the mesh, and then
/// grows with the list.
///
/// # Errors
/// As [`self_intersections`].
pub fn self_intersections_among<M: Faces + Positions + Sync>(
    mesh: &M,
    faces: &[FaceId],
    watch: &Watch,
) -> Result<Vec<[FaceId; 2]>, Error> {
    let points = finite_points(mesh)?;
    let Ok(tree) = TriBvh::build(mesh) else { return Ok(vec![]) };
    let mut listed = vec![false; mesh.face_count()];
    for f in faces {
        listed[f.index()] = true;
    }
    let mut unique: Vec<FaceId> = faces.to_vec();
    unique.sort_unstable();
    unique.dedup();
    let candidates: Vec<[FaceId; 2]> = unique
        .par_iter()
        .map_init(Vec::new, |near, &f| {
            let bounds = Bounds::of(mesh.corners(f).map(|v| mesh.position(v)));
            tree.faces_in_box(mesh, &bounds, near);
            // Of two listed faces the lower one names the pair.
            near.iter()
                .filter(|&&g| g != f && !(listed[g.index()] && g < f))
                .map(|&g| [f.min(g), f.max(g)])
                .collect::<Vec<_>>()
        })
        .flatten_iter()
        .collect();
    let mut found = degenerate(mesh, &points, unique);
    found.extend(meeting(mesh, &points, &candidates, watch)?);
    found.sort_unstable();
    Ok(found)
}

fn finite_points<M: Faces + Positions>(mesh: &M) -> Result<Vec<DVec3>, Error> {
    let points: Vec<DVec3> = mesh.vertex_ids().map(|v| mesh.position(v)).collect();
    let size = largest(&points);
    if !size.is_finite() {
        let vertex = points.iter().position(|p| !p.is_finite()).unwrap_or(0);
        return Err(Error::NotFinite { part: 0, vertex: VertexId::from(vertex) });
    }
    Ok(scaled(points, size).into_owned())
}

fn degenerate<M: Faces + Sync>(mesh: &M, points: &[DVec3], faces: Vec<FaceId>) -> Vec<[FaceId; 2]> {
    let flat = |f: &FaceId| facing(&mesh.corners(*f).map(|v| points[v.index()])).is_none();
    faces.into_par_iter().filter(flat).map(|f| [f, f]).collect()
}

fn meeting<M: Faces + Sync>(
    mesh: &M,
    points: &[DVec3],
    candidates: &[[FaceId; 2]],
    watch: &Watch,
) -> Result<Vec<[FaceId; 2]>, Error> {
    let mut found = vec![];
    for (i, batch) in candidates.chunks(BATCH).enumerate() {
        watch.step("self-intersections", (i * BATCH) as f64 / candidates.len() as f64)?;
        let bad = |pair: &&[FaceId; 2]| {
            let [p, q] = pair.map(|f| mesh.corners(f));
            faces_clash(p, q, |v| points[v.index()])
        };
        found.par_extend(batch.par_iter().filter(bad).copied());
    }
    Ok(found)
}

/// Whether two faces of one mesh meet where they should not.
pub(crate) fn faces_clash<V: Copy + PartialEq>(p: [V; 3], q: [V; 3], at: impl Fn(V) -> DVec3) -> bool {
    let shared = |i: usize| q.iter().position(|&v| v == p[i]);
    let common: [Option<usize>; 3] = [0, 1, 2].map(shared);
    let (pp, qq) = (p.map(&at), q.map(&at));
    match common.iter().flatten().count() {
        0 => meet(&pp, &qq),
        1 => {
            let i = common.iter().position(Option::is_some).unwrap_or(0);
            meet_beyond_corner(&pp, i, &qq, common[i].unwrap_or(0))
        }
        2 => {
            let i = common.iter().position(Option::is_none).unwrap_or(0);
            let j = (0..3).find(|j| !common.contains(&Some(*j))).unwrap_or(0);
            fold(pp[(i + 1) % 3], pp[(i + 2) % 3], pp[i], qq[j])
        }
        _ => true,
    }
}
