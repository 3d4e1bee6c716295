//! Origins as columns, of which the package makes structured arrays.

use crate::columns::{column, table};
use fusion::mesh_core::{FaceOrigin, Origins, VertexOrigin};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What stands for an id that is not there.
const NONE: u32 = u32::MAX;

/// Names of stages in order of first appearance.
#[derive(Default)]
struct Stages(Vec<&'static str>);

impl Stages {
    fn id(&mut self, stage: &'static str) -> i32 {
        let known = self.0.iter().position(|s| *s == stage);
        let place = known.unwrap_or_else(|| {
            self.0.push(stage);
            self.0.len() - 1
        });
        i32::try_from(place).unwrap_or(i32::MAX)
    }
}

/// The columns of vertices and faces, and the names of stages.
pub fn to_python<'py>(py: Python<'py>, origins: &Origins) -> PyResult<Bound<'py, PyDict>> {
    let mut stages = Stages::default();
    let dict = PyDict::new(py);
    dict.set_item("vertices", vertices(py, origins.vertices.as_slice(), &mut stages)?)?;
    dict.set_item("faces", faces(py, origins.faces.as_slice(), &mut stages)?)?;
    dict.set_item("stages", stages.0)?;
    Ok(dict)
}

fn vertices<'py>(py: Python<'py>, origins: &[VertexOrigin], stages: &mut Stages) -> PyResult<Bound<'py, PyDict>> {
    let count = origins.len();
    let (mut kinds, mut parts, mut stage_ids) = (vec![0u8; count], vec![-1i32; count], vec![-1i32; count]);
    let (mut ids, mut weights) = (vec![[NONE; 2]; count], vec![[0f64; 3]; count]);
    for (i, origin) in origins.iter().enumerate() {
        match *origin {
            VertexOrigin::Input { part, vertex } => {
                (parts[i], ids[i], weights[i]) = (part.cast_signed(), [vertex.0, NONE], [1.0, 0.0, 0.0]);
            }
            VertexOrigin::Edge { part, ends: [a, b], t } => {
                (kinds[i], parts[i], ids[i], weights[i]) = (1, part.cast_signed(), [a.0, b.0], [1.0 - t, t, 0.0]);
            }
            VertexOrigin::Face { part, face, barycentric } => {
                (kinds[i], parts[i], ids[i], weights[i]) = (2, part.cast_signed(), [face.0, NONE], barycentric);
            }
            VertexOrigin::New { stage } => (kinds[i], stage_ids[i]) = (3, stages.id(stage)),
        }
    }
    let dict = PyDict::new(py);
    dict.set_item("kind", column(py, kinds))?;
    dict.set_item("part", column(py, parts))?;
    dict.set_item("ids", table(py, ids)?)?;
    dict.set_item("weights", table(py, weights)?)?;
    dict.set_item("stage", column(py, stage_ids))?;
    Ok(dict)
}

fn faces<'py>(py: Python<'py>, origins: &[FaceOrigin], stages: &mut Stages) -> PyResult<Bound<'py, PyDict>> {
    let count = origins.len();
    let (mut kinds, mut parts, mut stage_ids) = (vec![0u8; count], vec![-1i32; count], vec![-1i32; count]);
    let mut ids = vec![NONE; count];
    for (i, origin) in origins.iter().enumerate() {
        match *origin {
            FaceOrigin::Input { part, face } => (parts[i], ids[i]) = (part.cast_signed(), face.0),
            FaceOrigin::Piece { part, face } => (kinds[i], parts[i], ids[i]) = (1, part.cast_signed(), face.0),
            FaceOrigin::New { stage } => (kinds[i], stage_ids[i]) = (3, stages.id(stage)),
        }
    }
    let dict = PyDict::new(py);
    dict.set_item("kind", column(py, kinds))?;
    dict.set_item("part", column(py, parts))?;
    dict.set_item("face", column(py, ids))?;
    dict.set_item("stage", column(py, stage_ids))?;
    Ok(dict)
}
