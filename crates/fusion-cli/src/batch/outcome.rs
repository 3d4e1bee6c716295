//! The outcome of a job, as a line of the results.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

/// How a job ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Its outputs are there.
    Done,
    /// It said why not.
    Failed,
    /// Its worker was gone.
    Crashed,
    /// It was ended for the time it took.
    Timeout,
    /// It was ended for the memory it took.
    Memory,
}

impl State {
    /// As in the results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Failed => "failed",
            Self::Crashed => "crashed",
            Self::Timeout => "timeout",
            Self::Memory => "memory",
        }
    }
}

/// A file that a job wrote.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// Its path in the job's folder, with `/` between names.
    pub file: String,
    /// Its size.
    pub bytes: u64,
    /// The BLAKE3 hash of its contents, in hexadecimal digits.
    pub blake3: String,
}

/// One line of the results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The job's id.
    pub id: String,
    /// How it ended.
    pub state: State,
    /// The exit code that `run` would have had; of a crash, 128 and the signal's number, or the worker's own code.
    pub code: i32,
    /// Wall-clock time of the job, without the start of its worker.
    pub milliseconds: f64,
    /// The job's parameters.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub parameters: Map<String, Value>,
    /// Where the outputs are: relative to the results where it lies below them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub folder: Option<String>,
    /// What was written.
    #[serde(default)]
    pub outputs: Vec<Output>,
    /// Everything the job told, as in a report.
    #[serde(default)]
    pub diagnostics: Vec<Value>,
    /// Figures of the report; those of step N are named `N.figure`.
    #[serde(default)]
    pub figures: Map<String, Value>,
    /// The meshes of the document's parts, as seen from where the batch was started.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<String>,
}

impl Outcome {
    /// A job that has no more to tell than one sentence.
    pub fn told(id: &str, state: State, code: i32, milliseconds: f64, diagnostic: Value) -> Self {
        let (parameters, figures) = (Map::new(), Map::new());
        let (folder, outputs, inputs) = (None, vec![], vec![]);
        let diagnostics = vec![diagnostic];
        Self { id: id.into(), state, code, milliseconds, parameters, folder, outputs, diagnostics, figures, inputs }
    }

    /// As a line, with its end.
    pub fn line(&self) -> String {
        // Numbers and texts only: this cannot fail, and an empty object would be noticed.
        serde_json::to_string(self).unwrap_or_else(|_| "{}".into()) + "\n"
    }

    /// Whether it told a warning.
    pub fn has_warnings(&self) -> bool {
        self.diagnostics.iter().any(|d| d["severity"] == "warning")
    }

    /// Why there is no result: the code of the first error, or the state.
    pub fn reason(&self) -> &str {
        let error = self.diagnostics.iter().find(|d| d["severity"] == "error");
        error.and_then(|d| d["code"].as_str()).unwrap_or(self.state.name())
    }

    /// The first error's sentence.
    pub fn sentence(&self) -> &str {
        let error = self.diagnostics.iter().find(|d| d["severity"] == "error");
        error.and_then(|d| d["message"].as_str()).unwrap_or_default()
    }
}

/// An error that no pipeline knows.
pub fn error(code: &str, message: &str, remedy: Option<&str>) -> Value {
    json!({ "code": code, "severity": "error", "message": message, "at": null, "numbers": {}, "remedy": remedy })
}
