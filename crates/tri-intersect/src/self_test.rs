//! The exact self-intersection report.

use crate::contact::{fold, meet, meet_beyond_corner};
use crate::error::Error;
use crate::plain::Plain;
use crate::predicate::{facing, largest, scaled};
use glam::DVec3;
use mesh_core::{Bounds, FaceId, Faces, Positions, TriMesh, VertexId, Watch};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// Pairs tested between two looks at the watch.
const BATCH: usize = 1 << 16;
/// Listed faces tested between two looks.
const LIST: usize = 1 << 12;

/// Every pair of faces that meet where they should not: sharing no vertex and touching at all; sharing a vertex and
/// meeting elsewhere; sharing an edge and folded flat onto each other; sharing all three. A face without area is listed
/// with itself. In order, lower id first. Exact, and the same criterion as CGAL's and libigl's.
///
/// # Errors
/// [`Error::NotFinite`], [`Error::Cancelled`].
pub fn self_intersections<M: Faces + Positions + Sync>(mesh: &M, watch: &Watch) -> Result<Vec<[FaceId; 2]>, Error> {
    let mesh = &scaled_copy(mesh)?;
    let all: Vec<FaceId> = mesh.face_ids().collect();
    if Plain::serve(mesh, &all) {
        return among(mesh, &all, watch);
    }
    let Ok(tree) = TriBvh::build(mesh) else { return Ok(vec![]) };
    let candidates = tree.self_overlapping_pairs(mesh);
    let mut found = degenerate(mesh, all);
    found.extend(meeting(mesh, &candidates, watch)?);
    found.sort_unstable();
    Ok(found)
}

/// The pairs of [`self_intersections`] of which at least one face is listed. All faces are looked at once, to pass over
/// those far from every listed one; all else grows with the list.
///
/// # Errors
/// As [`self_intersections`].
pub fn self_intersections_among<M: Faces + Positions + Sync>(
    mesh: &M,
    faces: &[FaceId],
    watch: &Watch,
) -> Result<Vec<[FaceId; 2]>, Error> {
    among(&scaled_copy(mesh)?, faces, watch)
}

/// The mesh as one type, for which all that follows is compiled once, its positions scaled for exact predicates.
fn scaled_copy<M: Faces + Positions>(mesh: &M) -> Result<TriMesh, Error> {
    let positions: Vec<DVec3> = mesh.vertex_ids().map(|v| mesh.position(v)).collect();
    let size = largest(&positions);
    if !size.is_finite() {
        let vertex = positions.iter().position(|p| !p.is_finite()).unwrap_or(0);
        return Err(Error::NotFinite { part: 0, vertex: VertexId::from(vertex) });
    }
    let faces = mesh.face_ids().map(|f| mesh.corners(f)).collect();
    Ok(TriMesh { positions: scaled(positions, size).into_owned(), faces })
}

fn among(mesh: &TriMesh, faces: &[FaceId], watch: &Watch) -> Result<Vec<[FaceId; 2]>, Error> {
    let mut listed = vec![false; mesh.faces.len()];
    for f in faces {
        listed[f.index()] = true;
    }
    let mut unique: Vec<FaceId> = faces.to_vec();
    unique.sort_unstable();
    unique.dedup();
    let near = Neighbourhood::of(mesh, &unique);
    let close: Vec<FaceId> = (0..mesh.faces.len() as u32)
        .into_par_iter()
        .with_min_len(4096)
        .map(FaceId)
        .filter(|&f| listed[f.index()] || near.reaches(&box_of(mesh, f)))
        .collect();
    let Ok(tree) = TriBvh::build_subset(mesh, &close) else { return Ok(vec![]) };
    let plain = Plain::new(mesh, &unique);
    let met = |&f: &FaceId| {
        let mut met = vec![];
        // Pairs are tested as they are found: of needles fanned out over a plane nearly every two have boxes that meet.
        tree.visit_box(mesh, &box_of(mesh, f), |g| {
            // Of two listed faces the lower one names the pair.
            if g != f && !(listed[g.index()] && g < f) && !plain.together([f, g]) && clash(mesh, [f, g]) {
                met.push([f.min(g), f.max(g)]);
            }
        });
        met
    };
    let mut found = vec![];
    for (i, batch) in unique.chunks(LIST).enumerate() {
        watch.step("self-intersections", (i * LIST) as f64 / unique.len() as f64)?;
        found.par_extend(batch.par_iter().map(met).flatten_iter());
    }
    found.extend(degenerate(mesh, unique));
    found.sort_unstable();
    Ok(found)
}

fn box_of(mesh: &TriMesh, f: FaceId) -> Bounds {
    Bounds::of(mesh.triangle(f))
}

/// Cells of a coarse grid that the boxes of some faces touch.
struct Neighbourhood {
    bounds: Bounds,
    cell: DVec3,
    touched: Vec<u64>,
}

/// Cells along each axis: 32 KiB of bits, which stay in the first cache while a million faces are looked up.
const CELLS: usize = 64;

