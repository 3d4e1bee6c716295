//! What is measured on surfaces, beside libigl through `measures.py`.

use super::reference::python;
use crate::{Fault, root};
use glam::{DQuat, DVec3};
use mesh_core::{
    Adjacency, Connected, Faces, FloodParams, HalfedgeId, Seed, Source, SurfacePoint, TriMesh, VertexId, Watch,
};
use mesh_core::{area_vector, boundary_loops, face_normals, flood};
use mesh_core::{mean_curvature_vectors, mixed_areas, shapes, vertex_normals};
use mesh_operators::{cotangent_weight, cotangents};
use mesh_query::TriBvh;
use param_conformal::Harmonic;
use serde_json::{Value, json};
use std::fs;
use std::process::Command;
use tri_intersect::{Operation, boolean, self_intersections};

/// Places at which distance and side are asked for.
const PLACES: u64 = 2000;

/// Runs all measures and returns how many are off.
pub fn run() -> Result<usize, Fault> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("cases.json");
    fs::write(&file, Value::from(cases()?).to_string())?;
    let output = Command::new(python()?).arg(root().join("xtask/measures.py")).arg(&file).output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !output.status.success() {
        return Err(format!("measures.py failed: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let mut wrong = 0;
    for line in text.lines() {
        if let [measure, name, difference, allowed, verdict] = line.split('\t').collect::<Vec<_>>()[..] {
            println!("regress: libigl: {measure}, {name}: {difference} (at most {allowed}): {verdict}");
            wrong += usize::from(verdict != "ok");
        }
    }
    println!("regress: {} measures beside libigl's, {wrong} faults", text.lines().count());
    Ok(wrong)
}

fn cases() -> Result<Vec<Value>, Fault> {
    let blob = Connected::new(shapes::blob(1.0, 4, 0.3, 7))?;
    let torus = Connected::new(shapes::torus(1.0, 0.35, 72, 28))?;
    let bracket = Connected::new(shapes::bracket(DVec3::new(2.0, 1.0, 1.5), 0.3, [9, 5, 7]))?;
    let hill = Connected::new(hill())?;
    let solids = [("blob", &blob), ("torus", &torus), ("bracket", &bracket)];
    let mut cases = vec![];
    for (name, mesh) in solids.into_iter().chain([("hill", &hill)]) {
        cases.push(surface(name, mesh));
        cases.push(geodesics(name, mesh));
    }
    cases.extend([curvature("blob", &blob), curvature("torus", &torus), harmonic("hill", &hill)?]);
    for (name, mesh) in solids {
        cases.push(points(name, mesh)?);
    }
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.7);
    let moved = shapes::posed(torus.mesh().clone(), turn, DVec3::new(0.4, 0.3, 0.2));
    cases.push(meetings("blob and torus as one mesh", &both(blob.mesh(), &moved))?);
    // No corner on another's: libigl takes corners in one place for one, and passes over faces that coincide.
    let beside = shapes::posed(bracket.mesh().clone(), DQuat::IDENTITY, DVec3::new(0.0, 0.33, 0.11));
    cases.push(meetings("brackets in common planes as one mesh", &both(bracket.mesh(), &beside))?);
    for (operation, theirs) in
        [(Operation::Union, "union"), (Operation::Difference, "minus"), (Operation::Intersection, "intersect")]
    {
        let moved = Connected::new(&moved)?.into_mesh().clone();
        cases.push(joined("blob and torus", &blob, &Connected::new(moved)?, operation, theirs)?);
        let beside = shapes::posed(bracket.mesh().clone(), DQuat::IDENTITY, DVec3::new(0.0, 0.4, 0.15));
        cases.push(joined(
            "brackets with faces in common planes",
            &bracket,
            &Connected::new(beside)?,
            operation,
            theirs,
        )?);
    }
    Ok(cases)
}

/// A disc of triangles of many shapes.
fn hill() -> TriMesh {
    let mut mesh = shapes::grid(2.0, 1.5, 30, 20);
    for p in &mut mesh.positions {
        p.x += 0.02 * (11.0 * p.y).sin();
        p.z = 0.4 * (2.0 * p.x).cos() * (3.0 * p.y).sin();
    }
    mesh
}

fn both(a: &TriMesh, b: &TriMesh) -> TriMesh {
    let first = a.positions.len();
    let faces = b.faces.iter().map(|f| f.map(|v| VertexId::from(first + v.index())));
    TriMesh {
        positions: [a.positions.clone(), b.positions.clone()].concat(),
        faces: a.faces.iter().copied().chain(faces).collect(),
    }
}

fn numbers<'a>(vectors: impl IntoIterator<Item = &'a DVec3>) -> Value {
    vectors.into_iter().map(|p| json!(p.to_array())).collect()
}

fn arrays(mesh: &TriMesh) -> Value {
    let faces: Value = mesh.faces.iter().map(|f| json!(f.map(|v| v.0))).collect();
    json!({ "positions": numbers(&mesh.positions), "faces": faces })
}

