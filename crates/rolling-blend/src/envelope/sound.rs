//! What passes every other check and no eye: an envelope that folds, a wall that the ball cuts away, a gap that it plugs.

use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, area_vector, dihedral_angle, face_normal,
};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// A turn between two faces of the envelope that is a fold, in radians: 95 degrees.
const FOLD: f64 = 1.66;
/// Behind each point of an envelope lies a ball: what stands nearer than this, in radii, and faces it is the other side of
/// a wall, or of a gap, that has room for none.
const ROOM: f64 = 1.6;
/// Cosine from which on two faces look at each other.
const FACING: f64 = 0.7;
/// Area of a face that tells which way the surface looks, in squared radii: that of a tenth of the usual face.
const PLAIN: f64 = 4e-3;
/// What is said of walls and gaps.
pub(crate) const TOO_NARROW: &str = "a wall or gap here is narrower than the ball";

/// Refuses a surface that turns back on itself: no envelope does between edges as short as these. `first` is the first of the
/// faces that are drawn.
pub(super) fn unfolded(mesh: &TriMesh, first: usize) -> Result<(), Trouble> {
    let drawn = TriMesh { positions: mesh.positions.clone(), faces: mesh.faces[first..].to_vec() };
    let drawn = Connected::new(drawn).map_err(Trouble::not_manifold("the blend pinches"))?;
    let folded = |&h: &HalfedgeId| {
        drawn.twin(h).is_some_and(|t| h < t) && dihedral_angle(&drawn, h).is_some_and(|a| a.abs() > FOLD)
    };
    let places: Vec<DVec3> = drawn.halfedge_ids().filter(folded).map(|h| drawn.position(drawn.tail(h))).collect();
    if places.is_empty() { Ok(()) } else { Err(Trouble::at("the blend folds", places)) }
}

/// Refuses a surface behind which a ball of radius `r` has no room. `sign` is 1 where it rolls outside the solid, −1 inside;
/// `first` as above.
pub(super) fn roomy(mesh: &TriMesh, first: usize, r: f64, sign: f64) -> Result<(), Trouble> {
    let tree = TriBvh::build(mesh).map_err(|e| Trouble::Spine(e.into()))?;
    let crowded = |&f: &FaceId| {
        let area = area_vector(mesh.triangle(f));
        let towards = sign * area.normalize_or_zero();
        let middle = mesh.triangle(f).iter().sum::<DVec3>() / 3.0;
        let faces = |g: FaceId| face_normal(mesh, g).dot(towards) * sign < -FACING;
        area.length() > PLAIN * r * r
            && tree.ray_cast(mesh, middle + 1e-3 * r * towards, towards, ROOM * r).is_some_and(|hit| faces(hit.face))
    };
    let drawn: Vec<FaceId> = (first..mesh.faces.len()).map(FaceId::from).collect();
    let crowded: Vec<FaceId> = drawn.into_par_iter().with_min_len(16).filter(crowded).collect();
    let places: Vec<DVec3> = crowded.into_iter().map(|f| mesh.triangle(f)[0]).collect();
    if places.is_empty() { Ok(()) } else { Err(Trouble::at(TOO_NARROW, places)) }
}
