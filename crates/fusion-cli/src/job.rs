//! One document as a job.

use crate::failure::Failure;
use fusion::mesh_core::{TriMesh, Watch};
use fusion::operation::Files;
use fusion::{Counts, Error, Recipe};
use mesh_io::Format;
use std::fs;
use std::path::{Path, PathBuf};

/// What a job has made.
pub(crate) struct JobResult {
    /// The files it wrote.
    #[expect(dead_code, reason = "workers list the folder")]
    pub outputs: Vec<PathBuf>,
    /// Its report.
    pub report: serde_json::Value,
}

/// Replays a document.
pub(crate) fn job(
    document: &Path,
    _sets: &[(String, String)],
    output_folder: Option<&Path>,
    _cache: Option<&Path>,
    watch: &Watch,
) -> Result<JobResult, Failure> {
    let name = document.display();
    let text =
        fs::read_to_string(document).map_err(|e| Failure::unreadable(format!("cannot read the recipe {name}: {e}")))?;
    let malformed = |e: &fusion::recipe::Error| Failure::unreadable(format!("{name}: {e}"));
    let mut recipe = Recipe::parse(&text).map_err(|e| malformed(&e))?;
    let folder = document.parent().unwrap_or(Path::new(""));
    recipe.load(&mut Beside(folder)).map_err(|e| malformed(&e))?;
    let output = match output_folder {
        Some(to) => to.join(recipe.output.file_name().unwrap_or(recipe.output.as_os_str())),
        None => folder.join(&recipe.output),
    };
    let format = Format::from_path(&output).map_err(Failure::usage)?;
    let paths: Vec<PathBuf> = recipe.parts.iter().map(|p| folder.join(&p.mesh)).collect();
    let models = paths.iter().map(|p| mesh_io::read(p)).collect::<Result<Vec<_>, _>>().map_err(Failure::unreadable)?;
    let mut outcome = recipe.run(&models, format, watch).map_err(|error| match &error {
        Error::Recipe(e) => malformed(e),
        _ => Failure::of(&error, error.to_string()),
    })?;
    outcome.report.inputs =
        paths.iter().zip(&models).map(|(p, m)| Counts::of(p.display().to_string(), &m.mesh)).collect();
    mesh_io::write_as(&outcome.model, &output, format).map_err(Failure::unwritable)?;
    let report = serde_json::to_value(&outcome.report).map_err(Failure::impossible)?;
    Ok(JobResult { outputs: vec![output], report })
}

struct Beside<'a>(&'a Path);

impl Files for Beside<'_> {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        fs::read_to_string(self.0.join(path)).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        mesh_io::read(&self.0.join(path)).map(|model| model.mesh).map_err(|e| e.to_string())
    }
}
