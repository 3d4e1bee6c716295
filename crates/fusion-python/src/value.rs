//! Options and reports as plain Python values. Numbers pass as they are, never through text.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde_json::{Map, Number, Value};

/// How deep values may nest.
const DEPTH: usize = 16;

/// Keyword arguments as a JSON object; `None` stands for an option that is not given.
pub fn options_from(options: &Bound<'_, PyDict>) -> PyResult<Map<String, Value>> {
    let mut map = Map::new();
    for (key, value) in options.iter() {
        let key: String = key.extract()?;
        if !value.is_none() {
            let value = from_python(&value, &key, DEPTH)?;
            map.insert(key, value);
        }
    }
    Ok(map)
}

/// One value as JSON.
pub fn value_from(value: &Bound<'_, PyAny>, name: &str) -> PyResult<Value> {
    from_python(value, name, DEPTH)
}

fn from_python(object: &Bound<'_, PyAny>, option: &str, depth: usize) -> PyResult<Value> {
    if depth == 0 {
        return Err(PyValueError::new_err(format!("{option}: nested too deeply")));
    }
    if object.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(flag) = object.cast::<PyBool>() {
        return Ok(Value::Bool(flag.is_true()));
    }
    if object.is_instance_of::<PyInt>() {
        let number = object.extract::<i64>().map(Number::from).or_else(|_| object.extract::<u64>().map(Number::from));
        return number
            .map(Value::Number)
            .map_err(|_| PyValueError::new_err(format!("{option}: {object} is too large")));
    }
    if let Ok(number) = object.cast::<PyFloat>() {
        let finite = Number::from_f64(number.value()).map(Value::Number);
        return finite.ok_or_else(|| PyValueError::new_err(format!("{option}: {object} is not a finite number")));
    }
    if let Ok(text) = object.cast::<PyString>() {
        return Ok(Value::String(text.extract()?));
    }
    if object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>() {
        let items = object.try_iter()?.map(|item| from_python(&item?, option, depth - 1));
        return Ok(Value::Array(items.collect::<PyResult<_>>()?));
    }
    if let Ok(table) = object.cast::<PyDict>() {
        let entry = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
            Ok((key.str()?.extract()?, from_python(&value, option, depth - 1)?))
        };
        return Ok(Value::Object(table.iter().map(entry).collect::<PyResult<_>>()?));
    }
    // Arrays and scalars of NumPy, and paths.
    for method in ["tolist", "__fspath__"] {
        if object.hasattr(method)? {
            return from_python(&object.call_method0(method)?, option, depth - 1);
        }
    }
    let kind = object.get_type().name()?;
    Err(PyTypeError::new_err(format!("{option}: a value of type {kind} is not an option's value")))
}

/// A JSON value as Python's own.
pub fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Value::Number(number) => match (number.as_i64(), number.as_u64()) {
            (Some(whole), _) => whole.into_pyobject(py)?.into_any(),
            (_, Some(whole)) => whole.into_pyobject(py)?.into_any(),
            _ => PyFloat::new(py, number.as_f64().unwrap_or(f64::NAN)).into_any(),
        },
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Array(items) => {
            let list = PyList::empty(py);
            items.iter().try_for_each(|item| list.append(to_python(py, item)?))?;
            list.into_any()
        }
        Value::Object(entries) => {
            let dict = PyDict::new(py);
            entries.iter().try_for_each(|(key, value)| dict.set_item(key, to_python(py, value)?))?;
            dict.into_any()
        }
    })
}

/// Anything that is written as JSON, as Python's own values.
pub fn plain<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let value = serde_json::to_value(value).map_err(|e| PyValueError::new_err(e.to_string()))?;
    to_python(py, &value)
}
