//! The functions that Python sees. Meshes are objects with the attributes of `fusion_mesh.Mesh`, each with the argument's name.

// Arguments come from Python by value.
#![allow(clippy::needless_pass_by_value)]

use crate::arrays::{Part, model_from, model_to_python, models_from, polygons_to_python};
use crate::failure::Fault;
use crate::job::{self, Terms};
use crate::picture::{View, png};
use crate::value::{options_from, plain, to_python};
use crate::{document_module, listing, operations, origins};
use fusion::mesh_core::FaceId;
use fusion::mesh_io::{self, Format, Model};
use fusion::operation::Precision;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

/// The module `fusion_mesh._native`.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(max_radius, module)?)?;
    module.add_function(wrap_pyfunction!(info, module)?)?;
    module.add_function(wrap_pyfunction!(features, module)?)?;
    module.add_function(wrap_pyfunction!(render, module)?)?;
    module.add_function(wrap_pyfunction!(read, module)?)?;
    module.add_function(wrap_pyfunction!(write, module)?)?;
    module.add_function(wrap_pyfunction!(as_written, module)?)?;
    module.add_function(wrap_pyfunction!(triangulate, module)?)?;
    module.add_function(wrap_pyfunction!(cli, module)?)?;
    document_module::add_to(module)
}

/// Runs an operation on meshes. Gives the result as a dictionary: mesh, report, origins, nets.
#[pyfunction]
#[pyo3(signature = (operation, options, parts, precision, threads=None, progress=None))]
fn run<'py>(
    py: Python<'py>,
    operation: &str,
    options: &Bound<'py, PyDict>,
    parts: Vec<Part<'py>>,
    precision: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = options_from(options)?;
    let precision: Precision = precision.parse().map_err(|e| Fault::BadOption(format!("precision: {e}")).raise(py))?;
    let models = models_from(&parts)?;
    let terms = Terms { threads, progress };
    let name = operation.to_string();
    let done = job::run(py, &terms, move |watch| operations::by_name(&name, &options, &models, precision, watch))?;
    let dict = PyDict::new(py);
    dict.set_item("report", plain(py, &done.outcome.report)?)?;
    dict.set_item("origins", origins::to_python(py, &done.outcome.origins)?)?;
    dict.set_item("mesh", model_to_python(py, done.outcome.model)?)?;
    dict.set_item("nets", done.nets)?;
    Ok(dict)
}

/// The largest radius for the chosen curves or seams: radius, what is in the way of a larger one, and where.
#[pyfunction]
#[pyo3(signature = (operation, options, parts, threads=None, progress=None))]
fn max_radius<'py>(
    py: Python<'py>,
    operation: &str,
    options: &Bound<'py, PyDict>,
    parts: Vec<Part<'py>>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(f64, &'static str, Option<[f64; 3]>)> {
    let options = options_from(options)?;
    let models = models_from(&parts)?;
    let terms = Terms { threads, progress };
    let name = operation.to_string();
    let limit = job::run(py, &terms, move |watch| operations::max_radius(&name, &options, &models, watch))?;
    Ok((limit.radius, limit.what, limit.at.map(|p| p.to_array())))
}

/// Measures a mesh.
#[pyfunction]
#[pyo3(signature = (part, threads=None, progress=None))]
fn info<'py>(
    py: Python<'py>,
    part: Part<'py>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let model = model_from(&part.1, &part.0)?;
    let info = job::run(py, &Terms { threads, progress }, move |watch| listing::info(&model.mesh, watch))?;
    to_python(py, &info)
}

/// Lists the feature curves of a mesh.
#[pyfunction]
#[pyo3(signature = (part, angle, radii, threads=None, progress=None))]
fn features<'py>(
    py: Python<'py>,
    part: Part<'py>,
    angle: f64,
    radii: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    if !(angle > 0.0 && angle < 180.0) {
        let reason = "angle: an angle is a number of degrees between 0 and 180".to_string();
        return Err(Fault::BadOption(reason).raise(py));
    }
    let mesh = model_from(&part.1, &part.0)?.mesh;
    let curves = job::run(py, &Terms { threads, progress }, move |watch| listing::features(mesh, angle, radii, watch))?;
    to_python(py, &curves)
}

/// Draws a mesh: the bytes of a PNG file.
#[pyfunction]
#[pyo3(signature = (part, view, threads=None, progress=None))]
fn render<'py>(
    py: Python<'py>,
    part: Part<'py>,
    view: View,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyBytes>> {
    let mesh = model_from(&part.1, &part.0)?.mesh;
    let png = job::run(py, &Terms { threads, progress }, move |watch| png(&mesh, view, watch))?;
    Ok(PyBytes::new(py, &png))
}

/// Reads a mesh file.
#[pyfunction]
fn read(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let model = py.detach(|| mesh_io::read(&path)).map_err(|e| Fault::from(e).raise(py))?;
    model_to_python(py, model)
}

/// Writes a mesh file and its side files; gives all of them, and what the format cannot hold.
#[pyfunction]
fn write<'py>(py: Python<'py>, part: Part<'py>, path: PathBuf) -> PyResult<(Vec<PathBuf>, Vec<String>)> {
    let model = model_from(&part.1, &part.0)?;
    let written = py.detach(|| mesh_io::write(&model, &path)).map_err(|e| Fault::from(e).raise(py))?;
    Ok((written.files, written.notes.iter().map(ToString::to_string).collect()))
}

/// The mesh as the format of a path holds it, without faces that rounding made flat; `None` where that is the mesh itself.
#[pyfunction]
fn as_written<'py>(py: Python<'py>, part: Part<'py>, path: PathBuf) -> PyResult<Option<Bound<'py, PyDict>>> {
    let format = Format::from_path(&path).map_err(|e| Fault::from(e).raise(py))?;
    let model = model_from(&part.1, &part.0)?;
    let Some(mesh) = mesh_io::as_written(&model, format) else { return Ok(None) };
    let mut model = Model::from(mesh);
    let flat = |[a, b, c]: [fusion::mesh_core::VertexId; 3]| a == b || b == c || c == a;
    let keep: Vec<bool> = model.mesh.faces.iter().map(|&face| !flat(face)).collect();
    model.retain_faces(|f: FaceId| keep[f.index()]);
    model_to_python(py, model).map(Some)
}

/// Cuts polygons into triangles.
#[pyfunction]
fn triangulate<'py>(
    py: Python<'py>,
    name: &str,
    vertices: &Bound<'py, PyAny>,
    sizes: PyReadonlyArray1<'py, u32>,
    corners: PyReadonlyArray1<'py, u32>,
) -> PyResult<Bound<'py, PyDict>> {
    polygons_to_python(py, name, vertices, &sizes, &corners)
}

/// Runs a command line, whose first argument is the program's name, and gives its exit code.
#[pyfunction]
fn cli(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    let code = py.detach(|| fusion_cli::main(arguments));
    // An exit code does not tell its number, but it can be compared.
    (0..=u8::MAX).find(|&number| ExitCode::from(number) == code).unwrap_or(1)
}
