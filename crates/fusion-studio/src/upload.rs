//! Files that come from the page.

use crate::root::{PathError, Root};
use axum::body::Body;
use http_body_util::BodyExt;
use mesh_io::Format;
use std::fs;
use std::io::{self, Read, Write};
use std::path::Path;
use tempfile::NamedTempFile;

/// The most bytes of a file.
pub const MOST: u64 = 512 << 20;

/// Files that belong to meshes.
const SIDES: [&str; 7] = ["bin", "mtl", "png", "jpg", "jpeg", "webp", "toml"];

/// Why a file is not taken.
#[derive(Debug, thiserror::Error)]
pub enum UploadError {
    /// Too long.
    #[error("the file is longer than {} MB", MOST >> 20)]
    TooLong,
    /// A name with folders, hidden, or of another kind.
    #[error("{0} is not the name of a mesh file, or of a file that belongs to one")]
    Name(String),
    /// The client was gone before the end.
    #[error("the file did not come to its end")]
    Broken,
    /// It cannot be written.
    #[error(transparent)]
    Path(#[from] PathError),
    /// It cannot be written.
    #[error("the file cannot be written: {0}")]
    Io(#[from] io::Error),
}

/// Writes a body to a file of this name in the root, and gives its path relative to the root.
///
/// # Errors
/// [`UploadError`]; nothing is left of the file then.
pub async fn upload(root: &Root, name: &str, length: Option<u64>, mut body: Body) -> Result<String, UploadError> {
    check_name(name)?;
    root.place("", Path::new(name))?;
    if length.is_some_and(|length| length > MOST) {
        return Err(UploadError::TooLong);
    }
    let mut file = root.beside(&root.folder().join(name))?;
    let mut taken = 0;
    while let Some(frame) = body.frame().await {
        let Ok(bytes) = frame.map_err(|_| UploadError::Broken)?.into_data() else { continue };
        taken += bytes.len() as u64;
        if taken > MOST {
            return Err(UploadError::TooLong);
        }
        file.write_all(&bytes)?;
    }
    keep(root, name, file)
}

/// Moves a file to its name, or to one with a number where other contents have that name.
fn keep(root: &Root, name: &str, mut file: NamedTempFile) -> Result<String, UploadError> {
    file.flush()?;
    let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
    for n in 1..1000 {
        let name = if n == 1 { name.to_string() } else { format!("{stem}-{n}.{extension}") };
        let place = root.place("", Path::new(&name))?;
        if place.exists() {
            if same(&place, file.path())? {
                return Ok(name);
            }
            continue;
        }
        match file.persist_noclobber(&place) {
            Ok(_) => return Ok(name),
            Err(e) if e.error.kind() == io::ErrorKind::AlreadyExists => file = e.file,
            Err(e) => return Err(e.error.into()),
        }
    }
    Err(UploadError::Name(name.into()))
}

fn same(one: &Path, other: &Path) -> io::Result<bool> {
    if fs::metadata(one)?.len() != fs::metadata(other)?.len() {
        return Ok(false);
    }
    let [mut one, mut other] = [one, other].map(fs::File::open);
    let [mut a, mut b] = [vec![0; 1 << 16], vec![0; 1 << 16]];
    let (one, other) =
        (one.as_mut().map_err(|e| io::Error::from(e.kind()))?, other.as_mut().map_err(|e| io::Error::from(e.kind()))?);
    loop {
        let read = one.read(&mut a)?;
        if read == 0 {
            return Ok(true);
        }
        other.read_exact(&mut b[..read])?;
        if a[..read] != b[..read] {
            return Ok(false);
        }
    }
}

fn check_name(name: &str) -> Result<(), UploadError> {
    let path = Path::new(name);
    let is_known = Format::from_path(path).is_ok()
        || path.extension().and_then(|e| e.to_str()).is_some_and(|e| SIDES.contains(&e.to_ascii_lowercase().as_str()));
    let is_plain = !name.starts_with('.')
        && name.len() < 200
        && !name.contains(['/', '\\', ':', '\0'])
        && !name.chars().any(char::is_control);
    if is_known && is_plain { Ok(()) } else { Err(UploadError::Name(name.chars().take(200).collect())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_uploads_are_plain() {
        for good in ["a.obj", "Scan 3 (final).PLY", "a.mtl", "ä.stl"] {
            assert!(check_name(good).is_ok(), "{good}");
        }
        for bad in
            ["../a.obj", "a/b.obj", "C:a.obj", ".hidden.obj", "a.html", "a", "", "a\\b.obj", "a\n.obj", "page.js"]
        {
            assert!(check_name(bad).is_err(), "{bad}");
        }
    }
}
