//! Why a request is not done, as the page shows it.

use crate::edit::EditError;
use crate::root::PathError;
use fusion::{Diagnostic, mesh_io};
use serde_json::{Value, json};

/// A sentence, where it is known a line of the document or a place in the model, and a way out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Refusal {
    /// What the user reads.
    pub sentence: String,
    /// A line of the document, from 1.
    pub line: Option<usize>,
    /// A place in model units.
    pub place: Option<[f64; 3]>,
    /// A button: its label, and the request that it sends, if there is one.
    pub remedy: Option<(String, Option<Value>)>,
}

impl Refusal {
    /// A sentence alone.
    pub fn new(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), ..Self::default() }
    }

    /// What the engine says.
    pub fn of(error: &fusion::Error) -> Self {
        let told = Diagnostic::of(error);
        let line = match error {
            fusion::Error::Document(e) => Some(e.line).filter(|&line| line > 0),
            _ => None,
        };
        Self { sentence: told.message, line, place: told.at, remedy: told.remedy.map(|label| (label, None)) }
    }

    /// As JSON, with further keys before it.
    pub fn to_json(&self, mut keys: Value) -> Value {
        keys["sentence"] = self.sentence.as_str().into();
        if let Some(line) = self.line {
            keys["line"] = line.into();
        }
        if let Some(place) = self.place {
            keys["place"] = json!(place);
        }
        if let Some((label, edit)) = &self.remedy {
            keys["remedy"] = json!({ "label": label });
            if let Some(edit) = edit {
                keys["remedy"]["edit"] = edit.clone();
            }
        }
        keys
    }
}

impl From<fusion::document::Error> for Refusal {
    fn from(error: fusion::document::Error) -> Self {
        Self { line: Some(error.line).filter(|&line| line > 0), ..Self::new(error.to_string()) }
    }
}

impl From<EditError> for Refusal {
    fn from(error: EditError) -> Self {
        Self::new(error.to_string())
    }
}

impl From<PathError> for Refusal {
    fn from(error: PathError) -> Self {
        Self::new(error.to_string())
    }
}

impl From<mesh_io::Error> for Refusal {
    fn from(error: mesh_io::Error) -> Self {
        Self::new(error.to_string())
    }
}

impl From<fusion::Error> for Refusal {
    fn from(error: fusion::Error) -> Self {
        Self::of(&error)
    }
}
