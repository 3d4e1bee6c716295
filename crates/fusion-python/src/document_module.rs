//! The functions about documents that Python sees, and the cache of their results.

// Arguments come from Python by value.
#![allow(clippy::needless_pass_by_value)]

use crate::arrays::{Part, model_from, model_to_python};
use crate::documents::{self, Beside};
use crate::failure::Fault;
use crate::job::{self, Terms};
use crate::origins;
use crate::value::{options_from, plain, to_python, value_from};
use fusion::document::{Evaluated, Taken};
use fusion::operation::Precision;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// Adds them to the module.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Cache>()?;
    module.add_function(wrap_pyfunction!(document_outline, module)?)?;
    module.add_function(wrap_pyfunction!(document_extended, module)?)?;
    module.add_function(wrap_pyfunction!(document_with_parameter, module)?)?;
    module.add_function(wrap_pyfunction!(document_with_value, module)?)?;
    module.add_function(wrap_pyfunction!(document_evaluate, module)?)
}

/// Results of steps: in memory, and in a folder where one is given.
#[pyclass(module = "fusion_mesh._native", frozen)]
pub struct Cache(Arc<fusion::document::Cache>);

#[pymethods]
impl Cache {
    #[new]
    #[pyo3(signature = (memory, folder=None, limit=0))]
    fn new(memory: usize, folder: Option<PathBuf>, limit: u64) -> Self {
        let cache = fusion::document::Cache::in_memory(memory);
        Self(Arc::new(match folder {
            Some(folder) => cache.with_folder(folder, limit),
            None => cache,
        }))
    }
}

/// What a document says.
#[pyfunction]
fn document_outline<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    to_python(py, &documents::outline(text).map_err(|fault| fault.raise(py))?)
}

/// A document with further tables.
#[pyfunction]
fn document_extended(py: Python<'_>, text: &str, tables: &Bound<'_, PyDict>) -> PyResult<String> {
    documents::extended(text, &options_from(tables)?).map_err(|fault| fault.raise(py))
}

/// A document with a parameter.
#[pyfunction]
fn document_with_parameter(py: Python<'_>, text: &str, name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    documents::with_parameter(text, name, &value_from(value, name)?).map_err(|fault| fault.raise(py))
}

/// A document with another value for a parameter or an option.
#[pyfunction]
fn document_with_value(py: Python<'_>, text: &str, name: &str, value: &Bound<'_, PyAny>) -> PyResult<String> {
    documents::with_value(text, name, &value_from(value, name)?).map_err(|fault| fault.raise(py))
}

/// Evaluates a document: its steps, and its outputs, each with mesh, report and origins. The names of `meshes` are the paths
/// that stand for them; other paths are relative to the folder.
#[pyfunction]
#[pyo3(signature = (text, sources, cache, precision=None, threads=None, progress=None))]
fn document_evaluate<'py>(
    py: Python<'py>,
    text: String,
    sources: (PathBuf, Vec<Part<'py>>),
    cache: PyRef<'py, Cache>,
    precision: Option<&str>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let wrong = |e: String| Fault::BadOption(format!("precision: {e}")).raise(py);
    let precision: Option<Precision> = precision.map(|p| p.parse().map_err(wrong)).transpose()?;
    let (folder, meshes) = sources;
    let models = meshes.iter().map(|(path, mesh)| Ok((path.into(), Arc::new(model_from(mesh, path)?))));
    let beside = Beside { folder, meshes: models.collect::<PyResult<_>>()? };
    let cache = Arc::clone(&cache.0);
    let terms = Terms { threads, progress };
    let made = job::run(py, &terms, move |watch| documents::evaluate(&text, beside, &cache, precision, watch))?;
    let dict = PyDict::new(py);
    dict.set_item("steps", made.steps.iter().map(|s| step_to_python(py, s)).collect::<PyResult<Vec<_>>>()?)?;
    let outputs = made.outputs.into_iter().map(|o| output_to_python(py, o, precision));
    dict.set_item("outputs", outputs.collect::<PyResult<Vec<_>>>()?)?;
    Ok(dict)
}

fn step_to_python<'py>(py: Python<'py>, step: &Taken) -> PyResult<Bound<'py, PyAny>> {
    let told = plain(py, &step.report)?;
    told.set_item("step", step.number)?;
    told.set_item("name", &step.name)?;
    told.set_item("known", step.is_known)?;
    Ok(told)
}

fn output_to_python(py: Python<'_>, output: Evaluated, precision: Option<Precision>) -> PyResult<Bound<'_, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("precision", documents::precision_of(&output.file, precision).to_string())?;
    dict.set_item("of", output.of)?;
    dict.set_item("file", output.file.to_string_lossy())?;
    dict.set_item("report", plain(py, &output.outcome.report)?)?;
    dict.set_item("origins", origins::to_python(py, &output.outcome.origins)?)?;
    dict.set_item("mesh", model_to_python(py, output.outcome.model)?)?;
    dict.set_item("nets", py.None())?;
    Ok(dict)
}
