//! The folder a mesh file lies in, and the references from the file that are safe to follow: downwards only.

use crate::model::TextureSource;
use std::path::{Component, Path, PathBuf};

/// Where side files may be looked for; nowhere for a stream.
#[derive(Clone, Debug, Default)]
pub(crate) struct Folder {
    path: Option<PathBuf>,
}

impl Folder {
    /// The folder of the file at `path`.
    pub fn of(path: &Path) -> Self {
        let parent = path.parent().unwrap_or(Path::new(""));
        Self { path: Some(if parent.as_os_str().is_empty() { PathBuf::from(".") } else { parent.to_path_buf() }) }
    }

    /// The existing regular file that `reference` names inside this folder, or why there is none. Absolute paths,
    /// `..`, drive letters, URLs, and symbolic links that lead out of the folder are refused.
    pub fn find(&self, reference: &str) -> Result<PathBuf, &'static str> {
        let folder = self.path.as_ref().ok_or("a stream has no side files")?;
        let relative = reference.replace('\\', "/");
        let outside = "the reference leaves the file's folder";
        if relative.contains(':') || relative.contains('\0') {
            return Err(outside);
        }
        let relative = Path::new(&relative);
        if !relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir)) {
            return Err(outside);
        }
        let path = folder.join(relative);
        let missing = "the file is missing";
        let (real, home) = (path.canonicalize().map_err(|_| missing)?, folder.canonicalize().map_err(|_| missing)?);
        if !real.starts_with(&home) {
            return Err(outside);
        }
        if real.is_file() { Ok(path) } else { Err(missing) }
    }

    /// Where the picture called `name` is.
    pub fn texture(&self, name: &str) -> TextureSource {
        self.find(name).map_or(TextureSource::Missing, TextureSource::File)
    }
}
