//! Steps one by one, on shapes whose repair is known.

use super::*;
use glam::DVec3;
use mesh_core::{TriMesh, shapes};

fn steps(model: &Model, steps: &[Step]) -> Outcome {
    apply_steps(model, steps, &Watch::default()).unwrap()
}

/// Every triangle with corners of its own, one of them turned over.
fn shattered() -> Model {
    let cube = shapes::cuboid(DVec3::ONE);
    let positions = cube.face_ids().flat_map(|f| cube.triangle(f)).collect();
    let mut mesh = TriMesh::from_arrays(positions, (0..12).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]));
    mesh.faces[5].swap(0, 2);
    Model::from(mesh)
}

#[test]
fn a_shattered_box_is_mended_step_by_step() {
    let model = shattered();
    assert_eq!(steps(&model, &[]).model.mesh, model.mesh);
    let welded = steps(&model, &[Step::Weld(0.0)]);
    assert_eq!((welded.report.output.vertices, welded.report.validity.closed), (8, Some(false)));
    let mended = steps(&model, &[Step::Weld(0.0), Step::Orient]);
    assert_eq!(mended.report.validity.closed, Some(true));
    assert!((mesh_core::volume(&mended.model.mesh) - 1.0).abs() < 1e-15);
    assert_eq!(mended.report.figures.get("orient: turned faces"), Some(&1.0));
}

#[test]
fn origins_name_the_same_places() {
    let model = shattered();
    let outcome = steps(&model, &[Step::Weld(1e-9), Step::Orient, Step::Split]);
    for (p, origin) in outcome.model.mesh.positions.iter().zip(outcome.origins.vertices.as_slice()) {
        assert_eq!(origin.position(&[&model.mesh]), Some(*p));
    }
}

#[test]
fn two_boxes_on_one_edge_come_apart() {
    let (a, mut b) = (shapes::cuboid(DVec3::ONE), shapes::cuboid(DVec3::ONE));
    b.positions.iter_mut().for_each(|p| *p += DVec3::new(1.0, 1.0, 0.0));
    let faces = a.faces.iter().map(|f| f.map(|v| v.0)).chain(b.faces.iter().map(|f| f.map(|v| v.0 + 8)));
    let faces: Vec<_> = faces.collect();
    let model = Model::from(TriMesh::from_arrays([a.positions, b.positions].concat(), faces));
    let welded = steps(&model, &[Step::Weld(0.0)]);
    assert_eq!((welded.report.output.vertices, welded.report.validity.manifold), (14, Some(false)));
    let apart = steps(&model, &[Step::Weld(0.0), Step::Split]);
    assert_eq!((apart.report.output.vertices, apart.report.validity.closed), (16, Some(true)));
}
