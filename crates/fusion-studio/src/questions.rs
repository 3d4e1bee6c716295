//! Questions about a shape.

use crate::frame::{drawing_origin, drawn, revision};
use crate::refusal::Refusal;
use crate::request::{Measure, Of};
use crate::scene::Scene;
use fusion::Info;
use fusion::document::Shown;
use fusion::mesh_core::{
    Connected, FaceId, Faces, Positions, TriMesh, VertexId, Watch, boundary_loops, mean_curvature_vectors,
    triangle_normal, vertex_normals,
};
use glam::DVec3;
use serde_json::{Value, json};

/// Places of crossings that are listed, at most.
const MOST_CROSSINGS: usize = 200;

/// A mesh whose connectivity is known.
///
/// # Errors
/// [`Refusal`], with all that is wrong with it.
pub fn connected(shown: &Shown) -> Result<Connected<TriMesh>, Refusal> {
    Connected::new(shown.model.mesh.clone()).map_err(|e| Refusal {
        place: e.place.map(|p| p.to_array()),
        ..Refusal::new(format!("`{}` is {e}", shown.name))
    })
}

/// The boundary loops by their numbers.
///
/// # Errors
/// [`Refusal`].
pub fn loops(shown: &Shown) -> Result<Value, Refusal> {
    let mesh = connected(shown)?;
    let origin = drawing_origin(shown);
    let list = boundary_loops(&mesh).into_iter().enumerate().map(|(id, walk)| {
        let places: Vec<DVec3> = walk.iter().map(|&h| mesh.position(mesh.tail(h))).collect();
        let points: Vec<_> = places.iter().map(|&p| drawn(p, origin)).collect();
        json!({
            "id": id, "edges": walk.len(), "length": walk.iter().map(|&h| mesh.edge_length(h)).sum::<f64>(),
            "at": places.first().map(DVec3::to_array), "closed": true, "points": points,
        })
    });
    let origin = origin.to_array();
    Ok(json!({ "revision": revision(shown), "origin": origin, "loops": list.collect::<Vec<_>>() }))
}

/// Counts, measures, defects, and the places of crossings.
///
/// # Errors
/// [`Refusal`] where it is cancelled.
pub fn info(shown: &Shown, watch: &Watch) -> Result<Value, Refusal> {
    let mesh = &shown.model.mesh;
    let info = Info::of(mesh, watch).map_err(|_| Refusal::new("cancelled"))?;
    let mut told = json!(info);
    let has_crossings = info.self_intersections.is_some_and(|n| n > 0);
    let pairs = if has_crossings { tri_intersect::self_intersections(mesh, watch).unwrap_or_default() } else { vec![] };
    let middle = |f: FaceId| mesh.triangle(f).into_iter().sum::<DVec3>() / 3.0;
    let places = pairs.iter().take(MOST_CROSSINGS).map(|&[a, b]| (0.5 * (middle(a) + middle(b))).to_array());
    told["crossings"] = json!(places.collect::<Vec<_>>());
    told["revision"] = revision(shown).into();
    Ok(told)
}

/// The exact point at a face's barycentrics.
///
/// # Errors
/// [`Refusal`]: no such face.
pub fn pick(shown: &Shown, face: u32, bary: [f64; 3]) -> Result<DVec3, Refusal> {
    let [a, b, c] = triangle(shown, face)?;
    let sum: f64 = bary.iter().sum();
    if !bary.iter().all(|x| x.is_finite()) || sum == 0.0 {
        return Err(Refusal::new("barycentrics are three finite numbers"));
    }
    Ok((bary[0] * a + bary[1] * b + bary[2] * c) / sum)
}

/// The distance of two picks, and the angle of their faces' normals.
///
/// # Errors
/// [`Refusal`]: no such shape or face.
pub fn measure(scene: &Scene, between: &Measure) -> Result<Value, Refusal> {
    let end = |shape: &str, face, bary| {
        let shown = scene.shape(&Of { shape: shape.into(), revision: None })?;
        Ok::<_, Refusal>((pick(shown, face, bary)?, triangle_normal(triangle(shown, face)?)))
    };
    let (a, normal_a) = end(&between.shape_a, between.face_a, between.bary_a)?;
    let (b, normal_b) = end(&between.shape_b, between.face_b, between.bary_b)?;
    let angle = normal_a.cross(normal_b).length().atan2(normal_a.dot(normal_b)).to_degrees();
    Ok(json!({ "distance": a.distance(b), "angle": angle, "a": a.to_array(), "b": b.to_array() }))
}

fn triangle(shown: &Shown, face: u32) -> Result<[DVec3; 3], Refusal> {
    let mesh = &shown.model.mesh;
    let corners = mesh.faces.get(face as usize).map(|corners| corners.map(|v| mesh.positions.get(v.index())));
    match corners {
        Some([Some(&a), Some(&b), Some(&c)]) => Ok([a, b, c]),
        _ => Err(Refusal::new(format!("`{}` has no face {face}", shown.name))),
    }
}

/// Mean curvature at each vertex, in 1/model unit: positive on a ball.
///
/// # Errors
/// [`Refusal`].
pub fn curvature(shown: &Shown) -> Result<Vec<f32>, Refusal> {
    let mesh = connected(shown)?;
    let (vectors, normals) = (mean_curvature_vectors(&mesh), vertex_normals(&mesh));
    let along = |(vector, normal): (&DVec3, &DVec3)| vector.length().copysign(vector.dot(*normal)) as f32;
    Ok(vectors.as_slice().iter().zip(normals.as_slice()).map(along).collect())
}

/// The shape of the worst triangle at each vertex: 1 where all are equilateral, 0 where one has no area.
pub fn quality(shown: &Shown) -> Vec<f32> {
    let mesh = &shown.model.mesh;
    let mut worst = vec![1.0f32; mesh.vertex_count()];
    for f in mesh.face_ids() {
        let quality = fusion::render::shape_quality(mesh.triangle(f)) as f32;
        for VertexId(v) in mesh.corners(f) {
            if let Some(worst) = worst.get_mut(v as usize) {
                *worst = worst.min(quality);
            }
        }
    }
    worst
}
