//! One document from its file to its outputs, without a session: what the batch door runs.

use crate::failure::Failure;
use fusion::mesh_core::Watch;
use std::path::{Path, PathBuf};

/// What a job made.
#[derive(Debug)]
pub(crate) struct JobResult {
    /// The files that were written, in the order of the document's outputs.
    pub(crate) outputs: Vec<PathBuf>,
    /// The report, as `run --report` writes it.
    pub(crate) report: serde_json::Value,
}

/// Reads a document, sets its parameters, evaluates it, and writes all its outputs or none: into `output_folder`, where only
/// their file names count, or beside the document. Results are kept in the folder `cache`, and taken from there.
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
    let _ = (sets, output_folder, cache, watch);
    Err(Failure::impossible(format!("{}: documents cannot be run yet", document.display())))
}
