//! Meshes from arrays and back. A Python mesh is any object with the attributes of `fusion_mesh.Mesh`, whose arrays the package has
//! brought into shape; what only their values can tell is checked here, while they are copied.

use crate::attributes;
use crate::columns::{rows, shaped, table};
use crate::failure::{Fault, bad_input};
use fusion::mesh_core::{TriMesh, VertexId};
use fusion::mesh_io::Model;
use glam::DVec3;
use numpy::{Element, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A mesh and the argument it stands for.
pub type Part<'py> = (String, Bound<'py, PyAny>);

/// The models of several meshes.
pub fn models_from(parts: &[Part<'_>]) -> PyResult<Vec<Model>> {
    parts.iter().map(|(name, mesh)| model_from(mesh, name)).collect()
}

/// The model of one mesh. Every array is read once, into the model.
pub fn model_from(mesh: &Bound<'_, PyAny>, name: &str) -> PyResult<Model> {
    let positions = positions_from(&mesh.getattr("vertices")?, name)?;
    let faces = faces_from(&mesh.getattr("faces")?, positions.len(), name)?;
    let mut model = Model::from(TriMesh { positions, faces });
    attributes::add(&mut model, mesh, name)?;
    Ok(model)
}

fn positions_from(array: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<DVec3>> {
    let array: PyReadonlyArray2<'_, f64> = shaped(array, name, "vertices", "float64 of shape (N, 3)")?;
    let points = rows::<f64, 3>(array.as_slice().ok(), name, "vertices")?;
    let positions: Vec<DVec3> = points.iter().map(|&p| p.into()).collect();
    match positions.iter().position(|p| !p.is_finite()) {
        None => Ok(positions),
        Some(vertex) => {
            let place = positions[vertex];
            Err(bad_input(array.py(), format!("{name}: vertex {vertex} at {place} is not finite")))
        }
    }
}

fn faces_from(array: &Bound<'_, PyAny>, vertices: usize, name: &str) -> PyResult<Vec<[VertexId; 3]>> {
    if let Ok(ids) = array.extract::<PyReadonlyArray2<'_, u32>>() {
        return corners(&ids, vertices, name, |&v| Some(v));
    }
    if let Ok(ids) = array.extract::<PyReadonlyArray2<'_, i32>>() {
        return corners(&ids, vertices, name, |&v| u32::try_from(v).ok());
    }
    let ids: PyReadonlyArray2<'_, i64> = shaped(array, name, "faces", "integers of shape (M, 3)")?;
    corners(&ids, vertices, name, |&v| u32::try_from(v).ok())
}

fn corners<T: Element + std::fmt::Display>(
    ids: &PyReadonlyArray2<'_, T>,
    vertices: usize,
    name: &str,
    id: impl Fn(&T) -> Option<u32>,
) -> PyResult<Vec<[VertexId; 3]>> {
    let rows = rows::<T, 3>(ids.as_slice().ok(), name, "faces")?;
    // One that is out of range becomes the largest number, which none has.
    let known = |v: &T| VertexId(id(v).filter(|&v| (v as usize) < vertices).unwrap_or(u32::MAX));
    let faces: Vec<[VertexId; 3]> = rows.iter().map(|face| face.each_ref().map(known)).collect();
    let wrong = faces.iter().position(|face| face.contains(&VertexId(u32::MAX)));
    wrong.map_or(Ok(faces), |face| {
        let [a, b, c] = &rows[face];
        let message = format!("{name}: face {face} = [{a}, {b}, {c}] names a missing vertex; there are {vertices}");
        Err(bad_input(ids.py(), message))
    })
}

/// A model as the keyword arguments of `fusion_mesh.Mesh`. The arrays take over the model's memory.
pub fn model_to_python(py: Python<'_>, mut model: Model) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    attributes::tell(&dict, &mut model)?;
    let faces = model.mesh.faces.into_iter().map(|f| f.map(|v| v.0)).collect();
    dict.set_item("vertices", table(py, model.mesh.positions.into_iter().map(|p| p.to_array()).collect())?)?;
    dict.set_item("faces", table::<u32, 3>(py, faces)?)?;
    dict.set_item("notes", model.notes.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    Ok(dict)
}

/// A mesh of polygons, cut into triangles.
pub fn polygons_to_python<'py>(
    py: Python<'py>,
    name: &str,
    vertices: &Bound<'py, PyAny>,
    sizes: &PyReadonlyArray1<'py, u32>,
    corners: &PyReadonlyArray1<'py, u32>,
) -> PyResult<Bound<'py, PyDict>> {
    let positions = positions_from(vertices, name)?;
    let flat = |array: &PyReadonlyArray1<'py, u32>| array.as_array().to_vec();
    let model = Model::from_polygons(positions, flat(sizes), flat(corners));
    let model = model.map_err(|e| Fault::Unreadable(format!("{name}: {e}")).raise(py))?;
    model_to_python(py, model)
}
