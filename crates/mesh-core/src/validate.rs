//! The validator: every defect of a mesh, by kind.

use crate::collinear::collinear;
use crate::corner_table::{NONE, distinct, in_range, turn_to_start};
use crate::edge_groups::visit_edges;
use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::traits::{Faces, Positions};
use rayon::prelude::*;
use std::fmt;
use std::sync::atomic::{AtomicU32, Ordering};

/// What is wrong with a mesh. Every list is complete and ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Vertices with a coordinate that is NaN or infinite.
    pub non_finite: Vec<VertexId>,
    /// Vertices that no face uses.
    pub unreferenced: Vec<VertexId>,
    /// How many vertices have exactly the coordinates of a lower one. No defect by itself.
    pub duplicate_positions: usize,
    /// Faces with a corner beyond the vertex count. They take no part in the checks below.
    pub out_of_range: Vec<FaceId>,
    /// Faces that use a vertex twice. They take no part in the checks below.
    pub repeated_corner: Vec<FaceId>,
    /// Faces whose three points lie exactly on a line.
    pub zero_area: Vec<FaceId>,
    /// Faces with the same three vertices as a lower face, in whatever order.
    pub duplicate_faces: Vec<FaceId>,
    /// Edges with three or more faces, as vertex pairs (low, high).
    pub non_manifold_edges: Vec<[VertexId; 2]>,
    /// Edges whose two faces run along them in the same direction, as vertex pairs (low, high).
    pub misoriented_edges: Vec<[VertexId; 2]>,
    /// Vertices whose faces do not hang together through edges.
    pub non_manifold_vertices: Vec<VertexId>,
    /// How many edges have one face only. No defect by itself.
    pub boundary_edges: usize,
}

impl Report {
    /// Whether [`crate::Connected`] accepts the mesh: oriented, 2-manifold, with or without boundary.
    pub fn is_manifold(&self) -> bool {
        self.out_of_range.is_empty()
            && self.repeated_corner.is_empty()
            && self.non_manifold_edges.is_empty()
            && self.misoriented_edges.is_empty()
            && self.non_manifold_vertices.is_empty()
    }

    /// Whether the mesh is manifold without boundary.
    pub fn is_closed(&self) -> bool {
        self.is_manifold() && self.boundary_edges == 0
    }

    /// Whether there is no defect. Boundary and duplicate positions are none.
    pub fn is_clean(&self) -> bool {
        self.is_manifold()
            && self.non_finite.is_empty()
            && self.unreferenced.is_empty()
            && self.zero_area.is_empty()
            && self.duplicate_faces.is_empty()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = match (self.is_clean(), self.is_manifold(), self.boundary_edges) {
            (true, _, 0) => "clean and closed",
            (true, ..) => "clean, with boundary",
            (false, true, _) => "manifold, with defects",
            (false, false, _) => "not an oriented 2-manifold",
        };
        write!(f, "{state}")?;
        line(f, "vertices with a coordinate that is no finite number", &self.non_finite)?;
        line(f, "vertices that no face uses", &self.unreferenced)?;
        line(f, "faces that name a missing vertex", &self.out_of_range)?;
        line(f, "faces that use a vertex twice", &self.repeated_corner)?;
        line(f, "faces without area", &self.zero_area)?;
        line(f, "faces that repeat another", &self.duplicate_faces)?;
        line(f, "edges with more than two faces", &Pair::all(&self.non_manifold_edges))?;
        line(f, "edges whose two faces disagree in orientation", &Pair::all(&self.misoriented_edges))?;
        line(f, "vertices where separate parts touch", &self.non_manifold_vertices)?;
        if self.boundary_edges > 0 {
            write!(f, "\n  {} boundary edges", self.boundary_edges)?;
        }
        if self.duplicate_positions > 0 {
            write!(f, "\n  {} vertices at the place of another", self.duplicate_positions)?;
        }
        Ok(())
    }
}

struct Pair([VertexId; 2]);

impl Pair {
    fn all(pairs: &[[VertexId; 2]]) -> Vec<Self> {
        pairs.iter().map(|&p| Self(p)).collect()
    }
}

impl fmt::Display for Pair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.0[0], self.0[1])
    }
}

fn line<T: fmt::Display>(f: &mut fmt::Formatter<'_>, what: &str, all: &[T]) -> fmt::Result {
    const SHOWN: usize = 5;
    if all.is_empty() {
        return Ok(());
    }
    write!(f, "\n  {} {what}:", all.len())?;
    for one in all.iter().take(SHOWN) {
        write!(f, " {one}")?;
    }
    if all.len() > SHOWN { write!(f, " …") } else { Ok(()) }
}

