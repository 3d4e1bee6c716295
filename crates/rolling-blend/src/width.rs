//! How wide the sides of a curve are: what no ball's contact points can leave.

use glam::DVec3;
use mesh_core::{Adjacency, Connected, HalfedgeId, Positions, TriMesh, area_vector, dihedral_angle};
use spine::BlendCurve;

/// A side ends at an edge of this dihedral angle, in degrees.
const CREASE: f64 = 25.0;
/// Places along a curve at which its sides are measured.
const PLACES: usize = 9;
/// Where on an edge a walk begins: off its midpoint, since walks from there run into vertices of regular meshes.
const START: f64 = 0.47;
/// Most faces that one walk crosses.
const FARTHEST: usize = 2000;

/// The largest radius whose contact points lie on both sides of a curve everywhere, as if they were plane, and the place that
/// limits it. Walks straight away from the curve on both sides up to the next crease; `None` where no walk meets one.
pub(crate) fn widest_ball(mesh: &Connected<TriMesh>, curve: &BlendCurve) -> Option<(f64, DVec3)> {
    let count = curve.halfedges.len();
    let places = PLACES.min(count);
    let at = |k: usize| curve.halfedges[(2 * k + 1) * count / (2 * places)];
    let radius = |h: HalfedgeId| {
        let [a, b] = mesh.ends(h);
        // A contact point is r·tan(θ/2) away from an edge of the dihedral angle θ.
        let slope = (0.5 * dihedral_angle(mesh, h)?.abs()).tan();
        let sides = [Some(h), mesh.twin(h)].into_iter().flatten();
        let width = sides.filter_map(|side| walk(mesh, side, a.lerp(b, START))).fold(f64::INFINITY, f64::min);
        (width.is_finite() && slope > 0.0).then_some((width / slope, a.midpoint(b)))
    };
    (0..places).filter_map(|k| radius(at(k))).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// How far a walk leads from a point of an edge straight away from it, over the edge's face and those beyond, up to a crease.
fn walk(mesh: &Connected<TriMesh>, start: HalfedgeId, from: DVec3) -> Option<f64> {
    let inward = |h: HalfedgeId| {
        let [a, b] = mesh.ends(h);
        let along = (b - a).normalize_or_zero();
        (along, area_vector(mesh.triangle(h.face())).normalize_or_zero().cross(along))
    };
    let (mut h, mut p, mut length) = (start, from, 0.0);
    let mut direction = inward(h).1;
    for _ in 0..FARTHEST {
        // The first of the two other edges that the walk meets from within.
        let exit = |side: HalfedgeId| {
            let (_, inner) = inward(side);
            let approach = -direction.dot(inner);
            let distance = (p - mesh.ends(side)[0]).dot(inner);
            (approach > 0.0).then(|| (side, (distance / approach).max(0.0)))
        };
        let (out, step) = [h.next(), h.prev()].into_iter().filter_map(exit).min_by(|a, b| a.1.total_cmp(&b.1))?;
        p += step * direction;
        length += step;
        let twin = mesh.twin(out);
        let Some(next) = twin.filter(|_| dihedral_angle(mesh, out).is_some_and(|a| a.to_degrees().abs() < CREASE))
        else {
            return Some(length);
        };
        // Unfolded: the direction keeps its angle with the edge.
        let ((along, inner), (_, beyond)) = (inward(out), inward(next));
        direction = direction.dot(along) * along - direction.dot(inner) * beyond;
        // The twin runs the other way, and what is inward there leads on.
        direction = direction.normalize_or_zero();
        h = next;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::{self, feature_curves};
    use mesh_core::shapes;

    #[test]
    fn sides_end_at_creases() {
        let size = DVec3::new(1.0, 2.0, 3.0);
        for mesh in [shapes::cuboid(size), shapes::cuboid_grid(size, [5, 7, 11])] {
            let mesh = Connected::new(mesh).unwrap();
            for curve in feature_curves(&mesh, &features::Params::default()) {
                let curve = BlendCurve::from(curve);
                let [a, b] = mesh.ends(curve.halfedges[0]);
                let across = size.to_array().into_iter().zip((b - a).to_array()).filter(|s| s.1 == 0.0).map(|s| s.0);
                let found = widest_ball(&mesh, &curve).unwrap().0;
                assert!((found / across.fold(f64::INFINITY, f64::min) - 1.0).abs() < 1e-9, "{found}");
            }
        }
        // Round the drum and back to the other rim: the wall is as high as it is.
        let drum = Connected::new(shapes::cylinder(1.0, 0.5, 64, 3)).unwrap();
        let curve = &feature_curves(&drum, &features::Params::default())[0];
        let curve = BlendCurve { halfedges: curve.halfedges.clone(), closed: true };
        assert!((widest_ball(&drum, &curve).unwrap().0 - 0.5).abs() < 0.01);
    }
}
