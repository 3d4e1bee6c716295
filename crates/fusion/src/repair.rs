//! Repair on request: welding, orientation, taking apart.

use crate::{Counts, Outcome, Report, Validity, carry};
use mesh_core::{FaceId, FaceOrigin, Faces, Origins, Stage, TriMesh, VertexId, VertexOrigin, orient, split, validate};
use mesh_io::{Model, weld_within};

/// One kind of repair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Repair {
    /// Merge vertices no further apart than this, in model units; 0 merges those at the same place.
    Weld(f64),
    /// Turn faces so that neighbours agree and closed parts face outward.
    Orient,
    /// Take apart edges with more than two faces and vertices with more than one fan, by copying vertices.
    Split,
}

/// Does the repairs in order. What was not asked for is not touched. O(n) each.
pub fn repair(part: &Model, repairs: &[Repair]) -> Outcome {
    let mut report = Report::new("convert", vec![Counts::of("", &part.mesh)]);
    let mut model = part.clone();
    let mut origins = Origins::identity(0, part.mesh.vertex_count(), part.mesh.face_count());
    for repair in repairs {
        let (name, before) = (repair.name(), [model.mesh.vertex_count(), model.mesh.face_count()]);
        let (mended, step) = report.time(name, || repair.apply(&model));
        origins = step.compose(&[Stage { origins: &origins, faces: &model.mesh }], &[&part.mesh]);
        let turned = part_turned(&model.mesh, &mended.mesh);
        model = mended;
        for (what, old, new) in [
            ("vertices", before[0], model.mesh.vertex_count()),
            ("faces", before[1], model.mesh.face_count()),
            ("turned faces", 0, turned),
        ] {
            if old != new {
                report.figures.insert(format!("{name}: {what}"), new as f64 - old as f64);
            }
        }
    }
    let defects = validate(&model.mesh);
    let (manifold, closed) = (Some(defects.is_manifold()), Some(defects.is_closed()));
    report.validity = Validity { manifold, closed, self_intersections: None };
    report.describe(&model.mesh, &origins);
    Outcome { model, origins, report }
}

impl Repair {
    fn name(self) -> &'static str {
        match self {
            Self::Weld(_) => "weld",
            Self::Orient => "orient",
            Self::Split => "split",
        }
    }

    fn apply(self, model: &Model) -> (Model, Origins) {
        let (mesh, origins) = match self {
            Self::Weld(tolerance) => return weld(model, tolerance),
            Self::Orient => orient(&model.mesh),
            Self::Split => split(&model.mesh),
        };
        (carry(std::slice::from_ref(model), mesh, &origins), origins)
    }
}

fn weld(model: &Model, tolerance: f64) -> (Model, Origins) {
    let mut welded = model.clone();
    let vertex_of = weld_within(&mut welded, tolerance).vertex_of;
    let mut first = vec![VertexOrigin::New { stage: "weld" }; welded.mesh.vertex_count()];
    for v in (0..model.mesh.vertex_count()).rev().map(VertexId::from) {
        first[vertex_of[v].index()] = VertexOrigin::Input { part: 0, vertex: v };
    }
    let kept = |f: &FaceId| {
        let [a, b, c] = model.mesh.corners(*f).map(|v| vertex_of[v]);
        a != b && b != c && c != a
    };
    let face = |f| FaceOrigin::Input { part: 0, face: f };
    let faces: Vec<_> = model.mesh.face_ids().filter(kept).map(face).collect();
    (welded, Origins { vertices: first.into(), faces: faces.into() })
}

/// How many faces run the other way round, where the faces are the same ones.
fn part_turned(before: &TriMesh, after: &TriMesh) -> usize {
    let same_count = before.faces.len() == after.faces.len();
    let turned = |(a, b): &(&[VertexId; 3], &[VertexId; 3])| {
        (0..3).any(|k| [a[0], a[2], a[1]] == [b[k], b[(k + 1) % 3], b[(k + 2) % 3]])
    };
    before.faces.iter().zip(&after.faces).filter(turned).count() * usize::from(same_count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::shapes;

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
        assert_eq!(repair(&model, &[]).model.mesh, model.mesh);
        let welded = repair(&model, &[Repair::Weld(0.0)]);
        assert_eq!((welded.report.output.vertices, welded.report.validity.closed), (8, Some(false)));
        let mended = repair(&model, &[Repair::Weld(0.0), Repair::Orient]);
        assert_eq!(mended.report.validity.closed, Some(true));
        assert!((mesh_core::volume(&mended.model.mesh) - 1.0).abs() < 1e-15);
        assert_eq!(mended.report.figures.get("orient: turned faces"), Some(&1.0));
    }

    #[test]
    fn origins_name_the_same_places() {
        let model = shattered();
        let outcome = repair(&model, &[Repair::Weld(1e-9), Repair::Orient, Repair::Split]);
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
        let welded = repair(&model, &[Repair::Weld(0.0)]);
        assert_eq!((welded.report.output.vertices, welded.report.validity.manifold), (14, Some(false)));
        let apart = repair(&model, &[Repair::Weld(0.0), Repair::Split]);
        assert_eq!((apart.report.output.vertices, apart.report.validity.closed), (16, Some(true)));
    }
}
