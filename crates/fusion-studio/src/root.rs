//! The folder that everything read and written is below.

use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};

/// A folder, and the paths that are safe to follow from it.
#[derive(Clone, Debug)]
pub struct Root {
    /// Without links.
    folder: PathBuf,
}

/// Why a path is not followed.
#[derive(Debug, thiserror::Error)]
pub enum PathError {
    /// It leaves the root, by its words or by a link.
    #[error("{0} is not below the studio's root folder; copy the file there, or start the studio with --root")]
    Outside(String),
    /// There is no such file.
    #[error("there is no file {0}")]
    Missing(String),
    /// It cannot be read or written.
    #[error("{0}: {1}")]
    Io(String, #[source] io::Error),
}

impl Root {
    /// A folder that exists.
    ///
    /// # Errors
    /// [`PathError::Io`].
    pub fn new(folder: &Path) -> Result<Self, PathError> {
        let folder = folder.canonicalize().map_err(|e| PathError::Io(folder.display().to_string(), e))?;
        Ok(Self { folder })
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A file that exists, from its path relative to `base`, a folder relative to the root.
    ///
    /// # Errors
    /// [`PathError`]: absolute paths, `..` above the root, links that lead out of it, what is no file.
    pub fn existing(&self, base: &str, path: &Path) -> Result<PathBuf, PathError> {
        let relative = below(base, path)?;
        let full = self.folder.join(&relative);
        let real = full.canonicalize().map_err(|e| match e.kind() {
            io::ErrorKind::NotFound => PathError::Missing(relative.clone()),
            _ => PathError::Io(relative.clone(), e),
        })?;
        if !real.starts_with(&self.folder) {
            return Err(PathError::Outside(relative));
        }
        if !real.is_file() {
            return Err(PathError::Missing(relative));
        }
        Ok(real)
    }

    /// A place for a file, whose folder exists.
    ///
    /// # Errors
    /// As [`Self::existing`].
    pub fn place(&self, base: &str, path: &Path) -> Result<PathBuf, PathError> {
        let relative = below(base, path)?;
        let full = self.folder.join(&relative);
        let outside = || PathError::Outside(relative.clone());
        let (Some(parent), Some(name)) = (full.parent(), full.file_name()) else { return Err(outside()) };
        if relative.is_empty() {
            return Err(outside());
        }
        let parent = parent.canonicalize().map_err(|e| PathError::Io(relative.clone(), e))?;
        if !parent.starts_with(&self.folder) {
            return Err(outside());
        }
        let place = parent.join(name);
        // What is there already may be a link, even one that leads nowhere yet.
        if place.symlink_metadata().is_ok_and(|about| about.is_symlink()) {
            let real = place.canonicalize().map_err(|_| outside())?;
            return if real.starts_with(&self.folder) { Ok(real) } else { Err(outside()) };
        }
        Ok(place)
    }

    /// Writes a file at once or not at all: whoever is ended in the middle leaves the old one.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), PathError> {
        let place = self.place("", path)?;
        let failed = |e: io::Error| PathError::Io(path.display().to_string(), e);
        let mut file = self.beside(&place).map_err(failed)?;
        file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
        file.persist(&place).map(drop).map_err(|e| failed(e.error))
    }

    /// A new file beside a place, with the permissions of a file made the usual way.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn beside(&self, place: &Path) -> io::Result<tempfile::NamedTempFile> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".fusion-").suffix(".part");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        builder.tempfile_in(place.parent().unwrap_or(&self.folder))
    }

    /// The path of a file below the root, with `/`, relative to it.
    pub fn relative(&self, file: &Path) -> Option<String> {
        let names = file.strip_prefix(&self.folder).ok()?.components();
        Some(names.map(|c| c.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/"))
    }
}

/// The words of a path below the root, from its base and itself, joined with `/`.
///
/// # Errors
/// [`PathError::Outside`].
pub fn below(base: &str, path: &Path) -> Result<String, PathError> {
    let outside = || PathError::Outside(path.display().to_string());
    let mut words: Vec<String> = base.split('/').filter(|word| !word.is_empty()).map(Into::into).collect();
    let text = path.to_str().ok_or_else(outside)?;
    if text.contains('\0') || (cfg!(windows) && text.contains(':')) {
        return Err(outside());
    }
    for component in path.components() {
        match component {
            Component::Normal(word) => words.push(word.to_string_lossy().into_owned()),
            Component::CurDir => {}
            Component::ParentDir => drop(words.pop().ok_or_else(outside)?),
            Component::RootDir | Component::Prefix(_) => return Err(outside()),
        }
    }
    Ok(words.join("/"))
}

/// A file's path relative to a folder, both below the root and with `/`.
pub fn from_folder(folder: &str, file: &str) -> String {
    let words = |path: &str| path.split('/').filter(|w| !w.is_empty()).map(String::from).collect::<Vec<_>>();
    let (folder, file) = (words(folder), words(file));
    let shared = folder.iter().zip(&file).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_string(), folder.len() - shared);
    up.chain(file.into_iter().skip(shared)).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_between_folders() {
        assert_eq!(from_folder("a/b", "a/c.obj"), "../c.obj");
        assert_eq!(from_folder("", "a/c.obj"), "a/c.obj");
        assert_eq!(below("a/b", Path::new("../c.obj")).unwrap(), "a/c.obj");
        for bad in ["../x", "/etc/passwd", "a/../../x", "a\0b"] {
            assert!(below("", Path::new(bad)).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_write_replaces_the_whole_file_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let root = Root::new(folder.path()).unwrap();
        root.write(Path::new("a.toml"), b"old and long").unwrap();
        root.write(Path::new("a.toml"), b"new").unwrap();
        assert_eq!(std::fs::read(folder.path().join("a.toml")).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(root.write(Path::new("../b.toml"), b"new").is_err());
        assert!(root.write(Path::new(""), b"new").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_out_of_the_root_are_not_followed() {
        let [inside, outside] = [(); 2].map(|()| tempfile::tempdir().unwrap());
        let root = Root::new(inside.path()).unwrap();
        std::fs::write(outside.path().join("secret"), "x").unwrap();
        std::os::unix::fs::symlink(outside.path(), inside.path().join("folder")).unwrap();
        std::os::unix::fs::symlink(outside.path().join("secret"), inside.path().join("file")).unwrap();
        std::os::unix::fs::symlink(outside.path().join("nothing"), inside.path().join("dangling")).unwrap();
        for path in ["folder/secret", "file", "dangling"] {
            assert!(root.existing("", Path::new(path)).is_err(), "{path}");
            assert!(root.place("", Path::new(path)).is_err(), "{path}");
        }
    }
}
