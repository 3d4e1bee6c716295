//! Arrays of one kind of value, checked for their shape on the way in.

use crate::failure::bad_input;
use numpy::ndarray::{Array1, Array2, Array3};
use numpy::{Element, IntoPyArray, PyArray1, PyReadonlyArrayDyn};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// The values of a contiguous array by rows.
pub fn rows<'a, T, const N: usize>(values: Option<&'a [T]>, name: &str, what: &str) -> PyResult<&'a [[T; N]]> {
    match values.map(<[T]>::as_chunks::<N>) {
        Some((rows, [])) => Ok(rows),
        _ => Err(PyTypeError::new_err(format!("{name}: {what} must be a C-contiguous array with rows of {N}"))),
    }
}

/// An array of a type and number of dimensions.
pub fn shaped<'a, 'py, A: FromPyObject<'a, 'py>>(
    array: &'a Bound<'py, PyAny>,
    name: &str,
    what: &str,
    shape: &str,
) -> PyResult<A> {
    array.extract().map_err(|_| PyTypeError::new_err(format!("{name}: {what} must be an array of {shape}")))
}

/// The values of an attribute, if there is one, checked for their shape.
pub fn attribute<T: Element + Copy>(
    mesh: &Bound<'_, PyAny>,
    name: &str,
    key: &str,
    shape: &[usize],
) -> PyResult<Option<Vec<T>>> {
    let array = mesh.getattr(key)?;
    if array.is_none() {
        return Ok(None);
    }
    let values: PyReadonlyArrayDyn<'_, T> = shaped(&array, name, key, &format!("shape {shape:?}"))?;
    match values.as_slice() {
        Ok(flat) if values.as_array().shape() == shape => Ok(Some(flat.to_vec())),
        _ => {
            let found = values.as_array().shape().to_vec();
            Err(bad_input(array.py(), format!("{name}: {key} has shape {found:?} in place of {shape:?}")))
        }
    }
}

/// Rows as a matrix.
pub fn table<T: Element, const N: usize>(py: Python<'_>, rows: Vec<[T; N]>) -> PyResult<Bound<'_, PyAny>> {
    let shape = (rows.len(), N);
    let array =
        Array2::from_shape_vec(shape, rows.into_flattened()).map_err(|e| PyTypeError::new_err(e.to_string()))?;
    Ok(array.into_pyarray(py).into_any())
}

/// Rows of corners as an array of faces, corners and values.
pub fn cube<T: Element, const N: usize>(py: Python<'_>, corners: Vec<[T; N]>) -> PyResult<Bound<'_, PyAny>> {
    let shape = (corners.len() / 3, 3, N);
    let array =
        Array3::from_shape_vec(shape, corners.into_flattened()).map_err(|e| PyTypeError::new_err(e.to_string()))?;
    Ok(array.into_pyarray(py).into_any())
}

/// Values as a column.
pub fn column<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    Array1::from_vec(values).into_pyarray(py)
}
