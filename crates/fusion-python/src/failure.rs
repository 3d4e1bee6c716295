//! Python exceptions: the classes are in `fusion_mesh/_errors.py`, one for each exit code of the program.

use crate::value::plain;
use fusion::operation::OptionError;
use fusion::{Code, Diagnostic, Error, Severity, mesh_io};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// Why a job gives no result.
#[derive(Debug)]
pub enum Fault {
    /// An option is wrong.
    Usage(OptionError),
    /// An option has a value that it cannot be read from.
    BadOption(String),
    /// A file cannot be read.
    Unreadable(String),
    /// A file cannot be written.
    Unwritable(String),
    /// The engine says why.
    Engine(Error),
    /// The request is impossible on this input.
    Impossible(String),
    /// Asked to stop.
    Cancelled,
    /// A mistake of ours.
    Internal(String),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        match error {
            Error::Option(option) => Self::Usage(option),
            Error::Document(document) => Self::Unreadable(document.to_string()),
            error if error.is_cancelled() => Self::Cancelled,
            error => Self::Engine(error),
        }
    }
}

impl From<OptionError> for Fault {
    fn from(error: OptionError) -> Self {
        Self::Usage(error)
    }
}

impl From<mesh_io::Error> for Fault {
    fn from(error: mesh_io::Error) -> Self {
        match error {
            mesh_io::Error::Unwritable { .. } => Self::Unwritable(error.to_string()),
            mesh_io::Error::Unrepresentable { .. } => Self::Impossible(error.to_string()),
            error => Self::Unreadable(error.to_string()),
        }
    }
}

impl Fault {
    /// The exception that says so.
    pub fn raise(self, py: Python<'_>) -> PyErr {
        let told = |code, message: String| Diagnostic::new(code, Severity::Error, message);
        let (class, told) = match self {
            Self::Cancelled => return PyKeyboardInterrupt::new_err("cancelled"),
            Self::Usage(error) => ("UsageError", told(Code::Other, error.to_string())),
            Self::BadOption(message) => ("UsageError", told(Code::Other, message)),
            Self::Unreadable(message) => ("InputError", told(Code::Unreadable, message)),
            Self::Unwritable(message) => ("OutputError", told(Code::Unwritable, message)),
            Self::Impossible(message) => ("InfeasibleError", told(Code::Impossible, message)),
            Self::Internal(message) => ("FusionError", told(Code::Other, message)),
            Self::Engine(error) if error.is_invalid_result() => ("InvalidResultError", Diagnostic::of(&error)),
            Self::Engine(error) => ("InfeasibleError", Diagnostic::of(&error)),
        };
        error(py, class, &told).unwrap_or_else(|broken| broken)
    }
}

/// An input that cannot be.
pub fn bad_input(py: Python<'_>, message: String) -> PyErr {
    Fault::Unreadable(message).raise(py)
}

fn error(py: Python<'_>, class: &str, told: &Diagnostic) -> PyResult<PyErr> {
    let class = py.import("fusion_mesh._errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call1((told.message.as_str(), plain(py, told)?))?))
}
