//! Where a document's meshes and files come from.

use crate::operation::Files;
use mesh_core::TriMesh;
use mesh_io::Model;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where parts come from, by the paths that a document gives them.
pub trait Sources: Files {
    /// The contents of a mesh file.
    ///
    /// # Errors
    /// A sentence with the file's name.
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String>;
}

/// A folder, which paths are relative to.
#[derive(Clone, Debug)]
pub struct Folder(pub PathBuf);

impl Sources for Folder {
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String> {
        mesh_io::read(&self.0.join(path)).map(Arc::new).map_err(|e| e.to_string())
    }
}

impl Files for Folder {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        fs::read_to_string(self.0.join(path)).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        self.model(path).map(|model| model.mesh.clone())
    }
}

/// Meshes in memory, by the paths that stand for them. There are no other files.
#[derive(Clone, Debug, Default)]
pub struct Given(pub BTreeMap<PathBuf, Arc<Model>>);

impl Sources for Given {
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String> {
        self.0.get(path).cloned().ok_or_else(|| format!("{} was not given", path.display()))
    }
}

impl Files for Given {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        Err(format!("{} was not given", path.display()))
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        self.model(path).map(|model| model.mesh.clone())
    }
}
