//! Documents from their files, and what there is to tell about them.

use crate::failure::Failure;
use fusion::document::{Cache, Evaluation};
use fusion::{Code, Counts, Diagnostic, Document, Error, Report, Severity};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Gigabytes of a folder of results where nothing else is said.
pub const CACHE_LIMIT: f64 = 10.0;

/// Reads a document and gives values to its parameters and options.
pub fn read(path: &Path, sets: &[(String, String)]) -> Result<Document, Failure> {
    let name = path.display();
    let text =
        fs::read_to_string(path).map_err(|e| Failure::unreadable(format!("cannot read the document {name}: {e}")))?;
    read_text(&text, path, sets)
}

/// The same for a text that stands for what could be the file at a path.
pub fn read_text(text: &str, path: &Path, sets: &[(String, String)]) -> Result<Document, Failure> {
    let name = path.display();
    let mut document = Document::parse(text).map_err(|e| Failure::unreadable(format!("{name}: {e}")))?;
    for (parameter, value) in sets {
        document.set(parameter, value).map_err(|e| Failure::unreadable(format!("{name}, --set {parameter}: {e}")))?;
    }
    Ok(document)
}

/// What a document's paths are relative to.
pub fn folder(document: &Path) -> &Path {
    document.parent().unwrap_or(Path::new(""))
}

/// Where results are kept: in memory, and in a folder of at most so many gigabytes.
pub fn cache(folder: Option<&Path>, gigabytes: f64) -> Cache {
    let cache = Cache::default();
    match folder {
        Some(folder) => cache.with_folder(folder, (gigabytes * 1e9) as u64),
        None => cache,
    }
}

/// What a document asks for in vain is its own fault; the rest is that of the operation.
pub fn failure(document: &Path, error: &Error) -> Failure {
    match error {
        Error::Document(e) => Failure::unreadable(format!("{}: {e}", document.display())),
        _ => Failure::of(error, format!("{}: {error}", document.display())),
    }
}

/// One account of all: that of the first output, with the warnings of every step and of parameters that nothing refers to.
pub fn whole(document: &Document, path: &Path, evaluation: &Evaluation) -> Report {
    let mut report = evaluation.outputs.first().map(|o| o.outcome.report.clone()).unwrap_or_default();
    for (counts, part) in report.inputs.iter_mut().zip(document.parts()) {
        counts.name = folder(path).join(&part.mesh).display().to_string();
    }
    if evaluation.outputs.len() > 1 {
        let steps = || evaluation.steps.iter().map(|step| &step.report);
        report.warnings = steps().flat_map(|r| r.warnings.clone()).collect();
        report.notes = steps().flat_map(|r| r.notes.clone()).collect();
        report.diagnostics = steps().flat_map(|r| r.diagnostics.clone()).collect();
        let of_outputs = evaluation.outputs.iter().flat_map(|o| &o.outcome.report.diagnostics);
        of_outputs.filter(|d| d.code == Code::Inherited).for_each(|d| report.tell(d.clone()));
    }
    for name in document.unused_parameters() {
        let told = format!("{}: nothing refers to the parameter `{name}`", path.display());
        let told = Diagnostic::new(Code::Other, Severity::Warning, told);
        report.tell(told.remedy(format!("write \"${name}\" where its value is wanted, or remove it")));
    }
    report
}

/// The report as JSON: that of the whole, `steps` and `outputs`, one report each.
pub fn told(whole: &Report, evaluation: &Evaluation, places: &[PathBuf]) -> Value {
    let mut report = json!(whole);
    let step = |step: &fusion::document::Taken| {
        let mut told = json!(step.report);
        told["step"] = step.number.into();
        told["name"] = step.name.clone().into();
        told["known"] = step.is_known.into();
        told
    };
    let output = |(output, place): (&fusion::document::Evaluated, &PathBuf)| {
        let name = place.display().to_string();
        let made = Counts { name: name.clone(), ..output.outcome.report.output.clone() };
        let mut told = json!(Report { output: made, ..output.outcome.report.clone() });
        told["of"] = output.of.clone().into();
        told["file"] = name.into();
        told
    };
    report["steps"] = evaluation.steps.iter().map(step).collect();
    report["outputs"] = evaluation.outputs.iter().zip(places).map(output).collect();
    report
}
