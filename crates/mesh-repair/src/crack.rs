//! Cracks: boundary edges that nearly coincide, or of which one runs along several others.

use crate::join::joined;
use crate::mended::Mended;
use crate::sides::{Side, boundary, sides};
use mesh_core::{
    Cancelled, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, TriMesh, VertexId, Watch, distance_to_segment,
};
use mesh_query::TriBvh;
use rustc_hash::FxHashMap;

/// Rounds of joining vertices and splitting edges; the second mends what the first made room for.
const ROUNDS: usize = 8;

/// Joins boundary vertices no farther apart than `gap`, in model units, and splits boundary edges at boundary vertices no farther from
/// them than that, so that the two sides of a crack share their edges. Counts the boundary edges that are none any more.
///
/// Only boundary vertices move, each to another one; ends of one edge never become one. A round after which there are not fewer
/// boundary edges is taken back. Corners must be in range and distinct. O(n log n).
///
/// # Errors
/// [`Cancelled`].
pub fn close_cracks(mesh: &TriMesh, gap: f64, watch: &Watch) -> Result<Mended, Cancelled> {
    let mut out = Mended::unchanged(mesh);
    let mut open = boundary(&sides(mesh)).len();
    for round in 0..ROUNDS {
        watch.step("cracks", round as f64 / ROUNDS as f64)?;
        if open == 0 {
            break;
        }
        let mut next = out.clone();
        join(&mut next, gap);
        split(&mut next, gap);
        let left = boundary(&sides(&next.mesh)).len();
        if left >= open {
            break;
        }
        next.count += open - left;
        (out, open) = (next, left);
    }
    Ok(out)
}

fn join(work: &mut Mended, gap: f64) {
    let sides = sides(&work.mesh);
    let name = joined(&work.mesh, &sides, &boundary(&sides), gap);
    let moved = |v: VertexId| work.mesh.positions[v.index()] != work.mesh.positions[name[v.index()].index()];
    for (f, corners) in work.mesh.face_ids().zip(work.mesh.faces.clone()) {
        if corners.into_iter().any(moved) {
            work.origins.faces[f] = piece(work.origins.faces[f]);
        }
    }
    for v in work.mesh.faces.as_flattened_mut() {
        *v = name[v.index()];
    }
    retain(work, |[a, b, c]| a != b && b != c && c != a);
}

/// A face that is no longer whole.
fn piece(origin: FaceOrigin) -> FaceOrigin {
    match origin {
        FaceOrigin::Input { part, face } => FaceOrigin::Piece { part, face },
        other => other,
    }
}

fn retain(work: &mut Mended, keep: impl Fn([VertexId; 3]) -> bool) {
    let kept = Mended::kept(&work.mesh, |f| keep(work.mesh.corners(f)));
    if kept.count == 0 {
        return;
    }
    let old = std::mem::take(&mut work.origins);
    let faces = kept.origins.faces.as_slice().iter().map(|o| match *o {
        FaceOrigin::Input { face, .. } => old.faces[face],
        other => other,
    });
    work.origins = Origins { faces: faces.collect::<Vec<_>>().into(), vertices: old.vertices };
    work.mesh = kept.mesh;
}

/// Splits faces along their boundary edges where vertices of other boundary edges lie on them.
fn split(work: &mut Mended, gap: f64) {
    let open = boundary(&sides(&work.mesh));
    let at = onto_edges(&work.mesh, &open, gap);
    // One edge of a face in a round: the others are found in the next.
    let mut of_face: FxHashMap<FaceId, (HalfedgeId, Vec<(f64, VertexId)>)> = FxHashMap::default();
    for (h, t, v) in at {
        let entry = of_face.entry(h.face()).or_insert_with(|| (h, vec![]));
        if entry.0 == h {
            entry.1.push((t, v));
        }
    }
    let mut faces: Vec<_> = of_face.into_iter().collect();
    faces.sort_unstable_by_key(|x| x.0);
    for (f, (h, mut points)) in faces {
        points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        points.dedup_by_key(|x| x.1);
        let [a, b, c] = [work.mesh.tail(h), work.mesh.head(h), work.mesh.tail(h.prev())];
        let stops: Vec<VertexId> = [a].into_iter().chain(points.into_iter().map(|x| x.1)).chain([b]).collect();
        let origin = piece(work.origins.faces[f]);
        work.mesh.faces[f.index()] = [stops[0], stops[1], c];
        work.origins.faces[f] = origin;
        for pair in stops[1..].windows(2) {
            work.mesh.faces.push([pair[0], pair[1], c]);
            work.origins.faces.push(origin);
        }
    }
}

/// Boundary vertices on the inside of boundary edges: the edge's halfedge, the place along it in (0, 1), the vertex.
fn onto_edges(mesh: &TriMesh, open: &[Side], gap: f64) -> Vec<(HalfedgeId, f64, VertexId)> {
    let ends: Vec<[VertexId; 2]> = open.iter().map(|s| s.0).collect();
    let lines = TriMesh { positions: mesh.positions.clone(), faces: ends.iter().map(|&[a, b]| [a, b, b]).collect() };
    let used: Vec<FaceId> = lines.face_ids().collect();
    let Ok(tree) = TriBvh::build_subset(&lines, &used) else { return vec![] };
    let mut neighbours: FxHashMap<VertexId, Vec<VertexId>> = FxHashMap::default();
    for &[a, b] in &ends {
        neighbours.entry(a).or_default().push(b);
        neighbours.entry(b).or_default().push(a);
    }
    let mut vertices: Vec<VertexId> = neighbours.keys().copied().collect();
    vertices.sort_unstable();
    let point = |v: VertexId| mesh.positions[v.index()];
    let find = |v: VertexId| {
        let p = point(v);
        let runs_along = |line: FaceId| {
            let (h, [a, b]) = (open[line.index()].1, ends[line.index()]);
            if [a, b, mesh.tail(h.prev())].contains(&v) {
                return false;
            }
            // An edge that leaves the line is no other side of it.
            neighbours[&v].iter().any(|&q| {
                q == a
                    || q == b
                    || distance_to_segment(point(q), [point(a), point(b)]) <= gap
                    || [a, b].iter().any(|&end| distance_to_segment(point(end), [p, point(q)]) <= gap)
            })
        };
        let found = tree.closest_point_where(&lines, p, gap, runs_along)?;
        let h = open[found.face.index()].1;
        let (a, b) = (point(mesh.tail(h)), point(mesh.head(h)));
        let t = (p - a).dot(b - a) / (b - a).length_squared();
        (t > 0.0 && t < 1.0).then_some((h, t, v))
    };
    vertices.into_iter().filter_map(find).collect()
}
