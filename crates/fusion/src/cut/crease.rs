//! What a path over the surface costs: less in concave creases, where limbs meet (\[LeeLee2002\]).

use mesh_core::{
    Adjacency, Connected, Faces, HalfedgeId, TriMesh, VertexId, corner_angle, mean_curvature_vectors, mixed_areas,
    vertex_normals,
};

/// Curvature is averaged over this share of the diagonal, so that noise attracts nothing.
const SCALE: f64 = 0.01;
/// Rounds of averaging, at least and at most.
const ROUNDS: [f64; 2] = [3.0, 60.0];
/// Which share of the concave vertices is flatter than a crease.
const CREASE: f64 = 0.9;

/// The cost of a unit of length at every vertex: 1 on flat and convex places, 1 / (1 + `strength`) in creases, less in sharper ones. A
/// strength of 0 gives plain length. O(n log n).
///
/// A place is as concave as its least principal curvature is negative: a waist is, although its mean curvature is positive.
pub(super) fn weights(mesh: &Connected<TriMesh>, strength: f64) -> Vec<f64> {
    let (vectors, normals, areas) = (mean_curvature_vectors(mesh), vertex_normals(mesh), mixed_areas(mesh));
    // Scans that are inside out are scissored all the same.
    let out = if enclosed(mesh) < 0.0 { -1.0 } else { 1.0 };
    let mean: Vec<f64> = mesh.vertex_ids().map(|v| out * vectors[v].dot(normals[v])).collect();
    let defect = |v: VertexId| {
        let inside = mesh.outgoing(v).is_some_and(|h| mesh.twin(h).is_some()) && areas[v] > 0.0;
        let angle = |h: HalfedgeId| corner_angle(mesh.mesh().triangle(h.face()), h.corner());
        if inside { (std::f64::consts::TAU - mesh.ring(v).map(angle).sum::<f64>()) / areas[v] } else { 0.0 }
    };
    let gauss: Vec<f64> = mesh.vertex_ids().map(defect).collect();
    let size = mesh_core::bounds(mesh).diagonal();
    // Averaging spreads as the root of the rounds.
    let edge = (2.3 * mesh_core::area(mesh) / mesh.face_count().max(1) as f64).sqrt();
    let rounds = (SCALE * size / edge).powi(2).clamp(ROUNDS[0], ROUNDS[1]) as usize;
    let [mean, gauss] = [mean, gauss].map(|values| averaged(mesh, values, rounds));
    let hollow: Vec<f64> = mean.iter().zip(&gauss).map(|(h, k)| (h * h - k).max(0.0).sqrt() - h).collect();
    let mut concave: Vec<f64> = hollow.iter().copied().filter(|h| *h > 0.0).collect();
    concave.sort_by(f64::total_cmp);
    // On a convex body what is left is rounding.
    let Some(&crease) = concave.get((CREASE * concave.len() as f64) as usize).filter(|c| **c * size > 1e-3) else {
        return vec![1.0; hollow.len()];
    };
    hollow.iter().map(|h| 1.0 / (1.0 + strength * (h / crease).clamp(0.0, 2.0))).collect()
}

/// The volume between the faces and the middle of the box.
fn enclosed(mesh: &Connected<TriMesh>) -> f64 {
    let center = mesh_core::bounds(mesh).center();
    let cone = |f| {
        let [a, b, c] = mesh.mesh().triangle(f).map(|p| p - center);
        a.dot(b.cross(c))
    };
    mesh.face_ids().map(cone).sum()
}

/// The values after some rounds of averaging with the neighbours.
fn averaged(mesh: &Connected<TriMesh>, mut values: Vec<f64>, rounds: usize) -> Vec<f64> {
    values.iter_mut().filter(|x| !x.is_finite()).for_each(|x| *x = 0.0);
    for _ in 0..rounds {
        let average = |v: VertexId| {
            let around = mesh.ring(v).map(|h| values[mesh.head(h).index()]);
            let (sum, count) = around.fold((values[v.index()], 1.0), |(s, n), x| (s + x, n + 1.0));
            sum / count
        };
        values = mesh.vertex_ids().map(average).collect();
    }
    values
}
