//! Colours of new surfaces, blended from around them.

use glam::DVec4;
use mesh_core::{
    Adjacency, Connected, CornerMap, FaceId, FaceOrigin, Faces, HalfedgeId, TriMesh, VertexId, VertexOrigin,
    components, split,
};
use param_conformal::{Harmonic, Weights};

/// Gives the corners of `new` faces the colours of the surfaces they are welded to, blended smoothly: harmonic with equal weights, so that no colour
/// lies outside of those around. What is welded to nothing coloured stays as it is. O(n^1.5) in the new vertices.
pub(crate) fn spread(mesh: &TriMesh, colors: &mut CornerMap<[f64; 4]>, new: impl Fn(FaceId) -> bool) {
    let mut names = vec![u32::MAX; mesh.vertex_count()];
    let mut vertices: Vec<VertexId> = mesh.face_ids().filter(|&f| new(f)).flat_map(|f| mesh.corners(f)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.iter().zip(0..).for_each(|(v, i)| names[v.index()] = i);
    // A vertex of several colours, at a seam, counts with their mean.
    let mut around = vec![(DVec4::ZERO, 0.0); vertices.len()];
    for f in mesh.face_ids().filter(|&f| !new(f)) {
        for (k, v) in mesh.corners(f).into_iter().enumerate() {
            let color = DVec4::from(colors[HalfedgeId::new(f, k)]);
            if names[v.index()] != u32::MAX && color.is_finite() {
                let sum = &mut around[names[v.index()] as usize];
                *sum = (sum.0 + color, sum.1 + 1.0);
            }
        }
    }
    let faces: Vec<FaceId> = mesh.face_ids().filter(|&f| new(f)).collect();
    let own = TriMesh {
        positions: vertices.iter().map(|v| mesh.positions[v.index()]).collect(),
        faces: faces.iter().map(|&f| mesh.corners(f).map(|v| VertexId(names[v.index()]))).collect(),
    };
    // Surfaces that touch at a vertex are each their own.
    let (own, copies) = split(&own);
    let colour_at = |origin: &VertexOrigin| match origin {
        VertexOrigin::Input { vertex, .. } => around[vertex.index()],
        _ => (DVec4::ZERO, 0.0),
    };
    let around: Vec<(DVec4, f64)> = copies.vertices.as_slice().iter().map(colour_at).collect();
    let parent = |f: FaceId| match copies.faces[f] {
        FaceOrigin::Input { face, .. } => faces[face.index()],
        _ => faces[f.index()],
    };
    let parts = components(&own);
    let mut colored = vec![false; parts.len()];
    for f in own.face_ids() {
        colored[parts.labels[f] as usize] |= own.corners(f).iter().any(|v| around[v.index()].1 > 0.0);
    }
    let kept = |f: &FaceId| colored[parts.labels[*f] as usize];
    let (faces, corners): (Vec<FaceId>, Vec<_>) =
        own.face_ids().filter(kept).map(|f| (parent(f), own.corners(f))).unzip();
    let Ok(own) = Connected::new(TriMesh { positions: own.positions, faces: corners }) else { return };
    let held: Vec<VertexId> = own
        .vertex_ids()
        .filter(|v| around[v.index()].1 > 0.0 && own.outgoing(*v).is_some_and(|h| own.twin(h).is_none()))
        .collect();
    let values: Vec<[f64; 4]> = held.iter().map(|v| around[v.index()]).map(|(sum, n)| (sum / n).to_array()).collect();
    let Ok(harmonic) = Harmonic::with_weights(&own, &held, Weights::Uniform) else { return };
    let found = harmonic.solve(&values);
    // A mean of equal numbers may be rounded beyond them.
    let range = [0, 1, 2, 3].map(|k| {
        values.iter().map(|v| v[k]).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    });
    let within = |color: [f64; 4]| [0, 1, 2, 3].map(|k| color[k].max(range[k].0).min(range[k].1));
    for (&f, corners) in faces.iter().zip(&own.mesh().faces) {
        for (k, &v) in corners.iter().enumerate() {
            colors[HalfedgeId::new(f, k)] = within(found[v]);
        }
    }
}
