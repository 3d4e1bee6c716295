//! What the ball cannot reach: a scalar on a refined copy of the mesh, flooded from the blend curves.

use super::centre::Ground;
use super::patches::to_segment;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId, dihedral_angle,
};
use mesh_query::TriBvh;
use rayon::prelude::*;
use spine::BlendCurve;
use std::collections::HashMap;

/// Longest edges of the copy near the curves, in radii.
const FINE: f64 = 0.3;
/// How far beyond the contacts of a ball between two planes the copy is fine, in radii, and the longest such reach.
const MARGIN: f64 = 0.6;
const FARTHEST: f64 = 8.0;
/// The scalar of what is taken in.
const TAKEN: f64 = -0.05;
/// A face that is touched as near as this to the foot, in radii, does not block the ball.
const BESIDE: f64 = 2e-3;

/// A refined copy of a mesh around its blend curves.
pub(super) struct Fine {
    pub mesh: Connected<TriMesh>,
    pub origins: Origins,
    /// For each halfedge of the copy, the halfedge of the mesh that it is a part of.
    pub edge_of: Vec<Option<HalfedgeId>>,
    /// The scalar of a vertex as the faces of one patch see it: they must agree, whichever is asked.
    known: HashMap<(VertexId, u32), f64>,
}

/// What of a refined copy lies under the ball.
pub(super) struct Marked<'a> {
    pub fine: &'a Connected<TriMesh>,
    pub origins: &'a Origins,
    pub edge_of: &'a [Option<HalfedgeId>],
    /// The scalar at the corners of each face, in radii: negative under the ball; `None` away from the curves.
    pub corners: Vec<Option<[f64; 3]>>,
    /// What was taken off the scalars.
    pub level: f64,
}

impl Fine {
    /// The copy around `curves`, fine enough for a ball of radius `r`.
    pub fn around(ground: &Ground<'_>, curves: &[BlendCurve], r: f64) -> Result<Self, Trouble> {
        let (fine, origins) = refined(ground.mesh, curves, r)?;
        let mesh = Connected::new(fine).map_err(Trouble::not_manifold("the mesh is not a manifold"))?;
        let edge_of = mesh.halfedge_ids().map(|h| on_edge(ground.mesh, &mesh, &origins, h)).collect();
        Ok(Self { mesh, origins, edge_of, known: HashMap::new() })
    }

    /// Marks what a ball of radius `r` on the ground's side cannot reach. `chosen` are the halfedges of the curves, both of
    /// each edge. Scalars up to `level` count as inside.
    pub fn mark(&mut self, ground: &Ground<'_>, chosen: &[bool], r: f64, level: f64) -> Marked<'_> {
        let Self { mesh: fine, origins, edge_of, known } = self;
        let is_chosen = |h: HalfedgeId| edge_of[h.index()].is_some_and(|e| chosen[e.index()]);
        let is_barrier = |h: HalfedgeId| edge_of[h.index()].is_some_and(|e| !chosen[e.index()] && ground.ends_marks(e));
        let key = |f: FaceId, v: VertexId| (v, ground.patches.of(parent(origins, f)));
        let mut corners: Vec<Option<[f64; 3]>> = vec![None; fine.face_count()];
        let mut front: Vec<FaceId> = fine.halfedge_ids().filter(|&h| is_chosen(h)).map(HalfedgeId::face).collect();
        while !front.is_empty() {
            front.sort_unstable();
            front.dedup();
            let unknown = |&f: &FaceId| fine.corners(f).map(|v| (key(f, v), f));
            let mut asked: Vec<_> =
                front.iter().flat_map(unknown).filter(|(key, _)| !known.contains_key(key)).collect();
            asked.sort_unstable();
            asked.dedup_by_key(|a| a.0);
            let measure =
                |&((v, _), f): &((VertexId, u32), FaceId)| scalar(ground, parent(origins, f), fine.position(v), r);
            let found: Vec<f64> = asked.par_iter().with_min_len(16).map(measure).collect();
            known.extend(asked.iter().zip(found).map(|((key, _), value)| (*key, value)));
            for &f in &front {
                corners[f.index()] = Some(fine.corners(f).map(|v| known[&key(f, v)] - level));
            }
            let mut next = vec![];
            for &f in &front {
                let Some(values) = corners[f.index()] else { continue };
                for h in f.halfedges() {
                    let inside = values[h.corner()] < 0.0 || values[(h.corner() + 1) % 3] < 0.0;
                    let Some(t) = fine.twin(h).filter(|&h| inside && !is_barrier(h)) else { continue };
                    if corners[t.face().index()].is_none() {
                        next.push(t.face());
                    }
                }
            }
            front = next;
        }
        Marked { fine, origins, edge_of, corners, level }
    }
}

impl Marked<'_> {
    /// Takes some vertices in, whatever the ball can reach there. Returns whether that changes anything.
    pub fn take_in(&mut self, ground: &Ground<'_>, vertices: &[VertexId], r: f64) -> bool {
        let mut changed = false;
        for &v in vertices {
            for h in self.fine.ring(v) {
                let face = h.face();
                let value =
                    |w: VertexId| scalar(ground, parent(self.origins, face), self.fine.position(w), r) - self.level;
                let values = self.corners[face.index()].get_or_insert_with(|| self.fine.corners(face).map(value));
                changed |= values[h.corner()] >= 0.0;
                values[h.corner()] = values[h.corner()].min(TAKEN);
            }
        }
        changed
    }
}

