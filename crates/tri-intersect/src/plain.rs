//! Patches of a mesh that plainly do not meet themselves, so that no two of their faces need be tested.
//!
//! The flat faces of a blended solid are fans of thousands of needles, nearly every two of which have boxes that meet. But
//! seen along an axis, a patch whose faces all turn one way covers each point as often as its border winds around it. If the
//! border is made of loops that neither cross nor touch, and winds around no point more than once, then the projection is
//! one-to-one: no two faces of the patch meet but in what they share. All of it exact, in O(n log n) for short borders.

use crate::predicate::{facing, project, turn, turn2};
use glam::DVec3;
use mesh_core::{FaceId, Faces, TriMesh, VertexId, area_vector};
use rustc_hash::{FxHashMap, FxHashSet};

/// How many times as long as high a needle is.
const NEEDLE: f64 = 40.0;
/// With fewer needles than this, testing pairs costs less than looking for patches.
const FEW: usize = 128;
/// Patches of fewer faces are not worth it.
const SMALLEST: usize = 32;
/// A patch keeps as near to the plane of its largest face, as a share of the largest coordinate. More would be as right, but
/// large patches that bend more often fold over.
const FLAT: f64 = 1e-6;
/// Borders of more loops would take long to nest.
const MOST_LOOPS: usize = 1024;
/// No patch.
const NONE: u32 = u32::MAX;

/// For each face the patch it belongs to.
pub(crate) struct Plain {
    patch: Vec<u32>,
}

impl Plain {
    /// Whether there are so many needles that patches are worth looking for.
    pub fn serve(mesh: &TriMesh, faces: &[FaceId]) -> bool {
        let is_needle = |f: &&FaceId| is_needle(&mesh.triangle(**f));
        faces.iter().filter(is_needle).take(FEW).count() == FEW
    }

    /// The patches among `faces`; none where there are few needles.
    pub fn new(mesh: &TriMesh, faces: &[FaceId]) -> Self {
        if !Self::serve(mesh, faces) {
            return Self { patch: vec![] };
        }
        let across = Across::new(mesh, faces);
        let reach = FLAT * mesh.positions.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let mut largest: Vec<(f64, FaceId)> =
            faces.iter().map(|&f| (area_vector(mesh.triangle(f)).length_squared(), f)).collect();
        largest.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut patch = vec![NONE; mesh.faces.len()];
        // Faces are taken once, whether their patch serves or not.
        let mut taken = vec![false; mesh.faces.len()];
        for (_, seed) in largest {
            if taken[seed.index()] {
                continue;
            }
            let Some((axis, way)) = facing(&mesh.triangle(seed)) else { continue };
            let (foot, normal) = (mesh.triangle(seed)[0], area_vector(mesh.triangle(seed)).normalize_or_zero());
            let belongs = |f: FaceId| {
                let [a, b, c] = mesh.triangle(f);
                turn(axis, a, b, c) == way && [a, b, c].iter().all(|p| (*p - foot).dot(normal).abs() <= reach)
            };
            taken[seed.index()] = true;
            let mut members = vec![seed];
            let mut next = 0;
            while next < members.len() {
                for f in across.neighbours(mesh, members[next]) {
                    if !taken[f.index()] && belongs(f) {
                        taken[f.index()] = true;
                        members.push(f);
                    }
                }
                next += 1;
            }
            if members.len() >= SMALLEST && is_one_to_one(mesh, &members, axis, way) {
                for f in members {
                    patch[f.index()] = seed.0;
                }
            }
        }
        Self { patch }
    }

    /// Whether two faces are of one patch, and so meet in what they share alone.
    pub fn together(&self, [f, g]: [FaceId; 2]) -> bool {
        let of = |f: FaceId| self.patch.get(f.index()).copied().unwrap_or(NONE);
        of(f) != NONE && of(f) == of(g)
    }
}

fn is_needle([a, b, c]: &[DVec3; 3]) -> bool {
    let longest = a.distance_squared(*b).max(b.distance_squared(*c)).max(c.distance_squared(*a));
    NEEDLE * area_vector([*a, *b, *c]).length() * 2.0 < longest
}

/// The faces on the other sides of edges.
struct Across(FxHashMap<[VertexId; 2], FaceId>);

impl Across {
    fn new(mesh: &TriMesh, faces: &[FaceId]) -> Self {
        Self(faces.iter().flat_map(|&f| sides(mesh.corners(f)).map(|side| (side, f))).collect())
    }

