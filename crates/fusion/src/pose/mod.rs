//! Models moved: by a similarity, onto primitives, face to face, down onto each other.
//!
//! | file | holds |
//! |---|---|
//! | `similarity.rs` | scaling, turning, shifting |
//! | `placement.rs` | places on primitives |
//! | `face.rs` | openings that face each other |
//! | `rest.rs` | how far one mesh stands above another |

pub(crate) mod face;
pub(crate) mod placement;
pub(crate) mod rest;
pub(crate) mod similarity;

use crate::{Counts, Outcome, Report, Validity};
use mesh_core::{Faces, Origins, validate};
use mesh_io::Model;
use similarity::Similarity;

/// The model, moved. Origins name the vertices as they were; no bit changes where nothing moves. What is wrong with the model
/// is neither mended nor refused, only told. O(n).
pub(crate) fn pose(part: &Model, similarity: &Similarity) -> Outcome {
    let mut report = Report::new("pose", vec![Counts::of("", &part.mesh)]);
    let model = report.time("pose", || similarity.model(part.clone()));
    let origins = Origins::identity(0, part.mesh.vertex_count(), part.mesh.face_count());
    report.describe(&model.mesh, &origins);
    let same = |(a, b): &(&glam::DVec3, &glam::DVec3)| a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits);
    report.kept_vertices = part.mesh.positions.iter().zip(&model.mesh.positions).filter(same).count();
    let defects = validate(&model.mesh);
    report.validity =
        Validity { manifold: Some(defects.is_manifold()), closed: Some(defects.is_closed()), self_intersections: None };
    Outcome { model, origins, report }
}
