//! A shape as a file: the bytes that `fusion-cli run` writes.

use crate::edit::{self, At, Kind};
use crate::refusal::Refusal;
use crate::root::{below, from_folder};
use crate::sources::Rooted;
use crate::studio::Studio;
use fusion::Document;
use fusion::document::Precisions;
use fusion::mesh_core::Watch;
use mesh_io::{AtomicFiles, Format};
use serde_json::{Map, Value, json};
use std::path::Path;

/// Writes the shape `of` of the document to a file below the root, and sees that the document says so.
///
/// # Errors
/// [`Refusal`]; there is no file then, or the old one.
pub fn export(studio: &Studio, of: &str, file: &str, watch: &Watch) -> Result<Value, Refusal> {
    let path = below("", Path::new(file))?;
    let place = studio.root.place("", Path::new(&path))?;
    let format = Format::from_path(&place)?;
    let (text, folder) = {
        let desk = studio.desk();
        (desk.document().to_toml(), desk.folder().to_string())
    };
    let document = with_one_output(&text, of, &from_folder(&folder, &path))?;
    let mut sources = Rooted { root: &studio.root, folder: &folder, meshes: &studio.meshes };
    let made = document.evaluate_from(&mut sources, &studio.cache, Precisions::ByFile, watch)?;
    let mut staged = AtomicFiles::default();
    for output in &made.outputs {
        mesh_io::stage_as(&output.outcome.model, &place, format, &mut staged)?;
    }
    staged.commit()?;
    let version = studio.add_output(of, &path)?;
    let warnings = made.outputs.first().map(|output| &output.outcome.report.warnings);
    Ok(json!({ "path": path, "version": version, "warnings": warnings }))
}

/// The document with this output alone.
fn with_one_output(text: &str, of: &str, file: &str) -> Result<Document, Refusal> {
    let mut text = text.to_string();
    for _ in Document::parse(&text)?.outputs() {
        text = edit::remove(&text, &At { table: Kind::Output, index: 0, name: String::new() })?;
    }
    let keys = [("of", json!(of)), ("file", json!(file))];
    Ok(Document::parse(&edit::add(&text, Kind::Output, &keys, &Map::new(), None)?)?)
}