/// Finds every defect. Takes anything; O(n log n), parallel, 20 bytes per face corner while it runs.
///
/// ```
/// let mut cube = mesh_core::shapes::cuboid(glam::DVec3::ONE);
/// assert!(mesh_core::validate(&cube).is_closed());
/// cube.faces[3].swap(0, 1);
/// let report = mesh_core::validate(&cube);
/// assert_eq!(report.misoriented_edges.len(), 3);
/// assert!(report.to_string().starts_with("not an oriented 2-manifold"));
/// ```
pub fn validate<M: Faces + Positions + Sync>(mesh: &M) -> Report {
    let faces = mesh.face_count() as u32;
    let select = |bad: &(dyn Fn([VertexId; 3]) -> bool + Sync)| -> Vec<FaceId> {
        (0..faces).into_par_iter().map(FaceId).filter(|&f| bad(mesh.corners(f))).collect()
    };
    let mut report = Report {
        non_finite: (0..mesh.vertex_count() as u32)
            .into_par_iter()
            .map(VertexId)
            .filter(|&v| !mesh.position(v).is_finite())
            .collect(),
        unreferenced: unreferenced(mesh),
        duplicate_positions: duplicate_positions(mesh),
        out_of_range: select(&|c| !in_range(mesh, c)),
        repeated_corner: select(&|c| in_range(mesh, c) && !distinct(c)),
        zero_area: select(&|c| in_range(mesh, c) && distinct(c) && collinear(c.map(|v| mesh.position(v)))),
        ..Report::default()
    };
    let twins = check_edges(mesh, &mut report);
    report.non_manifold_vertices = non_manifold_vertices(mesh, &twins);
    report
}

fn usable<M: Faces>(mesh: &M, c: [VertexId; 3]) -> bool {
    in_range(mesh, c) && distinct(c)
}

fn unreferenced<M: Faces>(mesh: &M) -> Vec<VertexId> {
    let mut used = vec![false; mesh.vertex_count()];
    for f in mesh.face_ids() {
        for v in mesh.corners(f) {
            if let Some(flag) = used.get_mut(v.index()) {
                *flag = true;
            }
        }
    }
    mesh.vertex_ids().filter(|v| !used[v.index()]).collect()
}

fn duplicate_positions<M: Faces + Positions + Sync>(mesh: &M) -> usize {
    // Adding zero makes −0 and 0 alike, as comparison does.
    let bits = |v: u32| mesh.position(VertexId(v)).to_array().map(|x| (x + 0.0).to_bits());
    let mut keys: Vec<(u64, u32)> = (0..mesh.vertex_count() as u32)
        .into_par_iter()
        .map(|v| (bits(v).iter().fold(0, |k: u64, b| (k ^ b).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29)), v))
        .collect();
    keys.par_sort_unstable();
    keys.chunk_by(|a, b| a.0 == b.0)
        .filter(|same| same.len() > 1)
        .map(|same| {
            // The key is a hash: only equal coordinates count.
            let mut places: Vec<_> = same.iter().map(|&(_, v)| bits(v)).collect();
            places.sort_unstable();
            places.windows(2).filter(|w| w[0] == w[1]).count()
        })
        .sum()
}

/// Fills in everything about edges and returns the twins of properly paired halfedges.
fn check_edges<M: Faces + Sync>(mesh: &M, report: &mut Report) -> Vec<u32> {
    let opposite = |h: HalfedgeId| mesh.tail(h.prev());
    let twins: Vec<AtomicU32> = (0..3 * mesh.face_count()).map(|_| AtomicU32::new(NONE)).collect();
    let parts = visit_edges(
        mesh,
        |c| usable(mesh, c),
        |part: &mut Report, group| {
            for i in 1..group.len() {
                if (0..i).any(|j| opposite(group.halfedge(i)) == opposite(group.halfedge(j))) {
                    part.duplicate_faces.push(group.halfedge(i).face());
                }
            }
            match group.len() {
                1 => part.boundary_edges += 1,
                2 if mesh.tail(group.halfedge(0)) == mesh.tail(group.halfedge(1)) => {
                    part.misoriented_edges.push(group.ends);
                }
                2 => {
                    let (h, t) = (group.halfedge(0), group.halfedge(1));
                    twins[h.index()].store(t.0, Ordering::Relaxed);
                    twins[t.index()].store(h.0, Ordering::Relaxed);
                }
                _ => part.non_manifold_edges.push(group.ends),
            }
        },
    );
    for part in parts {
        report.duplicate_faces.extend(part.duplicate_faces);
        report.misoriented_edges.extend(part.misoriented_edges);
        report.non_manifold_edges.extend(part.non_manifold_edges);
        report.boundary_edges += part.boundary_edges;
    }
    report.duplicate_faces.sort_unstable();
    report.duplicate_faces.dedup();
    report.misoriented_edges.sort_unstable();
    report.non_manifold_edges.sort_unstable();
    twins.into_iter().map(AtomicU32::into_inner).collect()
}

