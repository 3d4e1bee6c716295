//! One document from its file to its outputs, without a session: what the batch door runs.

use crate::evaluation::{CACHE_LIMIT, cache as keep, failure, folder, read, read_text, told, whole};
use crate::failure::Failure;
use crate::output::{Outputs, make_folder};
use crate::session::unwritable;
use fusion::document::{Document, Precisions};
use fusion::mesh_core::Watch;
use mesh_io::{AtomicFiles, Format};
use std::path::{Path, PathBuf};

/// What a job made.
#[derive(Debug)]
pub(crate) struct JobResult {
    /// The files that were written, in the order of the document's outputs.
    #[expect(dead_code, reason = "workers list their folder, side files with it")]
    pub(crate) outputs: Vec<PathBuf>,
    /// The report, as `run --report` writes it.
    pub(crate) report: serde_json::Value,
}

/// Reads a document, sets its parameters, evaluates it, and writes all its outputs or none: into `output_folder`, where only
/// their file names count, or beside the document. The folder is made where there is none. Results are kept in the folder `cache`, and taken from there.
///
/// # Errors
/// [`Failure`] with its exit code.
pub(crate) fn job(
    document: &Path,
    sets: &[(String, String)],
    output_folder: Option<&Path>,
    cache: Option<&Path>,
    watch: &Watch,
) -> Result<JobResult, Failure> {
    finish(&read(document, sets)?, document, output_folder, cache, watch)
}

/// The same for the text of a document, whose paths are relative to the folder of the path by which it is told of.
pub(crate) fn job_of_text(
    text: &str,
    document: &Path,
    sets: &[(String, String)],
    output_folder: Option<&Path>,
    cache: Option<&Path>,
    watch: &Watch,
) -> Result<JobResult, Failure> {
    finish(&read_text(text, document, sets)?, document, output_folder, cache, watch)
}

fn finish(
    read: &Document,
    document: &Path,
    output_folder: Option<&Path>,
    cache: Option<&Path>,
    watch: &Watch,
) -> Result<JobResult, Failure> {
    let outputs = places(read, document, output_folder)?;
    let formats = outputs.iter().map(|path| Format::from_path(path).map_err(Failure::unreadable));
    let formats = formats.collect::<Result<Vec<_>, _>>()?;
    let made = read
        .evaluate(folder(document), &keep(cache, CACHE_LIMIT), Precisions::ByFile, watch)
        .map_err(|e| failure(document, &e))?;
    watch.step("write", 0.0).map_err(|_| Failure::cancelled())?;
    output_folder.map_or(Ok(()), make_folder)?;
    Outputs::default().commit_after(|| {
        let mut staged = AtomicFiles::default();
        for ((path, format), output) in outputs.iter().zip(formats).zip(&made.outputs) {
            mesh_io::stage_as(&output.outcome.model, path, format, &mut staged).map_err(unwritable)?;
        }
        staged.commit().map(drop).map_err(unwritable)
    })?;
    let report = told(&whole(read, document, &made), &made, &outputs);
    Ok(JobResult { outputs, report })
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