/// A case with what all have.
fn case(kind: &str, name: &str, mesh: &TriMesh, measured: Value) -> Value {
    let mut case = json!({ "kind": kind, "name": name, "mesh": arrays(mesh) });
    if let (Value::Object(case), Value::Object(measured)) = (&mut case, measured) {
        case.extend(measured);
    }
    case
}

fn surface(name: &str, mesh: &Connected<TriMesh>) -> Value {
    let cot = cotangents(mesh);
    let halfedges = mesh.face_ids().flat_map(|f| (0..3).map(move |k| HalfedgeId::new(f, k)));
    let edges = halfedges.filter(|&h| mesh.twin(h).is_none_or(|t| h < t));
    let weights = edges.map(|h| json!([mesh.tail(h).0, mesh.head(h).0, cotangent_weight(mesh, &cot, h)]));
    let areas = mesh.face_ids().map(|f| area_vector(mesh.mesh().triangle(f)).length());
    let measured = json!({
        "face_normals": numbers(face_normals(mesh).as_slice()),
        "vertex_normals": numbers(vertex_normals(mesh).as_slice()),
        "face_areas": areas.collect::<Vec<_>>(),
        "vertex_areas": mixed_areas(mesh).as_slice(),
        "weights": weights.collect::<Vec<_>>(),
    });
    case("surface", name, mesh.mesh(), measured)
}

fn curvature(name: &str, mesh: &Connected<TriMesh>) -> Value {
    let (vectors, normals) = (mean_curvature_vectors(mesh), vertex_normals(mesh));
    let means: Vec<f64> = mesh.vertex_ids().map(|v| vectors[v].dot(normals[v])).collect();
    let measured = json!({ "curvature_vectors": numbers(vectors.as_slice()), "mean_curvatures": means });
    case("curvature", name, mesh.mesh(), measured)
}

fn geodesics(name: &str, mesh: &Connected<TriMesh>) -> Value {
    let from = VertexId(0);
    let seed = Seed { source: Source::At(SurfacePoint::Vertex(from)), distance: 0.0 };
    let seeds = [seed];
    let near = flood(mesh, &seeds, &FloodParams::default());
    let distances: Vec<_> = mesh.vertex_ids().map(|v| near.vertex(v)).collect();
    case("geodesics", name, mesh.mesh(), json!({ "from": from.0, "distances": distances }))
}

/// The rim laid onto a circle.
fn harmonic(name: &str, mesh: &Connected<TriMesh>) -> Result<Value, Fault> {
    let rim: Vec<VertexId> = boundary_loops(mesh).concat().into_iter().map(|h| mesh.tail(h)).collect();
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / rim.len() as f64;
    let values: Vec<[f64; 2]> = (0..rim.len()).map(|k| [angle(k).cos(), angle(k).sin()]).collect();
    let map = Harmonic::new(mesh, &rim)?.solve(&values);
    let fixed: Vec<u32> = rim.iter().map(|v| v.0).collect();
    Ok(case("harmonic", name, mesh.mesh(), json!({ "fixed": fixed, "values": values, "map": map.as_slice() })))
}

/// Distance by the closest point, side by how often a ray leaves.
fn points(name: &str, mesh: &Connected<TriMesh>) -> Result<Value, Fault> {
    let tree = TriBvh::build(mesh)?;
    let size = mesh_core::bounds(mesh);
    let mut rng = fastrand::Rng::with_seed(7);
    let mut random = || rng.f64();
    let (mut places, mut distances) = (vec![], vec![]);
    for _ in 0..PLACES {
        let share = DVec3::from_array([(); 3].map(|()| 1.4 * random() - 0.2));
        let place = size.min + share * (size.max - size.min);
        let Some(near) = tree.closest_point(mesh, place) else { continue };
        let direction = DVec3::new(0.61, 0.37, 0.7);
        let (mut from, mut hits) = (place, 0);
        while let Some(hit) = tree.ray_cast(mesh, from, direction, f64::INFINITY) {
            hits += 1;
            from += (hit.t + 1e-9) * direction;
        }
        places.push(place);
        distances.push(if hits % 2 == 1 { -near.distance } else { near.distance });
    }
    Ok(case("points", name, mesh.mesh(), json!({ "points": numbers(&places), "signed_distances": distances })))
}

fn meetings(name: &str, mesh: &TriMesh) -> Result<Value, Fault> {
    let pairs = self_intersections(mesh, &Watch::default())?;
    let pairs: Vec<[u32; 2]> = pairs.into_iter().map(|p| p.map(|f| f.0)).collect();
    Ok(case("meetings", name, mesh, json!({ "meetings": pairs })))
}

fn joined(
    name: &str,
    a: &Connected<TriMesh>,
    b: &Connected<TriMesh>,
    operation: Operation,
    theirs: &str,
) -> Result<Value, Fault> {
    let made = boolean(a, b, operation, &tri_intersect::Params::default(), &Watch::default())?;
    let measured = json!({ "other": arrays(b.mesh()), "result": arrays(&made.mesh), "operation": theirs });
    Ok(case("boolean", name, a.mesh(), measured))
}
