//! One document to its outputs, without a session: what the batch door runs.

use crate::evaluation::{CACHE_LIMIT, cache as keep, failure, folder, told, whole};
use crate::failure::Failure;
use crate::output::{Outputs, make_folder};
use crate::session::unwritable;
use fusion::document::{Document, Precisions};
use fusion::mesh_core::Watch;
use mesh_io::{AtomicFiles, Format};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Evaluates a document that stands at `path`, or could, and writes all its outputs or none: into `output_folder`, where only
/// their file names count. The folder is made where there is none. Results are kept in the folder `cache`, and taken from there.
/// Gives the report, as `run --report` writes it.
///
/// # Errors
/// [`Failure`] with its exit code.
pub(crate) fn job(
    document: &Document,
    path: &Path,
    output_folder: &Path,
    cache: Option<&Path>,
    watch: &Watch,
) -> Result<Value, Failure> {
    let outputs = places(document, path, Some(output_folder))?;
    let formats = outputs.iter().map(|path| Format::from_path(path).map_err(Failure::unreadable));
    let formats = formats.collect::<Result<Vec<_>, _>>()?;
    let made = document
        .evaluate(folder(path), &keep(cache, CACHE_LIMIT), Precisions::ByFile, watch)
        .map_err(|e| failure(path, &e))?;
    watch.step("write", 0.0).map_err(|_| Failure::cancelled())?;
    make_folder(output_folder)?;
    Outputs::default().commit_after(|| {
        let mut staged = AtomicFiles::default();
        for ((path, format), output) in outputs.iter().zip(formats).zip(&made.outputs) {
            mesh_io::stage_as(&output.outcome.model, path, format, &mut staged).map_err(unwritable)?;
        }
        staged.commit().map(drop).map_err(unwritable)
    })?;
    Ok(told(&whole(document, path, &made), &made, &outputs))
}

/// Where a document's outputs go: as it says, or into a folder by their file names. No two may go to the same place.
pub(crate) fn places(document: &Document, path: &Path, into: Option<&Path>) -> Result<Vec<PathBuf>, Failure> {
    let place = |file: &Path| match into {
        Some(into) => into.join(file.file_name().unwrap_or(file.as_os_str())),
        None => folder(path).join(file),
    };
    let all: Vec<PathBuf> = document.outputs().iter().map(|output| place(&output.file)).collect();
    if all.is_empty() {
        return Err(Failure::unreadable(format!("{}: there is no [[output]], so nothing to write", path.display())));
    }
    match (1..all.len()).find(|&i| all[..i].contains(&all[i])) {
        Some(i) => {
            let file = all[i].display();
            Err(Failure::unreadable(format!("{}: two outputs go to {file}; give them different names", path.display())))
        }
        None => Ok(all),
    }
}