fn non_manifold_vertices<M: Faces + Sync>(mesh: &M, twins: &[u32]) -> Vec<VertexId> {
    let mut outgoing = vec![NONE; mesh.vertex_count()];
    let mut degree = vec![0; mesh.vertex_count()];
    for f in mesh.face_ids().filter(|&f| usable(mesh, mesh.corners(f))) {
        for (k, v) in mesh.corners(f).into_iter().enumerate() {
            outgoing[v.index()] = HalfedgeId::new(f, k).0;
            degree[v.index()] += 1;
        }
    }
    let suspect: Vec<bool> =
        outgoing.par_iter().zip(&degree).map(|(&h, &n)| turn_to_start(twins, &mut { h }) != n).collect();
    // The fan walk stops at bad edges too; only faces that share no edge of any kind make a vertex bad.
    let mut links: Vec<(VertexId, FaceId)> = vec![];
    for f in mesh.face_ids().filter(|&f| usable(mesh, mesh.corners(f))) {
        links.extend(mesh.corners(f).into_iter().filter(|v| suspect[v.index()]).map(|v| (v, f)));
    }
    links.sort_unstable();
    let groups: Vec<_> = links.chunk_by(|a, b| a.0 == b.0).collect();
    groups.into_par_iter().filter(|group| !hangs_together(mesh, group)).map(|group| group[0].0).collect()
}

/// Whether the faces around one vertex form a single piece through shared edges.
fn hangs_together<M: Faces>(mesh: &M, group: &[(VertexId, FaceId)]) -> bool {
    let mut spokes: Vec<(VertexId, usize)> = vec![];
    for (i, &(v, f)) in group.iter().enumerate() {
        spokes.extend(mesh.corners(f).into_iter().filter(|&c| c != v).map(|c| (c, i)));
    }
    spokes.sort_unstable();
    let mut parents: Vec<usize> = (0..group.len()).collect();
    let mut pieces = group.len();
    let root = |parents: &mut [usize], mut i: usize| {
        while parents[i] != i {
            parents[i] = parents[parents[i]];
            i = parents[i];
        }
        i
    };
    for pair in spokes.windows(2).filter(|w| w[0].0 == w[1].0) {
        let (a, b) = (root(&mut parents, pair[0].1), root(&mut parents, pair[1].1));
        if a != b {
            parents[a.max(b)] = a.min(b);
            pieces -= 1;
        }
    }
    pieces == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, TriMesh, shapes};
    use glam::DVec3;
    use proptest::prelude::*;

    fn ids(raw: &[u32]) -> Vec<VertexId> {
        raw.iter().map(|&v| VertexId(v)).collect()
    }

    #[test]
    fn one_of_each_is_found_and_nothing_else() {
        let mut mesh = shapes::cuboid(DVec3::ONE);
        mesh.positions.extend([DVec3::NAN, DVec3::splat(0.5), DVec3::new(2.0, 0.0, -0.0), DVec3::new(2.0, -0.0, 0.0)]);
        let v = |a: u32, b: u32, c: u32| [a, b, c].map(VertexId);
        let [a, b, c] = mesh.faces[0];
        // 12 repeats face 0, 13 names nobody, 14 a vertex twice, 15 lies on a line, 16 touches the corner only.
        mesh.faces.extend([[b, a, c], v(0, 1, 99), v(1, 1, 2), v(9, 10, 9), v(7, 10, 11)]);
        let report = validate(&mesh);
        assert_eq!(report.non_finite, ids(&[8]));
        assert_eq!(report.unreferenced, ids(&[8]));
        assert_eq!(report.duplicate_positions, 2);
        assert_eq!(report.out_of_range, [FaceId(13)]);
        assert_eq!(report.repeated_corner, [FaceId(14), FaceId(15)]);
        assert_eq!(report.zero_area, [FaceId(16)]);
        assert_eq!(report.duplicate_faces, [FaceId(12)]);
        assert_eq!(report.non_manifold_edges.len(), 3);
        assert!(report.misoriented_edges.is_empty());
        assert_eq!(report.non_manifold_vertices, ids(&[7]));
        assert_eq!(report.boundary_edges, 3);
        let text = report.to_string();
        assert!(text.lines().count() == 11 && text.contains("1 faces without area: 16"), "{text}");
    }

    #[test]
    fn flipped_faces_show_their_border() {
        let mut ball = shapes::icosphere(1.0, 2);
        ball.faces[5].swap(0, 1);
        let report = validate(&ball);
        assert_eq!(report.misoriented_edges.len(), 3);
        assert!(report.non_manifold_vertices.is_empty() && report.boundary_edges == 0 && !report.is_manifold());
    }

    proptest! {
        /// The validator and the corner table agree, on random soups and with a brute-force count of edges.
        #[test]
        fn agrees_with_the_corner_table(faces in prop::collection::vec(prop::array::uniform3(0u32..7), 0..12)) {
            let mesh = TriMesh::from_arrays((0..6).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 1.0)).collect(), faces);
            let report = validate(&mesh);
            prop_assert_eq!(report.is_manifold(), Connected::new(&mesh).is_ok());
            let uses = |a: u32, b: u32| {
                let good = mesh.faces.iter().filter(|c| usable(&mesh, **c));
                good.filter(|c| c.contains(&VertexId(a)) && c.contains(&VertexId(b))).count()
            };
            let counts: Vec<_> = (0..6).flat_map(|a| (a + 1..6).map(move |b| (a, b))).map(|(a, b)| uses(a, b)).collect();
            prop_assert_eq!(report.boundary_edges, counts.iter().filter(|&&n| n == 1).count());
            prop_assert_eq!(report.non_manifold_edges.len(), counts.iter().filter(|&&n| n > 2).count());
        }
    }
}
