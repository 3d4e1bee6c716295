//! Files that appear all at once or not at all.

use crate::failure::Failure;
use crate::progress::hold_cancel;
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Files of one job. Each is written beside its place; [`Outputs::commit_after`] moves them there.
#[derive(Default)]
pub struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Outputs {
    /// Adds a file.
    pub fn add(&mut self, path: impl Into<PathBuf>, bytes: Vec<u8>) {
        self.files.push((path.into(), bytes));
    }

    /// Writes every file, or none. `main_file` writes the one they belong to, once nothing else can fail any more.
    pub fn commit_after(self, main_file: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
        let _guard = hold_cancel();
        // A device or pipe such as /dev/null must be written, not replaced.
        let (special, regular): (Vec<_>, Vec<_>) = self.files.into_iter().partition(|(path, _)| is_special(path));
        let staged = regular.into_iter().map(|(path, bytes)| stage(path, &bytes)).collect::<Result<Vec<_>, _>>()?;
        main_file()?;
        for (path, bytes) in special {
            fs::write(&path, bytes).map_err(|e| cannot_write(&path, &e))?;
        }
        for (file, place) in staged {
            file.persist(&place).map_err(|e| cannot_write(&place, &e.error))?;
        }
        Ok(())
    }
}

/// Writes a file beside its place.
fn stage(path: PathBuf, bytes: &[u8]) -> Result<(NamedTempFile, PathBuf), Failure> {
    check_no_folder(&path)?;
    // What a link points to is replaced, not the link.
    let place = fs::canonicalize(&path).unwrap_or(path);
    let write = || {
        let mut file = beside(&place)?;
        file.write_all(bytes)?;
        file.flush()?;
        if let Ok(old) = fs::metadata(&place) {
            fs::set_permissions(file.path(), old.permissions())?;
        }
        Ok(file)
    };
    write().map_err(|e| cannot_write(&place, &e)).map(|file| (file, place))
}

/// Fails now, before the work, where a file could not be written after it.
pub fn check_writable(path: &Path) -> Result<(), Failure> {
    if is_special(path) {
        return Ok(());
    }
    check_no_folder(path)?;
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    beside(&place).map(drop).map_err(|e| cannot_write(&place, &e))
}

/// Makes a folder that files can be written into, with those above it.
pub fn make_folder(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder)
        .and_then(|()| beside(&folder.join("any")).map(drop))
        .map_err(|e| cannot_write(folder, &e))
}

fn check_no_folder(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::unwritable(format!("cannot write {}: it is a folder", path.display())));
    }
    Ok(())
}

/// Prints a result on standard output. A reader that has seen enough, such as `head`, is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(cannot_write(Path::new("standard output"), &e)),
        _ => Ok(()),
    }
}

/// Writes a mesh to standard output, which must take all of it.
pub fn stream(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|e| cannot_write(Path::new("standard output"), &e))
}

/// Whether a path is a device or pipe.
pub fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// A new file in the same folder, so that moving it is atomic, with the permissions of a file made the usual way.
fn beside(place: &Path) -> std::io::Result<NamedTempFile> {
    let folder = place.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".fusion-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::unwritable(format!("cannot write {}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_where_one_file_cannot_be() {
        let dir = tempfile::tempdir().unwrap();
        let good = dir.path().join("good.txt");
        fs::write(&good, "old").unwrap();
        for bad in [dir.path().join("missing/bad.txt"), dir.path().to_path_buf()] {
            let mut outputs = Outputs::default();
            outputs.add(&good, b"new".to_vec());
            outputs.add(&bad, b"new".to_vec());
            assert!(check_writable(&bad).is_err() && outputs.commit_after(|| Ok(())).is_err());
            assert_eq!(fs::read_to_string(&good).unwrap(), "old");
            assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1, "no leftovers");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_keep_pointing_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let (file, link) = (dir.path().join("file"), dir.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let mut outputs = Outputs::default();
        outputs.add(&link, b"new".to_vec());
        outputs.commit_after(|| Ok(())).unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
    }
}
