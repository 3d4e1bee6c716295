//! Meshes and files of a document, below the root; a mesh is read once for every save of its file.

use crate::root::{PathError, Root};
use fusion::document::Sources;
use fusion::mesh_core::TriMesh;
use fusion::operation::Files;
use mesh_io::Model;
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// The longest text file that an option may name.
const LONGEST_TEXT: u64 = 64 << 20;

/// When a file was saved, and how long it is.
type Stamp = (SystemTime, u64);

/// Meshes that were read, by their files.
#[derive(Debug, Default)]
pub struct Meshes(Mutex<HashMap<PathBuf, (Stamp, Arc<Model>)>>);

/// Files relative to a document's folder.
pub struct Rooted<'a> {
    /// What everything is below.
    pub root: &'a Root,
    /// The document's folder, relative to the root.
    pub folder: &'a str,
    /// What is known.
    pub meshes: &'a Meshes,
}

impl Meshes {
    fn read(&self, file: &Path) -> Result<Arc<Model>, String> {
        let told = |e: &dyn std::fmt::Display| format!("{}: {e}", name(file));
        let about = fs::metadata(file).map_err(|e| told(&e))?;
        let stamp = (about.modified().unwrap_or(SystemTime::UNIX_EPOCH), about.len());
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, model)) = known.get(file).filter(|(of, _)| *of == stamp) {
            return Ok(Arc::clone(model));
        }
        let model = Arc::new(mesh_io::read(file).map_err(|e| e.to_string())?);
        // A file may have been left out of the document meanwhile: what nobody else holds is not kept.
        known.retain(|_, (_, held)| Arc::strong_count(held) > 1);
        known.insert(file.to_path_buf(), (stamp, Arc::clone(&model)));
        Ok(model)
    }
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned()
}

impl Rooted<'_> {
    fn find(&self, path: &Path) -> Result<PathBuf, String> {
        self.root.existing(self.folder, path).map_err(|e: PathError| e.to_string())
    }
}

impl Sources for Rooted<'_> {
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String> {
        self.meshes.read(&self.find(path)?)
    }
}

impl Files for Rooted<'_> {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        let file = self.find(path)?;
        let told = |e: std::io::Error| format!("{}: {e}", path.display());
        if fs::metadata(&file).map_err(told)?.len() > LONGEST_TEXT {
            return Err(format!("{} is longer than {} MB", path.display(), LONGEST_TEXT >> 20));
        }
        fs::read_to_string(file).map_err(told)
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        self.model(path).map(|model| model.mesh.clone())
    }
}
