//! The inside of a worker: requests on standard input, one line of the results for each on standard output.

use crate::batch::folders::list;
use crate::batch::outcome::{Outcome, State, error};
use crate::evaluation::{folder, read, read_text};
use crate::failure::Failure;
use crate::job::job;
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
            .map_err(|e| Failure::unreadable(format!("a worker was sent a malformed request: {e}")))?;
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
    let sets = request.job.sets();
    let in_line = request.base.join("(document)");
    let (document, path) = match &request.job.document {
        Document::File(path) => {
            let path = request.base.join(path);
            (read(&path, &sets)?, path)
        }
        Document::Text(text) => (read_text(text, &in_line, &sets)?, in_line),
        Document::Object(table) => {
            let text = toml::to_string(table)
                .map_err(|e| Failure::unreadable(format!("the document cannot be written as TOML: {e}")))?;
            (read_text(&text, &in_line, &sets)?, in_line)
        }
    };
    let file = |part: &fusion::document::Part| folder(&path).join(&part.mesh).display().to_string();
    *inputs = document.parts().iter().map(file).collect();
    job(&document, &path, &request.folder, cache, watch)
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
