//! The part of a large mesh that a blend can touch: the blend is made on it alone and put back into the rest, so that its
//! cost is that of the vicinity and two passes over the mesh.

use crate::blended::Blended;
use crate::params::Params;
use glam::DVec3;
use mesh_core::{
    Adjacency, Bounds, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId,
    VertexOrigin,
};
use rayon::prelude::*;
use spine::BlendCurve;

/// Meshes of fewer faces are blended whole, and those of which more than this part is near the curves.
const LARGE: usize = 20_000;
const PART: usize = 3;
/// How far the vicinity reaches from the curves, in radii. Most balls keep to two; where one goes farther, the blend does
/// not hold, and the whole mesh is taken.
const MARGIN: f64 = 5.0;
/// Into how many boxes the curves are divided.
const BOXES: usize = 32;
const NONE: VertexId = VertexId(u32::MAX);

/// A part of a mesh as a mesh of its own, with the curves in it.
pub(crate) struct Vicinity<'a> {
    whole: &'a Connected<TriMesh>,
    pub mesh: Connected<TriMesh>,
    pub curves: Vec<BlendCurve>,
    /// Faces that overlap none of them are not in the part.
    boxes: Vec<Bounds>,
    /// The faces and vertices in the whole mesh, in order.
    faces: Vec<FaceId>,
    vertices: Vec<VertexId>,
}

/// The vicinity of `curves`; `None` if the whole mesh serves as well. O(n) for n faces.
pub(crate) fn vicinity<'a>(
    whole: &'a Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
) -> Option<Vicinity<'a>> {
    if whole.face_count() < LARGE {
        return None;
    }
    let boxes = boxes_along(whole, curves, MARGIN * params.radius);
    let around = boxes.iter().fold(Bounds::EMPTY, |a, b| a.union(*b));
    let near = |f: usize| {
        let own = Bounds::of(whole.triangle(FaceId::from(f)));
        around.overlaps(&own) && boxes.iter().any(|b| b.overlaps(&own))
    };
    let mut inside: Vec<bool> = (0..whole.face_count()).into_par_iter().map(near).collect();
    let mut faces = ids_of(&inside);
    if faces.len() * PART > whole.face_count() {
        return None;
    }
    while widen_at_pinches(whole, &faces, &mut inside) {
        faces = ids_of(&inside);
    }
    let mut local = vec![NONE; whole.vertex_count()];
    faces.iter().flat_map(|&f| whole.corners(f)).for_each(|v| local[v.index()] = v);
    let vertices: Vec<VertexId> = local.iter().copied().filter(|&v| v != NONE).collect();
    vertices.iter().enumerate().for_each(|(i, v)| local[v.index()] = VertexId::from(i));
    let corners = |&f: &FaceId| whole.corners(f).map(|v| local[v.index()]);
    let mesh = TriMesh {
        positions: vertices.iter().map(|&v| whole.position(v)).collect(),
        faces: faces.iter().map(corners).collect(),
    };
    let halfedge = |h: &HalfedgeId| {
        let face = faces.binary_search(&h.face()).ok()?;
        Some(HalfedgeId::from(3 * face + h.corner()))
    };
    let moved = |c: &BlendCurve| {
        Some(BlendCurve { halfedges: c.halfedges.iter().map(halfedge).collect::<Option<_>>()?, closed: c.closed })
    };
    let curves = curves.iter().map(moved).collect::<Option<_>>()?;
    Some(Vicinity { whole, mesh: Connected::new(mesh).ok()?, curves, boxes, faces, vertices })
}

/// Boxes around stretches of the curves, wider than those by `margin`.
fn boxes_along(mesh: &Connected<TriMesh>, curves: &[BlendCurve], margin: f64) -> Vec<Bounds> {
    let halfedges: Vec<HalfedgeId> = curves.iter().flat_map(|c| c.halfedges.iter().copied()).collect();
    let ends = |h: &HalfedgeId| mesh.ends(*h);
    let stretch = halfedges.len().div_ceil(BOXES).max(1);
    halfedges.chunks(stretch).map(|c| Bounds::of(c.iter().flat_map(ends)).inflated(margin)).collect()
}

fn ids_of(inside: &[bool]) -> Vec<FaceId> {
    (0..inside.len()).filter(|&f| inside[f]).map(FaceId::from).collect()
}

/// Takes in all faces around vertices at which the part would fall into several fans. Returns whether there were any.
fn widen_at_pinches(mesh: &Connected<TriMesh>, faces: &[FaceId], inside: &mut [bool]) -> bool {
    let opens = |inside: &[bool], h: HalfedgeId| mesh.twin(h).is_none_or(|t| !inside[t.face().index()]);
    let rim = faces.iter().flat_map(|f| f.halfedges());
    let pinched: Vec<VertexId> = rim
        .filter(|&h| opens(inside, h))
        .map(|h| mesh.tail(h))
        .filter(|&v| mesh.ring(v).filter(|&h| inside[h.face().index()] && opens(inside, h)).count() > 1)
        .collect();
    for h in pinched.iter().flat_map(|&v| mesh.ring(v)) {
        inside[h.face().index()] = true;
    }
    !pinched.is_empty()
}

