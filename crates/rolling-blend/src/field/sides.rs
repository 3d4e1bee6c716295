//! The two sides of the curves: which faces they are, how far they are, and their smoothed normals.

use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, FaceOrigin, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId,
    corner_angle, face_normals,
};
use mesh_query::{ClosestPoint, TriBvh, closest_point_on_triangle};
use rayon::prelude::*;
use spine::{BlendCurve, Convexity};
use std::collections::VecDeque;

/// Faces bent by more than this against each other do not share a normal, in radians.
const CREASE: f64 = 0.7;
/// A face whose area is below this share of its longest side squared is a sliver.
const SLIVER: f64 = 1e-3;

/// Both sides of the blend curves of a mesh, seen from where the ball rolls.
pub(crate) struct Sides<'a> {
    pub mesh: &'a Connected<TriMesh>,
    /// 0 or 1 for each face; 2 for what no curve bounds.
    pub of: FaceMap<u8>,
    trees: [TriBvh; 2],
    faces: FaceMap<DVec3>,
    corners: Vec<DVec3>,
    /// 1 where the ball rolls outside the solid, −1 inside.
    pub sign: f64,
}

/// A side as a point sees it.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    /// Distance, positive on the ball's side of the surface.
    pub distance: f64,
    /// Unit gradient of the distance.
    pub gradient: DVec3,
    /// The nearest point.
    pub foot: DVec3,
    /// The smoothed normal there, towards the ball's side.
    pub normal: DVec3,
    /// The face that the nearest point is on.
    pub face: FaceId,
}

impl<'a> Sides<'a> {
    /// Tells the sides of the curves apart: whatever the curves divide, neighbours alternate.
    pub fn new(mesh: &'a Connected<TriMesh>, curves: &[BlendCurve], convexity: Convexity) -> Result<Self, Trouble> {
        let of = colour(mesh, curves)?;
        let tree = |k: u8| {
            let faces: Vec<FaceId> = mesh.face_ids().filter(|&f| of[f] == k).collect();
            TriBvh::build_subset(mesh, &faces).map_err(|_| Trouble::at("a side has no extent", vec![]))
        };
        let trees = [tree(0)?, tree(1)?];
        let faces = face_normals(mesh);
        let corners = (0..3 * mesh.face_count() as u32)
            .into_par_iter()
            .with_min_len(256)
            .map(|h| corner_normal(mesh, &of, &faces, HalfedgeId(h)))
            .collect();
        let sign = if convexity == Convexity::Concave { 1.0 } else { -1.0 };
        Ok(Self { mesh, of, trees, faces, corners, sign })
    }

    /// The sides that the faces of a mesh made from this one come from; 2 for new faces.
    pub fn of_origins(&self, origins: &Origins) -> FaceMap<u8> {
        let side = |o: &FaceOrigin| match *o {
            FaceOrigin::Input { face, .. } | FaceOrigin::Piece { face, .. } => self.of[face],
            FaceOrigin::New { .. } => 2,
        };
        origins.faces.as_slice().iter().map(side).collect::<Vec<_>>().into()
    }

    /// Side `k` from `p`; `None` only for points that are not finite.
    pub fn seen(&self, k: usize, p: DVec3) -> Option<Seen> {
        Some(self.describe(&self.trees[k].closest_point(self.mesh, p)?, p))
    }

    /// One face from `p`.
    pub fn seen_on(&self, face: FaceId, p: DVec3) -> Seen {
        let (point, barycentric) = closest_point_on_triangle(p, self.mesh.triangle(face));
        self.describe(&ClosestPoint { face, point, barycentric, distance: point.distance(p) }, p)
    }

    fn describe(&self, near: &ClosestPoint, p: DVec3) -> Seen {
        let normal = self.sign * self.smooth(near.face, near.barycentric);
        let side = self.sign * self.pseudonormal(near);
        let away = p - near.point;
        let outside = if away.dot(side) >= 0.0 { 1.0 } else { -1.0 };
        // Right on the surface, the direction away from it is noise.
        let size = self.mesh.triangle(near.face)[0].distance(p).max(near.distance);
        let gradient = if near.distance > 1e-9 * size { (outside * away).normalize_or(normal) } else { normal };
        Seen { distance: outside * near.distance, gradient, foot: near.point, normal, face: near.face }
    }

    /// Unsigned distance of `p` to side `k`.
    pub fn distance(&self, k: usize, p: DVec3) -> f64 {
        self.trees[k].closest_point(self.mesh, p).map_or(f64::INFINITY, |c| c.distance)
    }

