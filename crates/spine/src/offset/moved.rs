//! A base patch moved along its normals.

use super::OffsetKeep;
use crate::patch::Patch;
use crate::radius::RadiusField;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, EdgeId, FaceId, HalfedgeId, IdSet, Positions, SurfacePoint, TriMesh, VertexId, collinear,
    corner_angle, face_normal,
};

/// A base patch as a mesh of its own, and its offset with the same triangles.
pub(crate) struct MovedPatch {
    base: TriMesh,
    pub offset: Connected<TriMesh>,
}

/// Largest multiple of r that a vertex is moved to keep faces at r: mitres beyond the corner of a cube are cut short.
const LONGEST_MITRE: f64 = 2.0;

impl MovedPatch {
    /// Moves the patch by the radius, outward for `side` = 1, inward for −1. Normals at the blend curve and at the
    /// patch's rim are those of the patch's own faces.
    ///
    /// Triangles that lose all area are left out. `None` when the faces form no manifold, which those of a manifold do.
    pub fn new<M: Adjacency + Positions>(
        mesh: &M,
        patch: &Patch,
        barriers: &IdSet<EdgeId>,
        radius: &RadiusField,
        side: f64,
        keep: OffsetKeep,
    ) -> Option<Self> {
        let fans = Fans::of(mesh, &patch.faces, barriers);
        let base: Vec<DVec3> = fans.vertices.iter().map(|fan| mesh.position(mesh.tail(fan[0]))).collect();
        let moved: Vec<DVec3> = fans
            .vertices
            .iter()
            .zip(&base)
            .map(|(fan, &p)| {
                let direction = side * offset_direction(mesh, fan, keep);
                // The field is known at the centre, which is what is sought; its slope is far below 1.
                let distance = (0..4).fold(radius.at(p).0, |r, _| radius.at(p + r * direction).0);
                p + distance * direction
            })
            .collect();
        let solid = |c: &[VertexId; 3]| !collinear(c.map(|v| moved[v.index()])) && c[0] != c[1] && c[1] != c[2];
        let finite = |c: &[VertexId; 3]| c.iter().all(|v| moved[v.index()].is_finite());
        let faces: Vec<[VertexId; 3]> = fans.faces.into_iter().filter(|c| finite(c) && solid(c)).collect();
        let positions = moved.iter().map(|p| if p.is_finite() { *p } else { DVec3::ZERO }).collect();
        let offset = Connected::new(TriMesh { positions, faces: faces.clone() }).ok()?;
        Some(Self { base: TriMesh { positions: base, faces }, offset })
    }

    /// The point of the base patch with the same address.
    pub fn image(&self, p: &SurfacePoint) -> DVec3 {
        p.position(&self.base)
    }

    /// Whether a triangle at the point was turned over by the move: the patch bends more tightly there than the ball.
    pub fn folds_at(&self, p: &SurfacePoint) -> bool {
        p.faces(&self.offset).any(|f| face_normal(&self.base, f).dot(face_normal(self.offset.mesh(), f)) < 0.0)
    }
}

/// By how much, in radii, a vertex moves: its normal over a fan of faces, angle-weighted, scaled as asked.
fn offset_direction<M: Adjacency + Positions>(mesh: &M, fan: &[HalfedgeId], keep: OffsetKeep) -> DVec3 {
    let faces = fan.iter().map(|h| {
        let corners = mesh.triangle(h.face());
        (corner_angle(corners, h.corner()), face_normal(mesh, h.face()))
    });
    let normal = faces.clone().map(|(angle, n)| angle * n).sum::<DVec3>().normalize_or_zero();
    match keep {
        OffsetKeep::Vertices => normal,
        OffsetKeep::Faces => {
            // The least squares of the faces' distances from r.
            let (mut once, mut twice) = (0.0, 0.0);
            for (angle, n) in faces {
                let cosine = n.dot(normal).max(0.0);
                once += angle * cosine;
                twice += angle * cosine * cosine;
            }
            if twice > 0.0 { normal * (once / twice).min(LONGEST_MITRE) } else { normal }
        }
    }
}

/// The vertices of a set of faces, split where faces hang together only across a barrier or by a corner.
struct Fans {
    /// The faces around each, as the halfedges that leave it.
    vertices: Vec<Vec<HalfedgeId>>,
    /// The faces by these vertices, in the order given.
    faces: Vec<[VertexId; 3]>,
}

impl Fans {
    fn of<M: Adjacency>(mesh: &M, faces: &[FaceId], barriers: &IdSet<EdgeId>) -> Self {
        let place = |h: HalfedgeId| faces.binary_search(&h.face()).ok().map(|i| 3 * i + h.corner());
        // The halfedge in the set that is the other side of h, unless a barrier is between.
        let across = |h: HalfedgeId| {
            let twin = mesh.twin(h)?;
            (place(twin).is_some() && !barriers.contains(&mesh.edge(h))).then_some(twin)
        };
        let mut corners = vec![None; 3 * faces.len()];
        let mut vertices = Vec::new();
        for (i, &face) in faces.iter().enumerate() {
            for corner in 0..3 {
                if corners[3 * i + corner].is_some() {
                    continue;
                }
                let first = HalfedgeId::new(face, corner);
                let mut start = first;
                while let Some(before) = across(start).map(HalfedgeId::next).filter(|&h| h != first) {
                    start = before;
                }
                let (id, mut fan, mut here) = (VertexId::from(vertices.len()), vec![], Some(start));
                while let Some(h) = here {
                    fan.push(h);
                    if let Some(k) = place(h) {
                        corners[k] = Some(id);
                    }
                    here = across(h.prev()).filter(|&h| h != start);
                }
                vertices.push(fan);
            }
        }
        let corner = |k: usize| corners[k].unwrap_or(VertexId(0));
        Self { vertices, faces: (0..faces.len()).map(|i| [0, 1, 2].map(|c| corner(3 * i + c))).collect() }
    }
}