impl Vicinity<'_> {
    /// Whether a blend of the part is one of the whole: what is new lies where no face outside the part does, and what
    /// the part shares with the rest is untouched.
    pub fn holds(&self, blended: &Blended) -> bool {
        let mut unshared = vec![true; self.mesh.vertex_count()];
        for h in self.mesh.halfedge_ids().filter(|&h| self.mesh.twin(h).is_none()) {
            let outer = HalfedgeId::new(self.faces[h.face().index()], h.corner());
            if self.whole.twin(outer).is_some() {
                unshared[self.mesh.tail(h).index()] = false;
                unshared[self.mesh.head(h).index()] = false;
            }
        }
        let at_rim = |f: FaceId| !self.mesh.corners(f).iter().all(|v| unshared[v.index()]);
        let rim_faces = self.mesh.face_ids().filter(|&f| at_rim(f)).count();
        let origins = (0..blended.mesh.faces.len()).map(FaceId::from).map(|f| (f, blended.origins.faces[f]));
        let kept = |(_, o): &(FaceId, FaceOrigin)| matches!(*o, FaceOrigin::Input { face, .. } if at_rim(face));
        let clear = |f: FaceId| {
            let own = Bounds::of(blended.mesh.triangle(f));
            self.boxes.iter().any(|b| own.min.cmpge(b.min).all() && own.max.cmple(b.max).all())
        };
        origins.clone().filter(kept).count() == rim_faces
            && origins.filter(|(_, o)| matches!(o, FaceOrigin::New { .. })).all(|(f, _)| clear(f))
    }

    /// The whole mesh with the part's blend: first the vertices and faces that stay as they are, in their order, then
    /// pieces and new ones as in `blended`.
    pub fn put_back(&self, blended: Blended) -> Blended {
        let part = &blended.origins;
        let Numbering { staying, added, of_whole, of_part } = self.number_vertices(&blended);
        let (kept, changed) = self.sort_faces(&blended);

        let position = |v: &VertexId| self.whole.position(*v);
        let positions: Vec<DVec3> =
            staying.par_iter().map(position).chain(added.par_iter().map(|&v| blended.mesh.position(v))).collect();
        let old = kept.par_iter().map(|&f| self.whole.corners(f).map(|v| of_whole[v.index()]));
        let new = changed.par_iter().map(|&f| blended.mesh.corners(f).map(|v| of_part[v.index()]));
        let same = staying.par_iter().map(|&vertex| VertexOrigin::Input { part: 0, vertex });
        let vertices: Vec<_> = same.chain(added.par_iter().map(|&v| self.vertex(part.vertices[v]))).collect();
        let same = kept.par_iter().map(|&face| FaceOrigin::Input { part: 0, face });
        let faces: Vec<_> = same.chain(changed.par_iter().map(|&f| self.face(part.faces[f]))).collect();
        let from_last = blended.mesh.faces.len() - blended.first_blend_face.index();
        Blended {
            first_blend_face: FaceId::from(faces.len().saturating_sub(from_last)),
            mesh: TriMesh { positions, faces: old.chain(new).collect() },
            origins: Origins { vertices: vertices.into(), faces: faces.into() },
            ..blended
        }
    }

    /// Which vertices the result has, and their numbers there.
    fn number_vertices(&self, blended: &Blended) -> Numbering {
        let whole_vertex = |v: VertexId| match blended.origins.vertices[v] {
            VertexOrigin::Input { vertex, .. } => Some(self.vertices[vertex.index()]),
            _ => None,
        };
        let inner = || blended.mesh.vertex_ids();
        let mut stays = vec![true; self.whole.vertex_count()];
        self.vertices.iter().for_each(|v| stays[v.index()] = false);
        inner().filter_map(whole_vertex).for_each(|v| stays[v.index()] = true);
        let staying: Vec<VertexId> = self.whole.vertex_ids().filter(|v| stays[v.index()]).collect();
        let mut of_whole = vec![NONE; stays.len()];
        staying.iter().enumerate().for_each(|(i, v)| of_whole[v.index()] = VertexId::from(i));
        let added: Vec<VertexId> = inner().filter(|&v| whole_vertex(v).is_none()).collect();
        let mut of_part: Vec<VertexId> = inner().map(|v| whole_vertex(v).map_or(v, |w| of_whole[w.index()])).collect();
        (staying.len()..).zip(&added).for_each(|(i, v)| of_part[v.index()] = VertexId::from(i));
        Numbering { staying, added, of_whole, of_part }
    }

    /// The faces of the whole that stay as they are, and those of the blended part that take the place of the others.
    fn sort_faces(&self, blended: &Blended) -> (Vec<FaceId>, Vec<FaceId>) {
        let mut keeps = vec![true; self.whole.face_count()];
        self.faces.iter().for_each(|f| keeps[f.index()] = false);
        let mut changed = vec![];
        for f in blended.mesh.face_ids() {
            match blended.origins.faces[f] {
                FaceOrigin::Input { face, .. } => keeps[self.faces[face.index()].index()] = true,
                _ => changed.push(f),
            }
        }
        (ids_of(&keeps), changed)
    }

    /// An origin in the part as one in the whole.
    fn vertex(&self, origin: VertexOrigin) -> VertexOrigin {
        match origin {
            VertexOrigin::Edge { part, ends, t } => {
                VertexOrigin::Edge { part, ends: ends.map(|v| self.vertices[v.index()]), t }
            }
            VertexOrigin::Face { part, face, barycentric } => {
                VertexOrigin::Face { part, face: self.faces[face.index()], barycentric }
            }
            other => other,
        }
    }

    fn face(&self, origin: FaceOrigin) -> FaceOrigin {
        match origin {
            FaceOrigin::Piece { part, face } => FaceOrigin::Piece { part, face: self.faces[face.index()] },
            other => other,
        }
    }
}

