//! The surface for one hole: a triangulation of its boundary loop, made even, made smooth.

use glam::DVec3;
use lmc_tessellate::polygon;
use mesh_core::{
    Adjacency, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, VertexId, Watch, area, collinear,
};
use remesh::{Fairing, Fairness, Frozen, Params, Projection, Sizing, fair, graded_sizes};
use rustc_hash::{FxHashMap, FxHashSet};

/// Edges of a loop whose triangulation is sought among all of its diagonals; it takes the cube of their number.
const ALL_DIAGONALS: usize = 400;
/// Triangles of one patch, at most.
const MOST_FACES: f64 = 20_000.0;
/// What a flat triangle costs beside its area, as a share of its longest edge's square.
const FLATNESS: f64 = 0.05;
/// Rings of faces around a hole that a smooth surface continues.
const RINGS: usize = 2;

/// A surface whose first vertices are those of the boundary loop, in order.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    /// The loop's vertices, the patch on their left.
    pub(crate) rim: Vec<VertexId>,
    pub(crate) mesh: TriMesh,
}

impl Patch {
    /// The triangulation of least area by diagonals of the loop that are no edges of the mesh.
    pub(crate) fn plain(mesh: &Connected<TriMesh>, walk: &[HalfedgeId]) -> Option<Self> {
        // The mesh is on the left of its boundary, so the patch runs against it.
        let rim: Vec<VertexId> = walk.iter().rev().map(|&h| mesh.tail(h)).collect();
        let points: Vec<DVec3> = rim.iter().map(|&v| mesh.position(v)).collect();
        let n = rim.len();
        let taken = edges_within(mesh, &rim);
        let stride = if n <= ALL_DIAGONALS { 1 } else { n.div_ceil(ALL_DIAGONALS / 2) };
        let may_join = |i: usize, j: usize| {
            let coarse = i.is_multiple_of(stride) && j.is_multiple_of(stride);
            let fine = i / stride == (j - 1) / stride;
            (coarse || fine) && !taken.contains(&[i.min(j), i.max(j)])
        };
        let cost = |t: [u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            let twice = (b - a).cross(c - a).length();
            let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
            let cost = 0.5 * twice + FLATNESS * (longest - twice).max(0.0);
            if cost.is_finite() && !collinear([a, b, c]) { cost } else { f64::INFINITY }
        };
        let places: Vec<u32> = (0..n as u32).collect();
        let faces = polygon(&places, may_join, &cost)?;
        Some(Self { rim, mesh: TriMesh::from_arrays(points, faces) })
    }

    /// The same surface in triangles as large as those around it.
    pub(crate) fn even(&self, mesh: &Connected<TriMesh>, watch: &Watch) -> Option<Self> {
        let own = Connected::new(self.mesh.clone()).ok()?;
        let n = self.rim.len();
        let length =
            (0..n).map(|i| self.mesh.positions[i].distance(self.mesh.positions[(i + 1) % n])).sum::<f64>() / n as f64;
        // Of equilateral triangles, as many as may be.
        let least = (area(&self.mesh) / MOST_FACES * 4.0 / 3f64.sqrt()).sqrt();
        let wanted = length.max(least);
        let sizes = graded_sizes(&own, wanted, 0.3).ok()?;
        let sizes = sizes.as_slice().iter().map(|s| s.max(least)).collect::<Vec<_>>().into();
        let how = Params { feature_angle: 180.0, ..Params::new(wanted) };
        let made =
            remesh::remesh(&own, &Frozen::default(), Sizing::PerVertex(&sizes), &how, Projection::Input, watch).ok()?;
        let even = Self { rim: self.rim.clone(), mesh: made.mesh };
        even.is_new(mesh).then_some(even)
    }

    /// The same triangles bent so that they continue what is around the hole.
    pub(crate) fn smooth(&self, mesh: &Connected<TriMesh>, watch: &Watch) -> Option<Self> {
        let inner = self.rim.len()..self.mesh.vertex_count();
        if inner.is_empty() {
            return Some(self.clone());
        }
        let mut names: FxHashMap<VertexId, VertexId> =
            (0..).map(VertexId).zip(&self.rim).map(|(i, &v)| (v, i)).collect();
        let mut around = self.mesh.clone();
        for f in rings(mesh, &self.rim) {
            let corners = mesh.corners(f).map(|v| {
                *names.entry(v).or_insert_with(|| {
                    around.positions.push(mesh.position(v));
                    VertexId::from(around.positions.len() - 1)
                })
            });
            around.faces.push(corners);
        }
        let still: Vec<bool> = (0..around.positions.len()).map(|v| !inner.contains(&v)).collect();
        let frozen = Frozen { vertices: still.into(), ..Frozen::default() };
        let around = Connected::new(around).ok()?;
        let fairing = Fairing { fairness: Fairness::Biharmonic, rounds: 2 };
        let points = fair(&around, &frozen, &fairing, watch).ok()?;
        let mut smooth = self.clone();
        smooth.mesh.positions.copy_from_slice(&points[..self.mesh.vertex_count()]);
        smooth.mesh.positions.iter().all(|p| p.is_finite()).then_some(smooth)
    }

    /// Whether none of its inner edges is one of the mesh already.
    fn is_new(&self, mesh: &Connected<TriMesh>) -> bool {
        let (n, taken) = (self.rim.len(), edges_within(mesh, &self.rim));
        let mut faces_at: FxHashMap<[usize; 2], usize> = FxHashMap::default();
        for f in &self.mesh.faces {
            for k in 0..3 {
                let (a, b) = (f[k].index(), f[(k + 1) % 3].index());
                if a < n && b < n {
                    *faces_at.entry([a.min(b), a.max(b)]).or_default() += 1;
                }
            }
        }
        faces_at.iter().all(|(edge, &count)| count == 1 || !taken.contains(edge))
    }
}

/// Edges of the mesh between two vertices of a loop, by their places in it, lower first.
fn edges_within(mesh: &Connected<TriMesh>, rim: &[VertexId]) -> FxHashSet<[usize; 2]> {
    let place: FxHashMap<VertexId, usize> = rim.iter().enumerate().map(|(i, &v)| (v, i)).collect();
    let mut edges = FxHashSet::default();
    for (i, &v) in rim.iter().enumerate() {
        for h in mesh.ring(v) {
            // A boundary vertex's last neighbour is the head of no halfedge that leaves it.
            for other in [mesh.head(h), mesh.tail(h.prev())] {
                if let Some(&j) = place.get(&other) {
                    edges.insert([i.min(j), i.max(j)]);
                }
            }
        }
    }
    edges
}

/// The faces within a few rings of a loop, in order.
fn rings(mesh: &Connected<TriMesh>, rim: &[VertexId]) -> Vec<FaceId> {
    let mut faces: Vec<FaceId> = vec![];
    let mut vertices = rim.to_vec();
    for _ in 0..RINGS {
        faces.extend(vertices.iter().flat_map(|&v| mesh.ring(v).map(HalfedgeId::face)));
        faces.sort_unstable();
        faces.dedup();
        vertices = faces.iter().flat_map(|&f| mesh.corners(f)).collect();
        vertices.sort_unstable();
        vertices.dedup();
    }
    faces
}
