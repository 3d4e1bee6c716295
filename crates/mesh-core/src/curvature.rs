//! Mixed areas and mean-curvature vectors.

use crate::ids::VertexId;
use crate::map::VertexMap;
use crate::traits::{Adjacency, Positions};
use glam::DVec3;
use rayon::prelude::*;

/// The cotangent of the angle at each corner; 0 where a triangle has no area.
fn triangle_cotangents(p: [DVec3; 3]) -> [f64; 3] {
    let twice_area = (p[1] - p[0]).cross(p[2] - p[0]).length();
    [0, 1, 2].map(|k| {
        let cotangent = (p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]) / twice_area;
        if cotangent.is_finite() { cotangent } else { 0.0 }
    })
}

/// The share of the surface that belongs to each vertex: Voronoi areas, cut at the middle of obtuse triangles so that
/// they add up to the whole area (\[MeyerDesbrunSchroderBarr2003\]). Square model units. O(n), parallel.
pub fn mixed_areas<M: Adjacency + Positions + Sync>(mesh: &M) -> VertexMap<f64> {
    let area = |v| mesh.ring(VertexId(v)).map(|h| corner_area(turned(mesh.triangle(h.face()), h.corner()))).sum();
    (0..mesh.vertex_count() as u32).into_par_iter().map(area).collect::<Vec<f64>>().into()
}

fn turned(p: [DVec3; 3], k: usize) -> [DVec3; 3] {
    [p[k], p[(k + 1) % 3], p[(k + 2) % 3]]
}

/// The part of a triangle that belongs to its first corner.
fn corner_area(p: [DVec3; 3]) -> f64 {
    let cot = triangle_cotangents(p);
    if cot.iter().all(|&c| c >= 0.0) {
        (p[0].distance_squared(p[1]) * cot[2] + p[0].distance_squared(p[2]) * cot[1]) / 8.0
    } else {
        let area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
        if cot[0] < 0.0 { 0.5 * area } else { 0.25 * area }
    }
}

/// H·n at each vertex, H = (κ₁ + κ₂)/2 in 1/model unit: on a ball of radius R it is the outward normal over R
/// (\[MeyerDesbrunSchroderBarr2003\]). Zero on the boundary, at vertices without area, and where there is no face. O(n), parallel.
pub fn mean_curvature_vectors<M: Adjacency + Positions + Sync>(mesh: &M) -> VertexMap<DVec3> {
    let curvature = |v| {
        let v = VertexId(v);
        let on_boundary = mesh.outgoing(v).is_none_or(|h| mesh.twin(h).is_none());
        let (mut gradient, mut area) = (DVec3::ZERO, 0.0);
        for h in mesh.ring(v).filter(|_| !on_boundary) {
            let p = turned(mesh.triangle(h.face()), h.corner());
            gradient += area_gradient(p);
            area += corner_area(p);
        }
        if area > 0.0 { gradient / (2.0 * area) } else { DVec3::ZERO }
    };
    (0..mesh.vertex_count() as u32).into_par_iter().map(curvature).collect::<Vec<_>>().into()
}

/// How a triangle's area grows as its first corner moves, in cotangents.
fn area_gradient(p: [DVec3; 3]) -> DVec3 {
    let cot = triangle_cotangents(p);
    0.5 * (cot[2] * (p[0] - p[1]) + cot[1] * (p[0] - p[2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, Faces, area, shapes};
    use proptest::prelude::*;

    #[test]
    fn areas_add_up_and_planes_are_flat() {
        let blob = Connected::new(shapes::blob(1.0, 3, 0.6, 4)).unwrap();
        let total: f64 = mixed_areas(&blob).as_slice().iter().sum();
        assert!((total - area(&blob)).abs() < 1e-12 * total);
        let plane = Connected::new(shapes::grid(2.0, 1.0, 7, 5)).unwrap();
        assert!(mean_curvature_vectors(&plane).as_slice().iter().all(|k| k.length() < 1e-12));
    }

    #[test]
    fn balls_and_cylinders_have_their_curvature() {
        let ball = Connected::new(shapes::icosphere(2.0, 4)).unwrap();
        let curvature = mean_curvature_vectors(&ball);
        let error = |v| (curvature[v] - ball.position(v) / 4.0).length();
        assert!(ball.vertex_ids().map(error).fold(0.0, f64::max) < 0.01);
        let tube = Connected::new(shapes::open_cylinder(0.5, 2.0, 60, 40)).unwrap();
        let curvature = mean_curvature_vectors(&tube);
        for v in tube.vertex_ids() {
            let p = tube.position(v);
            if p.z.abs() < 0.99 {
                let out = glam::DVec3::new(p.x, p.y, 0.0).normalize();
                assert!((curvature[v] - out).length() < 0.01, "{}", curvature[v]);
            } else {
                assert_eq!(curvature[v], DVec3::ZERO);
            }
        }
    }

    proptest! {
        /// The cotangent formula is the gradient of the area, found by moving the corner.
        #[test]
        fn cotangents_are_the_areas_gradient(x in prop::array::uniform9(-1.0f64..1.0)) {
            let p = [0, 3, 6].map(|i| DVec3::new(x[i], x[i + 1], x[i + 2]));
            let size = |q: DVec3| 0.5 * (p[1] - q).cross(p[2] - q).length();
            prop_assume!(size(p[0]) > 1e-2);
            let h = 1e-6;
            let slope = DVec3::AXES.map(|e| (size(p[0] + h * e) - size(p[0] - h * e)) / (2.0 * h));
            prop_assert!((area_gradient(p) - DVec3::from(slope)).length() < 1e-6);
            let parts: f64 = (0..3).map(|k| corner_area(turned(p, k))).sum();
            prop_assert!((parts - size(p[0])).abs() < 1e-12);
        }
    }
}