/// The vertices of a whole mesh with the part's blend: first those of the whole that stay, then those that were added.
struct Numbering {
    /// In the whole mesh, in order.
    staying: Vec<VertexId>,
    /// In the blended part, in order.
    added: Vec<VertexId>,
    /// What each vertex of the whole is now.
    of_whole: Vec<VertexId>,
    /// What each vertex of the blended part is now.
    of_part: Vec<VertexId>,
}

#[cfg(test)]
mod tests {
    use super::super::{blend, blend_whole};
    use super::*;
    use crate::features::{self, feature_curves, nearest_curve};
    use mesh_core::{Watch, shapes};

    /// A large mesh and the curve of it that is nearest to a point.
    fn with_curve(mesh: TriMesh, near: DVec3) -> (Connected<TriMesh>, Vec<BlendCurve>) {
        let mesh = Connected::new(mesh).unwrap();
        let all = feature_curves(&mesh, &features::Params::default());
        let chosen = &all[nearest_curve(&mesh, &all, near).unwrap().0];
        let curve = BlendCurve { halfedges: chosen.halfedges.clone(), closed: chosen.closed };
        (mesh, vec![curve])
    }

    /// Where each face is and what it came from, in an order that numbering does not touch.
    fn described(blended: &Blended) -> Vec<([[u64; 3]; 3], String)> {
        let bits = |v: VertexId| blended.mesh.position(v).to_array().map(f64::to_bits);
        let describe = |f: FaceId| {
            let mut corners = blended.mesh.corners(f);
            let first = (0..3).min_by_key(|&k| bits(corners[k])).unwrap();
            corners.rotate_left(first);
            let from = (blended.origins.faces[f], corners.map(|v| blended.origins.vertices[v]));
            (corners.map(bits), format!("{from:?}"))
        };
        let mut faces: Vec<_> = blended.mesh.face_ids().map(describe).collect();
        faces.sort();
        faces
    }

    #[test]
    fn a_blend_of_the_vicinity_is_the_blend_of_the_whole() {
        let cube = shapes::cuboid_grid(DVec3::ONE, [60; 3]);
        let post = shapes::cylinder(0.5, 3.0, 200, 80);
        for (mesh, near, radius) in [(cube, DVec3::new(0.5, 0.5, 0.0), 0.02), (post, DVec3::new(0.5, 0.0, 1.5), 0.01)] {
            let ((mesh, curves), params) = (with_curve(mesh, near), Params::new(radius));
            let part = vicinity(&mesh, &curves, &params).expect("a large mesh");
            assert!(part.mesh.face_count() * PART <= mesh.face_count());
            let made = blend(&mesh, &curves, &params, &Watch::default()).unwrap();
            let whole = blend_whole(&mesh, &curves, &params, &Watch::default()).unwrap();
            assert_eq!(described(&made), described(&whole));
            assert_eq!(made.mesh.positions, whole.mesh.positions);
            assert_eq!(made.first_blend_face, whole.first_blend_face);
            Connected::new(&made.mesh).unwrap();
        }
    }

    /// Of a grid of cells, two that meet at a corner: with them come all faces around it.
    #[test]
    fn where_the_part_would_hang_on_one_vertex_it_is_widened() {
        let mesh = Connected::new(shapes::cuboid_grid(DVec3::ONE, [4; 3])).unwrap();
        let corner = mesh.vertex_ids().find(|&v| mesh.ring(v).count() == 6).unwrap();
        let ring: Vec<FaceId> = mesh.ring(corner).map(HalfedgeId::face).collect();
        let mut inside = vec![false; mesh.face_count()];
        for f in [ring[0], ring[3]] {
            inside[f.index()] = true;
        }
        let faces = ids_of(&inside);
        assert!(widen_at_pinches(&mesh, &faces, &mut inside));
        assert!(ring.iter().all(|f| inside[f.index()]));
        let faces = ids_of(&inside);
        assert!(!widen_at_pinches(&mesh, &faces, &mut inside));
    }
}