/// (d − r)/r, where d is the distance from the ball that rests on `face` at `p` to whatever may block it: negative where it
/// is blocked, and at most 1.
pub(super) fn scalar(ground: &Ground<'_>, face: FaceId, p: DVec3, r: f64) -> f64 {
    let normal = ground.sign * ground.patches.normal(face, p);
    let center = p + r * normal;
    let blocks = |f: FaceId| ground.patches.may_block(face, f);
    let Some(hit) = ground.tree.closest_point_where(ground.mesh, center, 2.0 * r, blocks) else { return 1.0 };
    let out = ground.sign * ground.patches.face_normal(hit.face);
    // Behind a wall that is nearer than the radius the centre is inside it. Seen past an edge a face tells nothing.
    let within = hit.barycentric.iter().all(|w| *w > 0.0);
    let distance = if within && (center - hit.point).dot(out) < 0.0 { 0.0 } else { hit.distance };
    // Past an edge that turns away from the ball, the next patch begins where this one ends: the ball stands there.
    if hit.point.distance(p) < BESIDE * r {
        return 1.0;
    }
    distance / r - 1.0
}

pub(super) fn parent(origins: &Origins, f: FaceId) -> FaceId {
    match origins.faces[f] {
        FaceOrigin::Input { face, .. } | FaceOrigin::Piece { face, .. } => face,
        FaceOrigin::New { .. } => f,
    }
}

/// The halfedge of the mesh that a halfedge of the copy is a part of.
fn on_edge(
    mesh: &Connected<TriMesh>,
    fine: &Connected<TriMesh>,
    origins: &Origins,
    h: HalfedgeId,
) -> Option<HalfedgeId> {
    let own = parent(origins, h.face());
    let corners = mesh.corners(own);
    let [a, b] = [fine.tail(h), fine.head(h)].map(|v| origins.vertices[v].barycentric(corners));
    let (a, b) = (a?, b?);
    // On the side opposite corner k both ends have no share of that.
    (0..3).find(|&k| a[k] == 0.0 && b[k] == 0.0).map(|k| HalfedgeId::new(own, (k + 1) % 3))
}

/// The mesh with short edges as far as the ball may reach from the curves.
fn refined(mesh: &Connected<TriMesh>, curves: &[BlendCurve], r: f64) -> Result<(TriMesh, Origins), Trouble> {
    let edges: Vec<HalfedgeId> = curves.iter().flat_map(|c| c.halfedges.iter().copied()).collect();
    // Each edge as a triangle without area.
    let mut segments = TriMesh::default();
    for (i, &h) in edges.iter().enumerate() {
        segments.positions.extend(mesh.ends(h));
        let first = VertexId::from(2 * i);
        segments.faces.push([first, VertexId::from(2 * i + 1), first]);
    }
    let reach = |&h: &HalfedgeId| {
        let half = 0.5 * dihedral_angle(mesh, h).map_or(0.0, f64::abs);
        r * (half.min(1.5).tan() + MARGIN).min(FARTHEST)
    };
    let reach: Vec<f64> = edges.iter().map(reach).collect();
    let failed = |_| Trouble::at("the surface near the curves cannot be refined", vec![]);
    let tree = TriBvh::build(&segments).map_err(|_| Trouble::at("the curves have no extent", vec![]))?;
    let wanted = |p: DVec3| {
        let near = tree.closest_point(&segments, p);
        near.map_or(f64::INFINITY, |c| {
            let [a, b, _] = segments.triangle(c.face);
            to_segment(p, [a, b]) - reach[c.face.index()]
        })
    };
    remesh::refine(mesh, &wanted, FINE * r).map_err(failed)
}
