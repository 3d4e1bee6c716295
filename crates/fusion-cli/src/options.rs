//! Options of an operation: the files they name, and what is wrong with them.

use crate::failure::Failure;
use crate::session::Session;
use crate::shared_args::Source;
use fusion::document::Sources;
use fusion::mesh_core::TriMesh;
use fusion::operation::{Files, OptionError};
use mesh_io::Model;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// An option with a value that it cannot have.
pub fn wrong(error: &OptionError) -> Failure {
    Failure::usage(format!("{}: {}", flag(error), error.reason))
}

/// An option whose file cannot be read.
pub fn unread(error: &OptionError) -> Failure {
    Failure::unreadable(format!("{}: {}", flag(error), error.reason))
}

fn flag(error: &OptionError) -> String {
    format!("--{}", error.option.replace('_', "-"))
}

/// Reads the files that options name.
pub struct Read<'a> {
    session: &'a Session,
    /// What their paths are relative to.
    folder: &'a Path,
}

impl<'a> Read<'a> {
    /// Paths as the user typed them.
    pub fn new(session: &'a Session) -> Self {
        Self { session, folder: Path::new("") }
    }

    /// Paths relative to a folder.
    pub fn beside(session: &'a Session, folder: &'a Path) -> Self {
        Self { session, folder }
    }
}

impl Sources for Read<'_> {
    fn model(&mut self, path: &Path) -> Result<Arc<Model>, String> {
        let read = self.session.read(&self.folder.join(path), &Source { from: None });
        read.map(Arc::new).map_err(|e| e.to_string())
    }
}

impl Files for Read<'_> {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        fs::read_to_string(self.folder.join(path)).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        self.model(path).map(|model| model.mesh.clone())
    }
}
