//! The inside of a worker: requests on standard input, one line of the results for each on standard output.

use crate::batch::folders::list;
use crate::batch::outcome::{Outcome, State, error};
use crate::failure::Failure;
use crate::job::{job, job_of_text};
use crate::job_line::{Document, Job};
use fusion::mesh_core::Watch;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Instant;

/// One job for a worker.
#[derive(Debug, Serialize, Deserialize)]
pub struct Request {
    /// The line of the jobs file.
    pub job: Job,
    /// What its paths are relative to.
    pub base: PathBuf,
    /// An empty folder for its outputs.
    pub folder: PathBuf,
}

/// Answers requests until standard input ends. Whoever closes it wants no answer any more: a job under way is given up, so that no
/// worker outlives a batch that was killed.
pub fn serve(cache: Option<&Path>, watch: &Watch) -> Result<(), Failure> {
    let (sender, requests) = mpsc::channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
        std::process::exit(0);
    });
    for line in requests {
        let request: Request = serde_json::from_str(&line)
            .map_err(|e| Failure::unreadable(format!("a worker was sent what is no request: {e}")))?;
        let outcome = answer(&request, cache, watch);
        let mut out = std::io::stdout().lock();
        let told = out.write_all(outcome.line().as_bytes()).and_then(|()| out.flush());
        told.map_err(|e| Failure::unwritable(format!("cannot answer: {e}")))?;
    }
    Ok(())
}

/// Does one job.
fn answer(request: &Request, cache: Option<&Path>, watch: &Watch) -> Outcome {
    let start = Instant::now();
    let mut inputs = vec![];
    let result = evaluate(request, cache, watch, &mut inputs);
    let outputs = if result.is_ok() { list(&request.folder) } else { Ok(vec![]) };
    let milliseconds = start.elapsed().as_micros() as f64 / 1e3;
    let job = &request.job;
    let told = |code, diagnostic| Outcome::told(&job.id, State::Failed, code, milliseconds, diagnostic);
    let outcome = match (result, outputs) {
        (Ok(report), Ok(outputs)) => Outcome {
            state: State::Done,
            outputs,
            diagnostics: diagnostics(&report),
            figures: figures(&report),
            ..told(0, Value::Null)
        },
        (Ok(_), Err(e)) => told(6, error("unwritable", &format!("cannot read the outputs again: {e}"), None)),
        (Err(failure), _) => {
            let report = failure.to_report("run", vec![]).and_then(|r| serde_json::to_value(&r).ok());
            let first = error(code_name(failure.code()), &failure.to_string(), None);
            let told = told(failure.code().into(), first);
            match report.as_ref().map(diagnostics) {
                Some(diagnostics) if !diagnostics.is_empty() => Outcome { diagnostics, ..told },
                _ => told,
            }
        }
    };
    Outcome { parameters: job.parameters.clone(), inputs, ..outcome }
}

fn code_name(code: u8) -> &'static str {
    match code {
        2 => "usage",
        3 => "unreadable",
        6 => "unwritable",
        130 => "cancelled",
        _ => "impossible",
    }
}

/// Evaluates the document, and gives its report; `inputs` gets the parts' files.
fn evaluate(
    request: &Request,
    cache: Option<&Path>,
    watch: &Watch,
    inputs: &mut Vec<String>,
) -> Result<Value, Failure> {
    let (sets, folder) = (request.job.sets(), Some(request.folder.as_path()));
    let text = match &request.job.document {
        Document::File(path) => {
            let path = request.base.join(path);
            if let Ok(text) = std::fs::read_to_string(&path) {
                *inputs = parts(&text, path.parent().unwrap_or(Path::new("")));
            }
            return job(&path, &sets, folder, cache, watch).map(|result| result.report);
        }
        Document::Text(text) => text.clone(),
        Document::Object(table) => {
            toml::to_string(table).map_err(|e| Failure::unreadable(format!("the document is no table: {e}")))?
        }
    };
    *inputs = parts(&text, &request.base);
    job_of_text(&text, &request.base.join("(document)"), &sets, folder, cache, watch).map(|result| result.report)
}

/// The meshes that a document names as its parts.
fn parts(text: &str, folder: &Path) -> Vec<String> {
    let Ok(table) = text.parse::<toml::Table>() else { return vec![] };
    let parts = table.get("part").and_then(toml::Value::as_array).into_iter().flatten();
    parts.filter_map(|p| p.get("mesh")?.as_str()).map(|mesh| folder.join(mesh).display().to_string()).collect()
}

/// What the report of a document tells.
fn diagnostics(report: &Value) -> Vec<Value> {
    report["diagnostics"].as_array().cloned().unwrap_or_default()
}

/// Those of the report, and those of its steps by their numbers.
fn figures(report: &Value) -> Map<String, Value> {
    let mut figures = report["figures"].as_object().cloned().unwrap_or_default();
    for (i, step) in report["steps"].as_array().into_iter().flatten().enumerate() {
        let number = step["step"].as_u64().unwrap_or(i as u64 + 1);
        let of_step = step["figures"].as_object().into_iter().flatten();
        figures.extend(of_step.map(|(name, value)| (format!("{number}.{name}"), value.clone())));
    }
    figures
}