    /// Smoothed outward normal of the mesh within one side.
    pub fn smooth(&self, face: FaceId, weights: [f64; 3]) -> DVec3 {
        let sum: DVec3 = (0..3).map(|k| weights[k] * self.corners[HalfedgeId::new(face, k).index()]).sum();
        sum.normalize_or(self.faces[face])
    }

    /// The normal whose side is that of the surface, also at edges and vertices (\[Baerentzen2005\]).
    fn pseudonormal(&self, near: &ClosestPoint) -> DVec3 {
        let (face, w) = (near.face, near.barycentric);
        let same = |f: &FaceId| self.of[*f] == self.of[face];
        if let Some(k) = w.iter().position(|&x| x >= 1.0) {
            let v = self.mesh.corners(face)[k];
            let own = self.mesh.ring(v).map(HalfedgeId::face).filter(same);
            return mesh_core::one_sided_normal(self.mesh, v, own);
        }
        let twin = w.iter().position(|&x| x <= 0.0).and_then(|k| self.mesh.twin(HalfedgeId::new(face, (k + 1) % 3)));
        self.faces[face] + twin.map(HalfedgeId::face).filter(same).map_or(DVec3::ZERO, |f| self.faces[f])
    }
}

/// The angle-weighted normal at a corner over the faces around it that are of its side and not bent away. The slivers
/// of a boolean's seam have no say in which those are.
fn corner_normal(mesh: &Connected<TriMesh>, of: &FaceMap<u8>, faces: &FaceMap<DVec3>, h: HalfedgeId) -> DVec3 {
    let (own, v) = (h.face(), mesh.tail(h));
    let area = |f: FaceId| mesh_core::area_vector(mesh.triangle(f));
    let mut reference = faces[own];
    let longest = own.halfedges().map(|h| side_squared(mesh, h)).into_iter().fold(0.0, f64::max);
    if area(own).length() < SLIVER * longest {
        let around = mesh.ring(v).map(HalfedgeId::face).filter(|f| of[*f] == of[own]);
        reference = around.map(area).sum::<DVec3>().normalize_or(reference);
    }
    let alike = |f: &FaceId| of[*f] == of[own] && faces[*f].dot(reference) >= CREASE.cos();
    let sum: DVec3 = mesh
        .ring(v)
        .filter(|g| alike(&g.face()))
        .map(|g| corner_angle(mesh.triangle(g.face()), g.corner()) * faces[g.face()])
        .sum();
    sum.normalize_or(reference)
}

fn side_squared(mesh: &Connected<TriMesh>, h: HalfedgeId) -> f64 {
    mesh.position(mesh.tail(h)).distance_squared(mesh.position(mesh.head(h)))
}

/// Two colours for what the curves divide the mesh into.
fn colour(mesh: &Connected<TriMesh>, curves: &[BlendCurve]) -> Result<FaceMap<u8>, Trouble> {
    let mut wall = vec![false; 3 * mesh.face_count()];
    for h in curves.iter().flat_map(|c| &c.halfedges) {
        wall[h.index()] = true;
        if let Some(t) = mesh.twin(*h) {
            wall[t.index()] = true;
        }
    }
    let mut of = FaceMap::filled(mesh.face_count(), 2u8);
    for seed in curves.iter().filter_map(|c| c.halfedges.first()).map(|h| h.face()) {
        if of[seed] != 2 {
            continue;
        }
        of[seed] = 0;
        let mut queue = VecDeque::from([seed]);
        while let Some(f) = queue.pop_front() {
            for h in f.halfedges() {
                let Some(t) = mesh.twin(h) else { continue };
                let colour = if wall[h.index()] { 1 - of[f] } else { of[f] };
                if of[t.face()] == 2 {
                    of[t.face()] = colour;
                    queue.push_back(t.face());
                } else if of[t.face()] != colour {
                    let at = mesh.position(mesh.tail(h));
                    return Err(Trouble::at("the curves do not divide the surface into two sides", vec![at]));
                }
            }
        }
    }
    Ok(of)
}

/// The vertices between faces of both sides.
pub(crate) fn between<M: Adjacency>(mesh: &M, of: &FaceMap<u8>) -> Vec<VertexId> {
    let mixed = |v: &VertexId| {
        let mut around = mesh.ring(*v).map(|h| of[h.face()]);
        around.next().is_some_and(|first| around.any(|s| s != first))
    };
    mesh.vertex_ids().filter(mixed).collect()
}
