//! Documents: texts checked and added to, evaluated on files and on meshes in memory.

use crate::failure::Fault;
use fusion::document::{Cache, Document, Evaluation, Precisions, Sources};
use fusion::mesh_core::{TriMesh, Watch};
use fusion::mesh_io::{self, Format, Model};
use fusion::operation::{Files, Precision};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a text says: parameters, parts, steps, outputs, and the shapes that are left over.
pub fn outline(text: &str) -> Result<Value, Fault> {
    let document = Document::parse(text).map_err(|e| Fault::Unreadable(e.to_string()))?;
    let part = |p: &fusion::document::Part| json!({ "name": p.name, "mesh": p.mesh });
    let step = |s: &fusion::document::Step| json!({ "do": s.action.verb(), "of": s.of, "as": s.name, "off": s.is_off });
    let output = |o: &fusion::document::Output| json!({ "of": o.of, "file": o.file });
    Ok(json!({
        "parameters": document.parameters(),
        "unused_parameters": document.unused_parameters(),
        "parts": document.parts().iter().map(part).collect::<Vec<_>>(),
        "steps": document.steps().iter().map(step).collect::<Vec<_>>(),
        "outputs": document.outputs().iter().map(output).collect::<Vec<_>>(),
        "left_over": document.left_over(),
    }))
}

/// The text with further tables at its end.
pub fn extended(text: &str, tables: &Map<String, Value>) -> Result<String, Fault> {
    let added = toml::to_string(tables).map_err(|e| Fault::BadOption(e.to_string()))?;
    checked(format!("{}\n\n{added}", text.trim_end()))
}

/// The text with a parameter, new or not.
pub fn with_parameter(text: &str, name: &str, value: &Value) -> Result<String, Fault> {
    let wrong = |e: String| Fault::BadOption(format!("{name}: {e}"));
    let mut edited: toml_edit::DocumentMut =
        text.parse().map_err(|e: toml_edit::TomlError| wrong(e.message().into()))?;
    let parameters = edited.entry("parameters").or_insert_with(toml_edit::table);
    let table = parameters.as_table_like_mut().ok_or_else(|| wrong("`parameters` is not a table".into()))?;
    table.insert(name, toml_edit::Item::Value(written(value).map_err(wrong)?));
    checked(edited.to_string())
}

/// The text with another value for a parameter, or for an option of a numbered step.
pub fn with_value(text: &str, name: &str, value: &Value) -> Result<String, Fault> {
    let wrong = |e: String| Fault::BadOption(format!("{name}: {e}"));
    let mut document = Document::parse(text).map_err(|e| Fault::Unreadable(e.to_string()))?;
    let value = written(value).map_err(wrong)?.to_string();
    document.set(name, &value).map_err(|e| Fault::BadOption(e.to_string()))?;
    Ok(document.to_toml())
}

/// A value as TOML writes it.
fn written(value: &Value) -> Result<toml_edit::Value, String> {
    let text = toml::Value::try_from(value).map_err(|e| e.to_string())?.to_string();
    text.parse().map_err(|e: toml_edit::TomlError| e.message().into())
}

fn checked(text: String) -> Result<String, Fault> {
    match Document::parse(&text) {
        Ok(_) => Ok(text),
        Err(e) => Err(Fault::BadOption(e.to_string())),
    }
}

/// Meshes in memory by the paths that stand for them, and files relative to a folder.
pub struct Beside {
    /// The folder.
    pub folder: PathBuf,
    /// The meshes.
    pub meshes: BTreeMap<PathBuf, Arc<Model>>,
}

impl Sources for Beside {
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String> {
        match self.meshes.get(path) {
            Some(model) => Ok(Arc::clone(model)),
            None => mesh_io::read(&self.folder.join(path)).map(Arc::new).map_err(|e| e.to_string()),
        }
    }
}

impl Files for Beside {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        fs::read_to_string(self.folder.join(path)).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        self.model(path).map(|model| model.mesh.clone())
    }
}

/// Evaluates a document. Without a precision each output survives what its file can hold.
pub fn evaluate(
    text: &str,
    mut beside: Beside,
    cache: &Cache,
    precision: Option<Precision>,
    watch: &Watch,
) -> Result<Evaluation, Fault> {
    let document = Document::parse(text).map_err(|e| Fault::Unreadable(e.to_string()))?;
    let precisions = precision.map_or(Precisions::ByFile, Precisions::All);
    Ok(document.evaluate_from(&mut beside, cache, precisions, watch)?)
}

/// What a result survives that was made for a file.
pub fn precision_of(file: &Path, given: Option<Precision>) -> Precision {
    let by_file = || match Format::from_path(file) {
        Ok(format) if !format.is_lossless() => Precision::F32,
        _ => Precision::F64,
    };
    given.unwrap_or_else(by_file)
}