impl Neighbourhood {
    fn of(mesh: &TriMesh, faces: &[FaceId]) -> Self {
        let bounds = faces.iter().fold(Bounds::EMPTY, |b, &f| b.union(box_of(mesh, f)));
        let cell = (bounds.max - bounds.min) / CELLS as f64;
        let mut grid = Self { bounds, cell, touched: vec![0; CELLS * CELLS * CELLS / 64] };
        for &f in faces {
            for (word, bits) in grid.words(&box_of(mesh, f)) {
                grid.touched[word] |= bits;
            }
        }
        grid
    }

    /// Whether a box shares a cell with one of the faces' boxes. Never misses one that overlaps, since both round the
    /// same way.
    fn reaches(&self, bounds: &Bounds) -> bool {
        self.bounds.overlaps(bounds) && self.words(bounds).any(|(word, bits)| self.touched[word] & bits != 0)
    }

    /// The rows of cells that a box covers, as words of the bit set and the bits in them.
    fn words(&self, bounds: &Bounds) -> impl Iterator<Item = (usize, u64)> + use<> {
        let cell = |p: DVec3, axis: usize| {
            let steps = (p[axis] - self.bounds.min[axis]) / self.cell[axis];
            // A flat box has cells of no width: 0/0 goes to the first.
            if steps > 0.0 { (steps as usize).min(CELLS - 1) } else { 0 }
        };
        let [x, y, z] = [0, 1, 2].map(|axis| (cell(bounds.min, axis), cell(bounds.max, axis)));
        let bits = (u64::MAX >> (CELLS - 1 - x.1)) & (u64::MAX << x.0);
        (z.0..=z.1).flat_map(move |k| (y.0..=y.1).map(move |j| (k * CELLS + j, bits)))
    }
}

fn degenerate(mesh: &TriMesh, faces: Vec<FaceId>) -> Vec<[FaceId; 2]> {
    faces.into_par_iter().filter(|&f| facing(&mesh.triangle(f)).is_none()).map(|f| [f, f]).collect()
}

fn meeting(mesh: &TriMesh, candidates: &[[FaceId; 2]], watch: &Watch) -> Result<Vec<[FaceId; 2]>, Error> {
    let mut found = vec![];
    for (i, batch) in candidates.chunks(BATCH).enumerate() {
        watch.step("self-intersections", (i * BATCH) as f64 / candidates.len() as f64)?;
        found.par_extend(batch.par_iter().filter(|&&pair| clash(mesh, pair)).copied());
    }
    Ok(found)
}

fn clash(mesh: &TriMesh, pair: [FaceId; 2]) -> bool {
    let [p, q] = pair.map(|f| mesh.corners(f));
    faces_clash(p, q, |v| mesh.positions[v.index()])
}

/// Whether two faces of one mesh meet where they should not.
pub(crate) fn faces_clash<V: Copy + PartialEq>(p: [V; 3], q: [V; 3], at: impl Fn(V) -> DVec3) -> bool {
    let shared = |i: usize| q.iter().position(|&v| v == p[i]);
    let common: [Option<usize>; 3] = [0, 1, 2].map(shared);
    let (pp, qq) = (p.map(&at), q.map(&at));
    let shared_of_q = [0, 1, 2].map(|j| common.contains(&Some(j)));
    if parted(&pp, &qq, common.map(|c| c.is_some()), shared_of_q)
        || parted(&qq, &pp, shared_of_q, common.map(|c| c.is_some()))
    {
        return false;
    }
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

/// Share of the product of the lengths by which a computed sign is trusted: 40 roundings where there are a dozen.
const TRUST: f64 = 40.0 * f64::EPSILON;

/// Whether `p`'s own plane, or a plane square to it through one of its edges, plainly has all of `q` on its other side,
/// but for shared corners that lie in it. Most pairs whose boxes overlap are told apart by this, long before exact
/// arithmetic begins; flat fans of needles, whose boxes all overlap, nearly all.
fn parted(p: &[DVec3; 3], q: &[DVec3; 3], shared_of_p: [bool; 3], shared_of_q: [bool; 3]) -> bool {
    let sides = [0, 1, 2].map(|k| p[(k + 1) % 3] - p[k]);
    let lengths = sides.map(DVec3::length);
    let normal = sides[0].cross(-sides[2]);
    let others = || (0..3).filter(|&j| !shared_of_q[j]).map(|j| q[j]);
    let rough = TRUST * lengths[0] * lengths[2];
    let mut above = others().map(|v| (normal.dot(v - p[0]), rough * v.distance(p[0])));
    let Some((first, slack)) = above.next() else { return false };
    if first.abs() > slack && above.all(|(h, slack)| h * first > 0.0 && h.abs() > slack) {
        return true;
    }
    (0..3).any(|k| {
        // A shared corner off the edge would be on the inner side.
        let inwards = normal.cross(sides[k]);
        let rough = rough * lengths[k];
        !shared_of_p[(k + 2) % 3] && others().all(|v| inwards.dot(v - p[k]) < -rough * v.distance(p[k]))
    })
}
