//! Closest point on a mesh.

use crate::build::TriBvh;
use crate::frame::inverse_power_of_two;
use crate::stack::Stack;
use crate::triangle::{Nearest, at_barycentric, nearest_to_origin};
use glam::DVec3;
use mesh_core::{FaceId, Faces, HalfedgeId, Positions, SurfacePoint};
use obvhs::bvh2::node::Bvh2Node;

/// How far a computed distance may be off, as a share of the size of the query's frame, with a wide margin. Boxes are
/// passed over only when they are farther than the best so far by more than this, so that rounding decides nothing.
const SLACK: f64 = 1e-14;

/// A point of a mesh closest to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// The face it is on; the lowest id of those equally near.
    pub face: FaceId,
    /// Where it is, in model units.
    pub point: DVec3,
    /// Barycentric coordinates in `face`: none negative, summing to 1 up to rounding, exactly 0 (and 1) on edges and
    /// at vertices.
    pub barycentric: [f64; 3],
    /// Distance from the query point, in model units.
    pub distance: f64,
}

impl ClosestPoint {
    /// The point by its address: at a vertex, within an edge or within the face.
    pub fn surface_point<M: Faces>(&self, mesh: &M) -> SurfacePoint {
        let w = self.barycentric;
        if let Some(k) = w.iter().position(|&x| x >= 1.0) {
            return SurfacePoint::Vertex(mesh.corners(self.face)[k]);
        }
        match w.iter().position(|&x| x <= 0.0) {
            Some(k) => SurfacePoint::Edge { halfedge: HalfedgeId::new(self.face, (k + 1) % 3), t: w[(k + 2) % 3] },
            None => SurfacePoint::Face { face: self.face, barycentric: w },
        }
    }
}

impl TriBvh {
    /// The point of the mesh closest to `p`. `None` only when the tree is empty or `p` is not finite. O(log n) for
    /// points near the surface; toward O(n) when many triangles are equally near.
    pub fn closest_point<M: Faces + Positions>(&self, mesh: &M, p: DVec3) -> Option<ClosestPoint> {
        self.closest_point_within(mesh, p, f64::INFINITY)
    }

    /// The point of the mesh closest to `p` and at most `max_distance` from it. The smaller the limit, the faster.
    pub fn closest_point_within<M: Faces + Positions>(
        &self,
        mesh: &M,
        p: DVec3,
        max_distance: f64,
    ) -> Option<ClosestPoint> {
        self.closest_point_where(mesh, p, max_distance, |_| true)
    }

    /// The same among the faces that `keep` accepts.
    pub fn closest_point_where<M: Faces + Positions>(
        &self,
        mesh: &M,
        p: DVec3,
        max_distance: f64,
        keep: impl Fn(FaceId) -> bool,
    ) -> Option<ClosestPoint> {
        if self.nodes.is_empty() || !p.is_finite() || max_distance.is_nan() || max_distance < 0.0 {
            return None;
        }
        let mut query = Query::new(self, p, max_distance);
        query.descend(self, mesh, keep);
        let (face, nearest) = query.found?;
        let point = at_barycentric(mesh.triangle(face), nearest.barycentric);
        let distance = nearest.distance_squared.sqrt() / query.scale;
        Some(ClosestPoint { face, point, barycentric: nearest.barycentric, distance })
    }
}

/// A query in a frame of its own, centred on the query point and scaled so that the mesh is within [−1, 1] from it.
struct Query {
    p: DVec3,
    /// Model units to query frame.
    scale: f64,
    /// The query point in box coordinates, and box coordinates to query frame.
    local: DVec3,
    box_scale: f64,
    /// Squared distance that a triangle must not exceed, and the same with slack for boxes.
    best: f64,
    reach: f64,
    found: Option<(FaceId, Nearest)>,
}

impl Query {
    fn new(tree: &TriBvh, p: DVec3, max_distance: f64) -> Self {
        let local = tree.frame.local(p);
        let size = (p - tree.frame.center).abs().max_element().max(tree.frame.half);
        let scale = inverse_power_of_two(size);
        let box_scale = scale / tree.frame.scale;
        let limit = max_distance * scale;
        let mut query = Self { p, scale, local, box_scale, best: f64::INFINITY, reach: f64::INFINITY, found: None };
        query.limit_to(limit * limit);
        query
    }

    #[inline]
    fn limit_to(&mut self, distance_squared: f64) {
        self.best = distance_squared;
        let reach = distance_squared.sqrt() + SLACK;
        self.reach = reach * reach;
    }

    #[inline]
    fn box_distance_squared(&self, node: &Bvh2Node) -> f64 {
        let aabb = node.aabb();
        let (lo, hi) = (aabb.min.as_dvec3(), aabb.max.as_dvec3());
        let d = (lo - self.local).max(self.local - hi).max(DVec3::ZERO) * self.box_scale;
        d.length_squared()
    }

    fn descend<M: Faces + Positions>(&mut self, tree: &TriBvh, mesh: &M, keep: impl Fn(FaceId) -> bool) {
        let mut stack: Stack<(u32, f64)> = Stack::new();
        let mut next = Some((0, self.box_distance_squared(&tree.nodes[0])));
        while let Some((index, distance)) = next {
            let node = &tree.nodes[index as usize];
            if distance > self.reach {
                next = stack.pop();
            } else if node.is_leaf() {
                for &f in tree.leaf(node) {
                    if keep(f) {
                        self.consider(mesh, f);
                    }
                }
                next = stack.pop();
            } else {
                let (i, j) = (node.first_index, node.first_index + 1);
                let di = self.box_distance_squared(&tree.nodes[i as usize]);
                let dj = self.box_distance_squared(&tree.nodes[j as usize]);
                let (near, far) = if di <= dj { ((i, di), (j, dj)) } else { ((j, dj), (i, di)) };
                if far.1 <= self.reach {
                    stack.push(far);
                }
                next = Some(near);
            }
        }
    }

    #[inline]
    fn consider<M: Faces + Positions>(&mut self, mesh: &M, face: FaceId) {
        let nearest = nearest_to_origin(mesh.triangle(face).map(|v| (v - self.p) * self.scale));
        let d = nearest.distance_squared;
        if d < self.best || (d == self.best && self.found.is_none_or(|(f, _)| face < f)) {
            self.limit_to(d);
            self.found = Some((face, nearest));
        }
    }
}