    fn neighbours(&self, mesh: &TriMesh, f: FaceId) -> impl Iterator<Item = FaceId> {
        sides(mesh.corners(f)).into_iter().filter_map(|[a, b]| self.0.get(&[b, a]).copied())
    }
}

fn sides([a, b, c]: [VertexId; 3]) -> [[VertexId; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Whether the projection of faces that all turn `way`, seen along `axis`, covers no point twice.
fn is_one_to_one(mesh: &TriMesh, faces: &[FaceId], axis: usize, way: i8) -> bool {
    let Some(loops) = border(mesh, faces) else { return false };
    let flat = |v: VertexId| project(axis, mesh.positions[v.index()]);
    let mut segments: Vec<Segment> = loops
        .iter()
        .flat_map(|l| (0..l.len()).map(|k| [l[k], l[(k + 1) % l.len()]]))
        .map(|ends| Segment { ends, at: ends.map(flat) })
        .collect();
    if loops.len() > MOST_LOOPS || meet(&mut segments) {
        return false;
    }
    let shapes: Vec<Vec<[f64; 2]>> = loops.iter().map(|l| l.iter().map(|&v| flat(v)).collect()).collect();
    let turns: Vec<i8> = shapes.iter().map(|s| way * turning(s)).collect();
    shapes.iter().zip(&turns).enumerate().all(|(k, (shape, turns_inward))| {
        let others = shapes.iter().zip(&turns).enumerate().filter(|(j, _)| *j != k);
        let around: i32 = others.filter(|(_, (s, _))| encloses(s, shape[0])).map(|(_, (_, t))| i32::from(*t)).sum();
        match turns_inward {
            1 => around == 0,
            -1 => around == 1,
            _ => false,
        }
    })
}

/// The loops of edges that have one face of these beside them, with these on their left; none where more than one pair of them
/// meets at a vertex, or where an edge has two faces on one side.
fn border(mesh: &TriMesh, faces: &[FaceId]) -> Option<Vec<Vec<VertexId>>> {
    let all = || faces.iter().flat_map(|&f| sides(mesh.corners(f)));
    let known: FxHashSet<[VertexId; 2]> = all().collect();
    if known.len() < 3 * faces.len() {
        return None;
    }
    let open: Vec<[VertexId; 2]> = all().filter(|&[a, b]| !known.contains(&[b, a])).collect();
    let mut next: FxHashMap<VertexId, VertexId> = open.iter().map(|&[a, b]| (a, b)).collect();
    if next.len() < open.len() {
        return None;
    }
    let mut loops = vec![];
    for [start, _] in open {
        let mut along = vec![];
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            along.push(at);
            at = to;
        }
        if !along.is_empty() {
            loops.push(along);
        }
    }
    Some(loops)
}

#[derive(Clone, Copy)]
struct Segment {
    ends: [VertexId; 2],
    at: [[f64; 2]; 2],
}

impl Segment {
    fn low(&self, k: usize) -> f64 {
        self.at[0][k].min(self.at[1][k])
    }

    fn high(&self, k: usize) -> f64 {
        self.at[0][k].max(self.at[1][k])
    }

    /// Whether two segments meet, but for an end that they share.
    fn meets(&self, other: &Self) -> bool {
        let ([a, b], [c, d]) = (self.at, other.at);
        if let Some((i, j)) = (0..2).find_map(|i| Some((i, other.ends.iter().position(|w| *w == self.ends[i])?))) {
            let (near, far, end) = (self.at[i], self.at[1 - i], other.at[1 - j]);
            let same_way = (0..2).all(|k| far[k].partial_cmp(&near[k]) == end[k].partial_cmp(&near[k]));
            return self.ends.contains(&other.ends[1 - j]) || turn2(near, far, end) == 0 && same_way;
        }
        let apart = |p: [f64; 2], q: [f64; 2], r: [f64; 2], s: [f64; 2]| turn2(p, q, r) * turn2(p, q, s) > 0;
        !apart(a, b, c, d) && !apart(c, d, a, b)
    }
}

/// Whether any two segments meet, but for ends that they share. Sweeps along the axis on which fewer overlap.
fn meet(segments: &mut [Segment]) -> bool {
    let width = |k: usize| segments.iter().map(|s| s.high(k) - s.low(k)).sum::<f64>();
    let extent = |k: usize| {
        let ends = |s: &Segment| [s.low(k), s.high(k)];
        let all = segments.iter().flat_map(ends);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    let (x, y) = if width(0) * extent(1) <= width(1) * extent(0) { (0, 1) } else { (1, 0) };
    segments.sort_unstable_by(|s, t| s.low(x).total_cmp(&t.low(x)).then(s.ends.cmp(&t.ends)));
    (0..segments.len()).any(|i| {
        let s = segments[i];
        let after = segments[i + 1..].iter().take_while(|t| t.low(x) <= s.high(x));
        after.filter(|t| t.low(y) <= s.high(y) && s.low(y) <= t.high(y)).any(|t| s.meets(t))
    })
}

/// Which way a simple polygon turns: at its lowest corner of those farthest left.
fn turning(polygon: &[[f64; 2]]) -> i8 {
    let n = polygon.len();
    let lexicographic = |a: &usize, b: &usize| {
        let ([ax, ay], [bx, by]) = (polygon[*a], polygon[*b]);
        ax.total_cmp(&bx).then(ay.total_cmp(&by))
    };
    let k = (0..n).min_by(lexicographic).unwrap_or(0);
    turn2(polygon[(k + n - 1) % n], polygon[k], polygon[(k + 1) % n])
}

/// Whether a polygon goes round a point that is not on it: whether a ray along +x passes an odd number of sides.
fn encloses(polygon: &[[f64; 2]], p: [f64; 2]) -> bool {
    let n = polygon.len();
    let passed = |k: &usize| {
        let (a, b) = (polygon[*k], polygon[(*k + 1) % n]);
        let upward = b[1] > p[1];
        (a[1] > p[1]) != upward && (turn2(a, b, p) > 0) == upward
    };
    (0..n).filter(passed).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of needles between two circles, the inner one at `centre`, in a tilted plane.
    fn ring(n: usize, centre: f64) -> TriMesh {
        let at = |k: usize, r: f64, x: f64| {
            let a = std::f64::consts::TAU * k as f64 / n as f64;
            let (u, v) = (x + r * a.cos(), r * a.sin());
            DVec3::new(u, v, 0.25 * u + 0.5 * v)
        };
        let positions = (0..n).map(|k| at(k, 1.0, 0.0)).chain((0..n).map(|k| at(k, 0.5, centre))).collect();
        let id = |k: usize, inner: usize| VertexId::from(k % n + inner * n);
        let pair = |k: usize| [[id(k, 0), id(k + 1, 0), id(k, 1)], [id(k + 1, 0), id(k + 1, 1), id(k, 1)]];
        TriMesh { positions, faces: (0..n).flat_map(pair).collect() }
    }

    fn served(mesh: &TriMesh) -> bool {
        let faces: Vec<FaceId> = mesh.face_ids().collect();
        Plain::new(mesh, &faces).together([faces[0], faces[7]])
    }

    /// A ring with one corner pulled across it, in its plane.
    fn spiked() -> TriMesh {
        let mut mesh = ring(600, 0.3);
        mesh.positions[900] = DVec3::new(-2.0, 0.0, -0.5);
        mesh
    }

    #[test]
    fn a_flat_ring_is_one_to_one() {
        assert!(served(&ring(600, 0.3)));
    }

    /// Every pair of a few faces, whose triangles are tested one by one.
    #[test]
    fn faces_of_one_patch_do_not_meet() {
        for mesh in [ring(600, 0.3), ring(600, 0.7), spiked()] {
            let faces: Vec<FaceId> = mesh.face_ids().collect();
            let plain = Plain::new(&mesh, &faces);
            let few: Vec<FaceId> = faces.iter().copied().step_by(5).collect();
            for (i, &f) in few.iter().enumerate() {
                for &g in &few[i + 1..] {
                    let apart = mesh.corners(f).iter().all(|v| !mesh.corners(g).contains(v));
                    let meet = apart && crate::contact::meet(&mesh.triangle(f), &mesh.triangle(g));
                    assert!(!meet || !plain.together([f, g]), "{f:?} {g:?}");
                }
            }
        }
    }

    #[test]
    fn a_ring_that_winds_twice_is_not() {
        let mut mesh = ring(600, 0.0);
        for (k, p) in mesh.positions.iter_mut().enumerate() {
            let a = 2.0 * std::f64::consts::TAU * (k % 600) as f64 / 600.0;
            let r = if k < 600 { 1.0 } else { 0.5 };
            (p.x, p.y, p.z) = (r * a.cos(), r * a.sin(), 0.0);
        }
        assert!(!served(&mesh));
    }

    #[test]
    fn an_edge_laid_over_the_border_is_found() {
        let mut mesh = ring(600, 0.3);
        mesh.positions[300] = mesh.positions[310];
        assert!(!served(&mesh));
    }
}
