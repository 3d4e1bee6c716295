//! Files that appear together or not at all.

use crate::error::Error;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// Files of one job, each written beside its place and moved there by [`AtomicFiles::commit`]. What is not committed is removed.
///
/// ```
/// use std::io::Write;
/// # let folder = tempfile::tempdir()?;
/// let path = folder.path().join("a.txt");
/// let mut files = mesh_io::AtomicFiles::default();
/// files.add(&path, |file| file.write_all(b"all of it"))?;
/// assert!(!path.exists());
/// files.commit()?;
/// assert_eq!(std::fs::read(&path)?, b"all of it");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct AtomicFiles {
    files: Vec<(TempPath, PathBuf)>,
    bytes: u64,
}

impl AtomicFiles {
    /// Writes a file beside `target`, with the permissions of the file that it is to replace, or of one made the usual way. A target that
    /// is no regular file (a pipe, a device) is written directly.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn add(&mut self, target: &Path, fill: impl FnOnce(&mut fs::File) -> io::Result<()>) -> Result<(), Error> {
        self.stage(target, fill).map_err(|source| Error::Unwritable { path: target.to_owned(), source })
    }

    fn stage(&mut self, target: &Path, fill: impl FnOnce(&mut fs::File) -> io::Result<()>) -> io::Result<()> {
        let known = fs::metadata(target).ok();
        if known.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if known.as_ref().is_some_and(|m| !m.is_file()) {
            return fill(&mut fs::OpenOptions::new().write(true).open(target)?);
        }
        let name = target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
        let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        // Made by hand, so that the file has the usual permissions and an error names no temporary file.
        let mut file = tempfile::Builder::new()
            .prefix(&format!(".{}.", name.to_string_lossy()))
            .suffix(".part")
            .make_in(folder, |path| fs::OpenOptions::new().write(true).create_new(true).open(path))?;
        fill(file.as_file_mut())?;
        self.bytes += file.as_file().metadata()?.len();
        if let Some(known) = known {
            fs::set_permissions(file.path(), known.permissions())?;
        }
        self.files.push((file.into_temp_path(), target.to_owned()));
        Ok(())
    }

    /// Moves everything into place, in the order in which it was added, and gives the files and their size in all. If one cannot be moved,
    /// those moved before it get their old contents back.
    ///
    /// # Errors
    /// [`Error::Unwritable`].
    pub fn commit(self) -> Result<(Vec<PathBuf>, u64), Error> {
        let count = self.files.len();
        let mut moved: Vec<(PathBuf, Option<TempPath>)> = vec![];
        for (i, (temporary, target)) in self.files.into_iter().enumerate() {
            // A backup is needed only if something can still fail after this file was moved.
            let backup = temporary.with_extension("old");
            let backup = (i + 1 < count && fs::hard_link(&target, &backup).is_ok())
                .then(|| TempPath::try_from_path(backup).ok())
                .flatten();
            if let Err(failed) = temporary.persist(&target) {
                for (target, backup) in moved.into_iter().rev() {
                    let _ = match backup {
                        Some(backup) => backup.persist(target).map_err(|e| e.error),
                        None => fs::remove_file(target),
                    };
                }
                return Err(Error::Unwritable { path: target, source: failed.error });
            }
            moved.push((target, backup));
        }
        Ok((moved.into_iter().map(|(target, _)| target).collect(), self.bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn listed(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn a_failure_leaves_everything_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let [old, new, last] = ["old", "new", "last"].map(|name| folder.path().join(name));
        fs::write(&old, "before").unwrap();
        let mut files = AtomicFiles::default();
        for path in [&old, &new, &last] {
            files.add(path, |f| f.write_all(b"after")).unwrap();
        }
        // The last target becomes a folder with something in it: no file can take its place.
        fs::create_dir(&last).unwrap();
        fs::write(last.join("inside"), "").unwrap();
        assert!(matches!(files.commit(), Err(Error::Unwritable { path, .. }) if path == last));
        assert_eq!(fs::read_to_string(&old).unwrap(), "before");
        assert_eq!(listed(folder.path()), ["last", "old"]);
    }

    #[test]
    fn what_is_not_committed_or_not_filled_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let mut files = AtomicFiles::default();
        files.add(&path, |f| f.write_all(b"some")).unwrap();
        assert!(files.add(&path, |_| Err(io::ErrorKind::StorageFull.into())).is_err());
        drop(files);
        assert!(listed(folder.path()).is_empty());
        let missing = folder.path().join("no/such/file");
        let error = AtomicFiles::default().add(&missing, |_| Ok(())).unwrap_err().to_string();
        assert!(!error.contains(".part"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_the_old_ones_or_the_usual() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [old, new, usual] = ["old", "new", "usual"].map(|name| folder.path().join(name));
        fs::write(&old, "").unwrap();
        fs::write(&usual, "").unwrap();
        fs::set_permissions(&old, fs::Permissions::from_mode(0o600)).unwrap();
        let mut files = AtomicFiles::default();
        files.add(&old, |_| Ok(())).unwrap();
        files.add(&new, |_| Ok(())).unwrap();
        files.commit().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!((mode(&old), mode(&new)), (0o600, mode(&usual)));
    }
}
