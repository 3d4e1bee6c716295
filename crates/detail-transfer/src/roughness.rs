//! How rough a surface is, and at which scales.

use crate::operator::{Diffusion, Operator};
use mesh_core::{Adjacency, Connected, FaceMap, Faces, TriMesh, VertexId, mean_curvature_vectors, vertex_normals};

/// Roughness of a region.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Roughness {
    /// Variance of the mean curvature over the area, in 1/unit².
    pub variance: f64,
    /// The part of the variance between two lengths: from the finest, `scale`·2^k to `scale`·2^(k+1), k = 0…3. What is finer than `scale` is in
    /// none of them, nor what is coarser than 16·`scale`.
    pub bands: [f64; 4],
}

/// Measures the region `inside` of a mesh. Curvature is that of the vertices all of whose faces belong to the region; each band is
/// what a diffusion over twice the length takes from one over the length. O(n^1.5), n vertices of the region.
pub fn roughness(mesh: &Connected<TriMesh>, inside: &FaceMap<bool>, scale: f64) -> Roughness {
    let Ok(patch) = crate::patch::patch(mesh, inside, 0.0, "source") else { return Roughness::default() };
    let own = &patch.mesh;
    let inner = |v: VertexId| !patch.rim[v.index()] && own.ring(v).all(|h| patch.inside[h.face().index()]);
    let inner: Vec<usize> = own.vertex_ids().filter(|&v| inner(v)).map(VertexId::index).collect();
    let (bend, normals) = (mean_curvature_vectors(own), vertex_normals(own));
    let curvature = |v: VertexId| glam::DVec3::X * bend[v].dot(normals[v]);
    let curvature: Vec<glam::DVec3> = own.vertex_ids().map(curvature).collect();
    let operator = Operator::new(own);
    let area: f64 = inner.iter().map(|&i| operator.area(i)).sum();
    let mean = |x: &dyn Fn(usize) -> f64| inner.iter().map(|&i| operator.area(i) * x(i)).sum::<f64>() / area;
    let variance = |x: &[glam::DVec3]| {
        let middle = mean(&|i| x[i].x);
        mean(&|i| (x[i].x - middle).powi(2))
    };
    if inner.is_empty() {
        return Roughness::default();
    }
    let held: Vec<bool> = patch.rim.iter().map(|_| false).collect();
    let smooth = |k: i32| {
        let radius = scale * 2f64.powi(k) / std::f64::consts::TAU;
        let flow = Diffusion::new(&operator, &held, 0.5 * radius * radius);
        flow.map_or_else(|| curvature.clone(), |f| f.step(&f.step(&curvature)))
    };
    let levels: Vec<_> = (0..5).map(smooth).collect();
    let bands = [0, 1, 2, 3].map(|k| {
        let between: Vec<_> = levels[k].iter().zip(&levels[k + 1]).map(|(a, b)| *a - *b).collect();
        variance(&between)
    });
    Roughness { variance: variance(&curvature), bands }
}
