//! Sizes and counts: bounds, area, volume, edge lengths, dihedral angles, Euler characteristic, genus.

use crate::bounds::Bounds;
use crate::components::{Components, components};
use crate::ids::{FaceId, HalfedgeId};
use crate::loops::boundary_loops;
use crate::normal::{area_vector, face_normal};
use crate::traits::{Adjacency, Faces, Positions};
use glam::DVec3;
use rayon::prelude::*;

/// Faces per partial sum; fixed, so that results do not depend on the thread count.
const BLOCK: u32 = 4096;

/// The smallest box around all vertices, used or not. NaN coordinates are passed over.
pub fn bounds<M: Faces + Positions>(mesh: &M) -> Bounds {
    Bounds::of(mesh.vertex_ids().map(|v| mesh.position(v)))
}

/// The middle of a triangle: the mean of its corners.
#[inline]
pub fn centroid(corners: [DVec3; 3]) -> DVec3 {
    corners.iter().sum::<DVec3>() / 3.0
}

/// Surface area, in square model units. O(n), parallel.
pub fn area<M: Faces + Positions + Sync>(mesh: &M) -> f64 {
    sum_over_faces(mesh, |triangle| area_vector(triangle).length())
}

/// Enclosed volume, in cubic model units: positive where faces are counter-clockwise seen from outside.
///
/// Summed about the middle of the bounds, so that a part far from the origin keeps its precision. Of an open mesh, the
/// volume of the cone from there. O(n), parallel.
pub fn volume<M: Faces + Positions + Sync>(mesh: &M) -> f64 {
    let center = bounds(mesh).center();
    sum_over_faces(mesh, |triangle| {
        let [a, b, c] = triangle.map(|p| p - center);
        a.dot(b.cross(c)) / 6.0
    })
}

fn sum_over_faces<M: Faces + Positions + Sync>(mesh: &M, term: impl Fn([DVec3; 3]) -> f64 + Sync) -> f64 {
    let faces = mesh.face_count() as u32;
    let blocks: Vec<f64> = (0..faces.div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            let range = block * BLOCK..faces.min((block + 1) * BLOCK);
            range.map(|f| term(mesh.triangle(FaceId(f)))).sum()
        })
        .collect();
    blocks.iter().sum()
}

/// Lengths over all undirected edges, in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeLengths {
    /// How many edges there are.
    pub count: usize,
    /// The shortest.
    pub min: f64,
    /// The mean.
    pub mean: f64,
    /// The longest.
    pub max: f64,
}

/// Measures every edge once; `None` without faces. O(n).
pub fn edge_lengths<M: Adjacency + Positions>(mesh: &M) -> Option<EdgeLengths> {
    let mut all = EdgeLengths { count: 0, min: f64::INFINITY, mean: 0.0, max: 0.0 };
    for h in edges(mesh) {
        let length = mesh.edge_length(h);
        all.count += 1;
        all.min = all.min.min(length);
        all.max = all.max.max(length);
        all.mean += length;
    }
    all.mean /= all.count as f64;
    (all.count > 0).then_some(all)
}

/// The lower halfedge of every edge, ascending.
fn edges<M: Adjacency>(mesh: &M) -> impl Iterator<Item = HalfedgeId> + '_ {
    mesh.halfedge_ids().filter(|&h| mesh.edge(h).0 == h.0)
}

/// The angle between the normals of the two faces at an edge, in radians in [−π, π]: 0 flat, positive convex,
/// negative concave. `None` on the boundary; 0 where a face has no normal.
///
/// By arctangent, so that nearly flat and nearly folded edges are as accurate as any.
pub fn dihedral_angle<M: Adjacency + Positions>(mesh: &M, h: HalfedgeId) -> Option<f64> {
    let t = mesh.twin(h)?;
    let (a, b) = (face_normal(mesh, h.face()), face_normal(mesh, t.face()));
    let edge = (mesh.position(mesh.head(h)) - mesh.position(mesh.tail(h))).normalize_or_zero();
    let cross = a.cross(b);
    Some(cross.length().copysign(edge.dot(cross)).atan2(a.dot(b)))
}

/// Counts that shape cannot change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// Vertices that some face uses.
    pub vertices: usize,
    /// Undirected edges.
    pub edges: usize,
    /// Faces.
    pub faces: usize,
    /// Connected components.
    pub components: usize,
    /// Boundary loops.
    pub boundary_loops: usize,
}

impl Topology {
    /// Vertices − edges + faces.
    pub fn euler_characteristic(&self) -> i64 {
        signed(self.vertices) - signed(self.edges) + signed(self.faces)
    }

    /// The number of handles, summed over components; boundary loops count as capped.
    pub fn genus(&self) -> i64 {
        (2 * signed(self.components) - signed(self.boundary_loops) - self.euler_characteristic()) / 2
    }
}

fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// Counts the whole mesh. O(n).
pub fn topology<M: Adjacency>(mesh: &M) -> Topology {
    let mut total = Topology::default();
    for one in component_topologies(mesh, &components(mesh)) {
        total.vertices += one.vertices;
        total.edges += one.edges;
        total.faces += one.faces;
        total.components += 1;
        total.boundary_loops += one.boundary_loops;
    }
    total
}

/// Counts each component of `parts`, which must be those of this mesh. O(n).
pub fn component_topologies<M: Adjacency>(mesh: &M, parts: &Components) -> Vec<Topology> {
    let mut counts: Vec<Topology> =
        parts.face_counts.iter().map(|&faces| Topology { faces, components: 1, ..Topology::default() }).collect();
    let mut of = |h: HalfedgeId, add: fn(&mut Topology)| {
        let label = parts.labels.get(h.face()).map_or(usize::MAX, |&l| l as usize);
        if let Some(count) = counts.get_mut(label) {
            add(count);
        }
    };
    for v in mesh.vertex_ids() {
        if let Some(h) = mesh.outgoing(v) {
            of(h, |t| t.vertices += 1);
        }
    }
    edges(mesh).for_each(|h| of(h, |t| t.edges += 1));
    for walk in boundary_loops(mesh) {
        of(walk[0], |t| t.boundary_loops += 1);
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, TriMesh, shapes};
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn a_box_measures_as_it_should() {
        let mesh = Connected::new(shapes::cuboid(DVec3::new(1.0, 2.0, 3.0))).unwrap();
        assert!((volume(&mesh) - 6.0).abs() < 1e-14 && (area(&mesh) - 22.0).abs() < 1e-14);
        assert_eq!(bounds(&mesh), Bounds { min: DVec3::new(-0.5, -1.0, -1.5), max: DVec3::new(0.5, 1.0, 1.5) });
        let lengths = edge_lengths(&mesh).unwrap();
        assert_eq!((lengths.count, lengths.min, lengths.max), (18, 1.0, 13f64.sqrt()));
        let diagonals = 2.0 * (5f64.sqrt() + 10f64.sqrt() + 13f64.sqrt());
        assert!((lengths.mean - (24.0 + diagonals) / 18.0).abs() < 1e-14);
        assert_eq!(edge_lengths(&Connected::new(TriMesh::default()).unwrap()), None);
    }

    /// About the origin this volume would keep no digit at all.
    #[test]
    fn volume_keeps_its_precision_far_away() {
        let mut ball = shapes::icosphere(1.0, 3);
        let near = volume(&ball);
        ball.positions.iter_mut().for_each(|p| *p += DVec3::splat(f64::from(1u32 << 30)));
        assert!((volume(&ball) - near).abs() < 1e-6 * near, "{} {near}", volume(&ball));
    }

    /// Both fall short of the ball's by an error that goes with the square of the edge length.
    #[test]
    fn volume_and_area_converge() {
        let errors = [3, 4, 5].map(|levels| {
            let ball = shapes::icosphere(2.0, levels);
            (32.0 * PI / 3.0 - volume(&ball), 16.0 * PI - area(&ball))
        });
        for pair in errors.windows(2) {
            assert!((3.8..4.2).contains(&(pair[0].0 / pair[1].0)), "{errors:?}");
            assert!((3.8..4.2).contains(&(pair[0].1 / pair[1].1)), "{errors:?}");
        }
    }

    #[test]
    fn dihedral_angles_know_convex_from_concave() {
        let hinge = |angle: f64| {
            // Two triangles over the x axis; the second turns down by `angle`.
            let wing = DVec3::new(0.5, -angle.cos(), -angle.sin());
            let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1.0, 0.0), wing];
            let mesh = Connected::new(TriMesh::from_arrays(points, [[0, 1, 2], [1, 0, 3]])).unwrap();
            (dihedral_angle(&mesh, HalfedgeId(0)).unwrap(), dihedral_angle(&mesh, HalfedgeId(3)).unwrap())
        };
        for angle in [1e-12, -1e-12, 0.3, -0.3, FRAC_PI_2, -FRAC_PI_2, 3.0, -3.0, PI - 1e-9] {
            let (one, other) = hinge(angle);
            assert!((one - angle).abs() <= 1e-12 * angle.abs().max(1e-3) && one == other, "{angle}: {one} {other}");
        }
    }

    #[test]
    fn genus_counts_handles_and_ignores_holes() {
        let ball = shapes::icosphere(1.0, 1);
        let open = TriMesh { faces: ball.faces[1..].to_vec(), ..ball.clone() };
        let counts = topology(&Connected::new(open).unwrap());
        assert_eq!((counts.euler_characteristic(), counts.genus(), counts.boundary_loops), (1, 0, 1));
        let torus = shapes::torus(2.0, 0.5, 12, 6);
        let counts = topology(&Connected::new(torus).unwrap());
        assert_eq!((counts.euler_characteristic(), counts.genus(), counts.components), (0, 1, 1));
    }
}
