//! The document on the desk: its text, its past, its file.

use crate::edit::{self, At, Kind, Set};
use crate::history::History;
use crate::rebase::rebased;
use crate::refusal::Refusal;
use crate::rename::renamed;
use crate::request::Edit;
use crate::root::{Root, below, from_folder};
use fusion::Document;
use serde_json::{Map, Value as Json, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// Where an unsaved document is kept, relative to the root.
pub const AUTOSAVE: &str = ".fusion-studio/autosave.toml";

/// Where that of an earlier session, or of one that another took the place of, is put.
pub const EARLIER: &str = ".fusion-studio/earlier.toml";

/// The document and what belongs to it.
#[derive(Debug)]
pub struct Desk {
    history: History,
    /// Rises with every change.
    pub version: u64,
    /// The document's file, relative to the root.
    pub path: Option<String>,
    /// The text in that file.
    saved: String,
    /// Shapes that are shown besides the results.
    pub show: BTreeSet<String>,
}

impl Desk {
    /// An empty document.
    pub fn new() -> Self {
        let document = Document::new();
        let saved = document.to_toml();
        Self { history: History::new(document), version: 0, path: None, saved, show: BTreeSet::new() }
    }

    /// The document as it is.
    pub fn document(&self) -> &Arc<Document> {
        self.history.document()
    }

    /// Its folder, relative to the root.
    pub fn folder(&self) -> &str {
        self.path.as_deref().and_then(|path| path.rsplit_once('/')).map_or("", |(folder, _)| folder)
    }

    /// Whether its file holds what it is.
    pub fn is_saved(&self) -> bool {
        self.document().to_toml() == self.saved
    }

    /// Whether there is a past and a future.
    pub fn can_undo_redo(&self) -> [bool; 2] {
        [self.history.can_undo(), self.history.can_redo()]
    }

    /// The text as it stands in [`AUTOSAVE`].
    pub fn autosave(&self) -> String {
        let folder = AUTOSAVE.rsplit_once('/').map_or("", |(folder, _)| folder);
        rebased(&self.document().to_toml(), self.folder(), folder)
    }

    /// Does an edit, and answers it. The document is as before where that is refused.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn edit(&mut self, root: &Root, edit: Edit) -> Result<Json, Refusal> {
        let text = self.document().to_toml();
        match edit {
            Edit::New => {
                self.put_aside(root);
                self.replace(None, Document::new());
            }
            Edit::Open { path } => self.open(root, &path)?,
            Edit::Save { path } => return self.save(root, path),
            Edit::Text { text } => self.change(&text, None)?,
            Edit::AddPart { mesh, name, options } => {
                let file = below("", Path::new(&mesh))?;
                root.existing("", Path::new(&file))?;
                let name = name.unwrap_or_else(|| self.free_name(&file));
                let mesh = from_folder(self.folder(), &file);
                let keys = [("name", json!(name)), ("mesh", json!(mesh))];
                self.change(&edit::add(&text, Kind::Part, &keys, &options, None)?, None)?;
                return Ok(
                    json!({ "version": self.version, "index": self.document().parts().len() - 1, "name": name }),
                );
            }
            Edit::AddPrimitive { name, options } => {
                self.change(&edit::add_primitive(&text, &name, &options)?, None)?;
                return Ok(json!({ "version": self.version, "name": name }));
            }
            Edit::AddStep { verb, of, name, options, at } => {
                let of = match of.as_deref() {
                    None | Some([]) => Json::Null,
                    Some([one]) => json!(one),
                    Some(several) => json!(several),
                };
                let keys = [("do", json!(verb)), ("of", of), ("as", json!(name))];
                self.change(&edit::add(&text, Kind::Step, &keys, &options, at)?, None)?;
                let steps = self.document().steps();
                let index = at.map_or(steps.len(), |at| at + 1).min(steps.len()) - 1;
                return Ok(json!({ "version": self.version, "index": index, "name": steps[index].name }));
            }
            Edit::AddOutput { of, file } => {
                let index = self.add_output(root, &of, &file)?;
                return Ok(json!({ "version": self.version, "index": index }));
            }
            Edit::Set { set, drag } => self.change(&edit::set(&text, &[set])?, drag)?,
            Edit::SetAll { edits, drag } => self.change(&edit::set(&text, &edits)?, drag)?,
            Edit::Rename { table, index, to } => self.rename(table, index, &to)?,
            Edit::Remove(at) => self.change(&edit::remove(&text, &at)?, None)?,
            Edit::Move { at, to } => self.change(&edit::move_to(&text, &at, to)?, None)?,
            Edit::Undo => self.version += u64::from(self.history.undo()),
            Edit::Redo => self.version += u64::from(self.history.redo()),
        }
        Ok(json!({ "version": self.version }))
    }

    /// Adds an output, or finds the one with this file, and gives its index. `file` is relative to the root.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn add_output(&mut self, root: &Root, of: &str, file: &str) -> Result<usize, Refusal> {
        let file = below("", Path::new(file))?;
        root.place("", Path::new(&file))?;
        mesh_io::Format::from_path(Path::new(&file))?;
        let text = self.document().to_toml();
        let known = |output: &fusion::document::Output| below(self.folder(), &output.file).is_ok_and(|f| f == file);
        let index = self.document().outputs().iter().position(known);
        let text = match index {
            Some(index) if self.document().outputs()[index].of == of => return Ok(index),
            Some(index) => {
                let at = At { table: Kind::Output, index, name: String::new() };
                edit::set(&text, &[Set { at, key: "of".into(), value: of.into() }])?
            }
            None => {
                let keys = [("of", json!(of)), ("file", json!(from_folder(self.folder(), &file)))];
                edit::add(&text, Kind::Output, &keys, &Map::new(), None)?
            }
        };
        self.change(&text, None)?;
        Ok(index.unwrap_or(self.document().outputs().len() - 1))
    }

    fn change(&mut self, text: &str, drag: Option<u64>) -> Result<(), Refusal> {
        let document = Document::parse(text)?;
        if text != self.document().to_toml() {
            self.history.push(document, drag);
            self.version += 1;
        }
        Ok(())
    }

    fn replace(&mut self, path: Option<String>, document: Document) {
        self.saved = document.to_toml();
        self.history = History::new(document);
        self.path = path;
        self.version += 1;
        self.show.clear();
    }

    /// Keeps what another document takes the place of, as far as it is not saved.
    fn put_aside(&self, root: &Root) {
        if !self.is_saved() {
            // What cannot be kept is no reason to refuse what was asked for.
            let _ = root.write(Path::new(EARLIER), self.autosave().as_bytes());
        }
    }

    /// Opens a file. What was kept of an unsaved document comes back as one.
    fn open(&mut self, root: &Root, path: &str) -> Result<(), Refusal> {
        let path = below("", Path::new(path))?;
        let file = root.existing("", Path::new(&path))?;
        let text = fs::read_to_string(&file).map_err(|e| Refusal::new(format!("{path}: {e}")))?;
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        let is_autosave = [AUTOSAVE, EARLIER].contains(&path.as_str());
        let text = if is_autosave { rebased(&text, folder, "") } else { text };
        let wrong = |e| {
            let refusal = Refusal::from(e);
            Refusal { sentence: format!("{path}: {}", refusal.sentence), ..refusal }
        };
        let document = Document::parse(&text).map_err(wrong)?;
        if !is_autosave {
            self.put_aside(root);
        }
        self.replace((!is_autosave).then_some(path), document);
        if is_autosave {
            self.saved.clear();
        }
        Ok(())
    }

    fn save(&mut self, root: &Root, path: Option<String>) -> Result<Json, Refusal> {
        let Some(path) = path.or_else(|| self.path.clone()) else {
            return Err(Refusal::new("the document has no file yet; say which"));
        };
        let path = below("", Path::new(&path))?;
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        let text = rebased(&self.document().to_toml(), self.folder(), folder);
        let document = Document::parse(&text)?;
        root.write(Path::new(&path), text.as_bytes())?;
        if text != self.document().to_toml() {
            // Undo does not lead back to the paths of another folder.
            self.history = History::new(document);
        }
        self.saved = text;
        self.path = Some(path.clone());
        self.version += 1;
        Ok(json!({ "path": path, "version": self.version }))
    }

    fn rename(&mut self, table: Kind, index: usize, to: &str) -> Result<(), Refusal> {
        let document = self.document();
        let old = match table {
            Kind::Part => document.parts().get(index).map(|part| part.name.clone()),
            Kind::Step => document.steps().get(index).map(|step| step.name.clone()),
            _ => return Err(Refusal::new("parts and steps have names")),
        };
        let old = old.ok_or_else(|| {
            Refusal::new(format!("there is no such {}", if table == Kind::Part { "part" } else { "step" }))
        })?;
        if old != to && self.names().contains(to) {
            return Err(Refusal::new(format!("there is another shape `{to}`; names must differ")));
        }
        let text = renamed(&document.to_toml(), &old, to)?;
        self.change(&text, None)
    }

    fn names(&self) -> BTreeSet<&str> {
        let document = self.document();
        let parts = document.parts().iter().map(|part| part.name.as_str());
        parts.chain(document.steps().iter().map(|step| step.name.as_str())).collect()
    }

    /// A name for a part, from its file.
    fn free_name(&self, file: &str) -> String {
        let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy().replace([':', '$'], "-");
        let stem = if stem.is_empty() { "part".to_string() } else { stem };
        let names = self.names();
        let numbered = (2..).map(|n| format!("{stem}-{n}"));
        std::iter::once(stem.clone()).chain(numbered).find(|name| !names.contains(name.as_str())).unwrap_or(stem)
    }
}
