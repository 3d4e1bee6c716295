//! Cotangent weights and vertex areas, with one rule for degenerate faces.

use glam::DVec3;
use mesh_core::{Adjacency, CornerMap, FaceId, Faces, HalfedgeId, Positions, VertexMap, mixed_areas};
use rayon::prelude::*;

/// A triangle narrower than this share of its longest side counts as that wide.
///
/// Cotangents then stay below about its inverse, so that systems keep half of their digits. Well-shaped triangles keep every bit.
pub const NARROWEST: f64 = 1e-4;

/// No vertex has less area than this share of the mean.
pub const LEAST_AREA: f64 = 1e-4;

/// The cotangent of the angle at each corner, by the crate's rule for degenerate faces; 0 where all corners coincide or one is not
/// finite. O(n), parallel.
pub fn cotangents<M: Faces + Positions + Sync>(mesh: &M) -> CornerMap<f64> {
    let faces = (0..mesh.face_count() as u32).into_par_iter();
    let values: Vec<[f64; 3]> = faces.map(|f| triangle_cotangents(mesh.triangle(FaceId(f)))).collect();
    values.into_flattened().into()
}

/// All three shrink by one factor: cutting them off one by one could make the triangle's energy negative.
fn triangle_cotangents(p: [DVec3; 3]) -> [f64; 3] {
    let twice_area = widened(p);
    [0, 1, 2].map(|k| {
        let cotangent = (p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]) / twice_area;
        if cotangent.is_finite() { cotangent } else { 0.0 }
    })
}

/// Twice the area of a triangle, or of one as long and [`NARROWEST`] of that wide.
pub(crate) fn widened(p: [DVec3; 3]) -> f64 {
    let twice_area = (p[1] - p[0]).cross(p[2] - p[0]).length();
    let longest = (0..3).map(|k| p[k].distance_squared(p[(k + 1) % 3])).fold(0.0, f64::max);
    twice_area.max(NARROWEST * longest)
}

/// The weight ½(cot α + cot β) of the edge of `h`, α and β the angles facing it; one term on the boundary
/// (\[PinkallPolthier1993\]). Negative where the edge is not Delaunay.
pub fn cotangent_weight(mesh: &impl Adjacency, cotangents: &CornerMap<f64>, h: HalfedgeId) -> f64 {
    0.5 * (cotangents[h.prev()] + mesh.twin(h).map_or(0.0, |t| cotangents[t.prev()]))
}

/// The share of the surface that belongs to each vertex ([`mixed_areas`]), and no less than [`LEAST_AREA`] of the mean over the vertices
/// that have faces. Square model units; 0 only on a surface without area. O(n), parallel.
pub fn vertex_areas<M: Adjacency + Positions + Sync>(mesh: &M) -> VertexMap<f64> {
    let mut areas = mixed_areas(mesh).into_vec();
    let used = mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_some()).count().max(1);
    let least = LEAST_AREA * areas.iter().sum::<f64>() / used as f64;
    for area in &mut areas {
        *area = area.max(least);
    }
    areas.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Energy ½ Σ cot_k (u_i − u_j)² of a function on a triangle.
    fn energy(cot: [f64; 3], u: [f64; 3]) -> f64 {
        (0..3).map(|k| 0.5 * cot[k] * (u[(k + 1) % 3] - u[(k + 2) % 3]).powi(2)).sum()
    }

    proptest! {
        /// Against the angles themselves, where the triangle is wide; and an energy that is never negative, however thin it is.
        #[test]
        fn cotangents_are_those_of_the_angles(x in prop::array::uniform9(-1.0f64..1.0), thin in 0..12, u in prop::array::uniform3(-1.0f64..1.0)) {
            let squeeze = DVec3::new(1.0, 0.1f64.powi(thin), 0.1f64.powi(thin));
            let p = [0, 3, 6].map(|i| squeeze * DVec3::new(x[i], x[i + 1], x[i + 2]));
            let cot = triangle_cotangents(p);
            let angle = |k: usize| (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k]);
            if (0..3).all(|k| angle(k) > 1e-2) {
                for (k, c) in cot.into_iter().enumerate() {
                    prop_assert!((c - angle(k).tan().recip()).abs() < 1e-9 * (1.0 + c * c), "{c} {}", angle(k));
                }
            }
            prop_assert!(cot.iter().all(|c| c.abs() <= 1.01 / NARROWEST));
            prop_assert!(energy(cot, u) >= -1e-9 * cot.iter().map(|c| c.abs()).sum::<f64>());
        }
    }
}
