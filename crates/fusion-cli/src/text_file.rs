//! Text files beside the meshes: curves, clusters, profiles, origins, face ids.

use crate::failure::Failure;
use std::fmt::Display;
use std::fs;
use std::path::Path;

/// What `parse` makes of a file; what is wrong with the file is said with its name.
pub fn read_text<T, E: Display>(path: &Path, parse: impl FnOnce(&str) -> Result<T, E>) -> Result<T, Failure> {
    let unreadable = |e: &dyn Display| Failure::unreadable(format!("{}: {e}", path.display()));
    let text = fs::read_to_string(path).map_err(|e| unreadable(&e))?;
    parse(&text).map_err(|e| unreadable(&e))
}
