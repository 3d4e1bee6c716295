//! Mean curvature by cotangent weights \[MeyerDesbrunSchroderBarr2003\].

use crate::normals::Fans;
use glam::DVec3;
use mesh_core::{TriMesh, VertexId};

/// Mean curvature at each vertex, one over length, positive where the surface bulges along its normal; 0 at vertices
/// on a boundary, where the surface has none to speak of, and at vertices of degenerate faces only. O(n).
pub(crate) fn mean_curvature(mesh: &TriMesh) -> Vec<f64> {
    let count = mesh.positions.len();
    let (mut laplacian, mut area, mut normal) = (vec![DVec3::ZERO; count], vec![0.0; count], vec![DVec3::ZERO; count]);
    for face in &mesh.faces {
        let p = face.map(|v| mesh.positions[v.index()]);
        let twice = (p[1] - p[0]).cross(p[2] - p[0]);
        let double_area = twice.length();
        if double_area == 0.0 {
            continue;
        }
        let cotangents = [0, 1, 2].map(|k| (p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]) / double_area);
        let obtuse = cotangents.iter().position(|&c| c < 0.0);
        for k in 0..3 {
            let (i, j) = (face[(k + 1) % 3].index(), face[(k + 2) % 3].index());
            let edge = p[(k + 2) % 3] - p[(k + 1) % 3];
            // Needles have cotangents beyond measure; clamped, they only blur.
            let pull = 0.5 * cotangents[k].clamp(-100.0, 100.0) * edge;
            laplacian[i] += pull;
            laplacian[j] -= pull;
            // The vertex's share of the face: its Voronoi region, or fixed parts where that would leave the face.
            if let Some(obtuse) = obtuse {
                area[face[k].index()] += double_area * if k == obtuse { 0.25 } else { 0.125 };
            } else {
                let share = 0.125 * cotangents[k] * edge.length_squared();
                area[i] += share;
                area[j] += share;
            }
            normal[face[k].index()] += twice;
        }
    }
    let fans = Fans::new(mesh);
    (0..count)
        .map(|v| {
            let n = normal[v].normalize_or_zero();
            let h = -0.5 * laplacian[v].dot(n) / area[v];
            if h.is_finite() && !on_boundary(mesh, &fans, v) { h } else { 0.0 }
        })
        .collect()
}

/// Whether an edge at the vertex has only one face.
fn on_boundary(mesh: &TriMesh, fans: &Fans, v: usize) -> bool {
    let mut ends: Vec<VertexId> = fans
        .corners(v)
        .iter()
        .flat_map(|&corner| [1, 2].map(|k| mesh.faces[corner as usize / 3][(corner as usize + k) % 3]))
        .collect();
    ends.sort_unstable();
    ends.chunk_by(|a, b| a == b).any(|edge| edge.len() == 1)
}

/// The value that the given share of magnitudes does not exceed; 0 for none.
pub(crate) fn percentile(values: &[f64], share: f64) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|x| x.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    sizes.get((share * sizes.len() as f64) as usize).or(sizes.last()).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::shapes;

    #[test]
    fn a_sphere_is_evenly_curved_outward_and_a_flipped_one_inward() {
        let mut sphere = shapes::icosphere(2.0, 4);
        let spread = |mesh: &TriMesh, expected: f64| {
            mean_curvature(mesh).into_iter().map(|h| (h - expected).abs()).fold(0.0, f64::max)
        };
        assert!(spread(&sphere, 0.5) < 0.01);
        sphere.faces.iter_mut().for_each(|f| f.swap(0, 1));
        assert!(spread(&sphere, -0.5) < 0.01);
    }

    #[test]
    fn the_percentile_is_an_order_statistic() {
        let values: Vec<f64> = (0..100).map(|i| f64::from(i) * if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert_eq!(percentile(&values, 0.95), 95.0);
        assert_eq!(percentile(&[], 0.95), 0.0);
    }
}
