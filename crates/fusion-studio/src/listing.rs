//! Meshes and documents below the root.

use crate::root::Root;
use mesh_io::Format;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// How deep folders are looked into, and how many files are listed.
const DEEPEST: usize = 4;
const MOST: usize = 2000;

/// The files that the studio can open.
pub fn files(root: &Root) -> Value {
    let mut found = vec![];
    let mut folders = vec![(root.folder().to_path_buf(), 0)];
    while let Some((folder, depth)) = folders.pop() {
        for (path, about) in entries(&folder) {
            if about.is_dir() && depth < DEEPEST {
                folders.push((path, depth + 1));
            } else if about.is_file() && is_of_use(&path) && found.len() < MOST {
                found.extend(root.relative(&path).map(|relative| (relative, about.len())));
            }
        }
    }
    found.sort();
    found.into_iter().map(|(path, bytes)| json!({ "path": path, "bytes": bytes })).collect()
}

/// What is not hidden; links are passed over.
fn entries(folder: &Path) -> Vec<(PathBuf, fs::Metadata)> {
    let hidden = |name: &str| name.starts_with('.') || ["node_modules", "target"].contains(&name);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let shown = entries.filter(|entry| entry.file_name().to_str().is_some_and(|name| !hidden(name)));
    shown.filter_map(|entry| Some((entry.path(), entry.metadata().ok()?))).collect()
}

fn is_of_use(path: &Path) -> bool {
    Format::from_path(path).is_ok() || path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}
