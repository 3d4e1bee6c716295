//! Lines of a jobs file: one JSON object each, one document to replay.
//!
//! ```
//! use fusion_cli::job_line::{Document, parse_line};
//!
//! let job = parse_line(r#"{"id": "bolt", "document": "bolt.toml", "parameters": {"soft": "2%"}}"#)?;
//! assert_eq!(job.id, "bolt");
//! assert_eq!(job.document, Document::File("bolt.toml".into()));
//! assert!(parse_line(r#"{"id": "bolt"}"#).unwrap_err().contains("document"));
//! # Ok::<(), String>(())
//! ```

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Longest id, in bytes: it becomes a folder's name.
const LONGEST_ID: usize = 150;

/// One line of a jobs file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Job {
    /// Tells the job from all others of the file; a number stands for its digits.
    #[serde(deserialize_with = "id")]
    pub id: String,
    /// What to replay.
    pub document: Document,
    /// Values in place of the document's own: parameters by name, options as `N.option`.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub parameters: Map<String, Value>,
}

impl Job {
    /// The parameters as they are typed after `--set`.
    pub fn sets(&self) -> Vec<(String, String)> {
        let typed = |value: &Value| value.as_str().map_or_else(|| value.to_string(), Into::into);
        self.parameters.iter().map(|(name, value)| (name.clone(), typed(value))).collect()
    }
}

/// A document, or where it is. Paths, also those in a document that stands in the line, are relative to the jobs file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Document {
    /// A document as JSON.
    Object(Map<String, Value>),
    /// A file, or the text of a document.
    #[serde(deserialize_with = "text_with_lines")]
    Text(String),
    /// A file: a string without a line break.
    File(PathBuf),
}

/// A text with a line break: no path has one, and no document does without.
fn text_with_lines<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let text = String::deserialize(deserializer)?;
    if text.contains('\n') { Ok(text) } else { Err(serde::de::Error::custom("is a path")) }
}

fn id<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    match Value::deserialize(deserializer)? {
        Value::String(id) => Ok(id),
        Value::Number(number) => Ok(number.to_string()),
        _ => Err(serde::de::Error::custom("`id` must be a string or a number")),
    }
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The line's number, from 1.
    pub line: usize,
    /// Why it cannot be used.
    pub reason: String,
}

/// Reads one line.
///
/// # Errors
/// What is wrong with it, and where.
pub fn parse_line(line: &str) -> Result<Job, String> {
    let job: Job = serde_json::from_str(line).map_err(|e| {
        let said = e.to_string();
        let reason = said.split(" at line ").next().unwrap_or(&said);
        let reason =
            if reason.contains("untagged") { "`document` must be a path, a text or an object" } else { reason };
        format!("{reason} (column {})", e.column())
    })?;
    if job.id.trim().is_empty() || job.id.len() > LONGEST_ID || job.id.chars().any(char::is_control) {
        return Err(format!("`id` must have 1 to {LONGEST_ID} bytes, and no control characters"));
    }
    if job.document == Document::File(PathBuf::new()) {
        return Err("`document` is empty".into());
    }
    let plain = |value: &Value| !matches!(value, Value::Null | Value::Object(_));
    match job.parameters.iter().find(|(_, value)| !plain(value)) {
        Some((name, _)) => Err(format!("parameter `{name}` must be a number, a string, true, false or a list")),
        None => Ok(job),
    }
}

/// Reads all lines of a jobs file; empty ones do not count.
///
/// # Errors
/// Every line that cannot be used, in order. An id that was there before is such a line.
pub fn parse(bytes: &[u8]) -> Result<Vec<Job>, Vec<Fault>> {
    let (mut jobs, mut faults, mut lines) = (vec![], vec![], BTreeMap::new());
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    for (i, line) in bytes.split(|b| *b == b'\n').enumerate() {
        if line.trim_ascii().is_empty() {
            continue;
        }
        let line = std::str::from_utf8(line).map_err(|e| format!("is not UTF-8 (byte {})", e.valid_up_to() + 1));
        let job = line.and_then(parse_line).and_then(|job| match lines.insert(job.id.clone(), i + 1) {
            Some(before) => Err(format!("the id `{}` is taken by line {before}", job.id)),
            None => Ok(job),
        });
        match job {
            Ok(job) => jobs.push(job),
            Err(reason) => faults.push(Fault { line: i + 1, reason }),
        }
    }
    if faults.is_empty() { Ok(jobs) } else { Err(faults) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_files_texts_or_objects() {
        for (json, expected) in [
            (r#""a/b.toml""#, Document::File("a/b.toml".into())),
            (r#""version = 2\n""#, Document::Text("version = 2\n".into())),
            (r#"{"version": 2}"#, Document::Object(Map::from_iter([("version".into(), 2.into())]))),
        ] {
            let job = parse_line(&format!(r#"{{"id": 7, "document": {json}}}"#)).unwrap();
            assert_eq!((job.id.as_str(), &job.document), ("7", &expected));
            assert_eq!(parse_line(&serde_json::to_string(&job).unwrap()).unwrap(), job);
        }
    }

    #[test]
    fn parameters_are_typed_as_after_set() {
        let line =
            r#"{"id": "a", "document": "a.toml", "parameters": {"r": "2%", "n": 3, "off": true, "v": [1, 2.5]}}"#;
        let sets = parse_line(line).unwrap().sets();
        let expected = [("n", "3"), ("off", "true"), ("r", "2%"), ("v", "[1,2.5]")];
        assert_eq!(sets, expected.map(|(name, value)| (name.into(), value.into())));
    }

    #[test]
    fn faults_have_a_line_and_a_reason() {
        let text =
            b"{\"id\": \"a\", \"document\": \"a.toml\"}\n\n{\"id\": \"b\"}\nno\n{\"id\": \"a\", \"document\": \"x\"}\n\
            {\"id\": \"c\", \"document\": 3}\n{\"id\": \"d\", \"document\": \"x\", \"parametres\": {}}\n\xff\n\
            {\"id\": \"\", \"document\": \"x\"}\n{\"id\": \"e\", \"document\": \"x\", \"parameters\": {\"r\": null}}\n";
        let faults = parse(text).unwrap_err();
        let words = ["document", "column 2", "line 1", "path, a text or an object", "parametres", "UTF-8", "id", "`r`"];
        assert_eq!(faults.iter().map(|f| f.line).collect::<Vec<_>>(), [3, 4, 5, 6, 7, 8, 9, 10]);
        for (fault, word) in faults.iter().zip(words) {
            assert!(fault.reason.contains(word), "{fault:?} lacks {word}");
        }
    }
    /// The fuzz target of the same name, on few inputs.
    #[test]
    fn broken_lines_are_jobs_or_faults_of_lines_that_are_there() {
        let text = "{\"id\": 7, \"document\": \"a\\nb\", \"parameters\": {\"r\": [1, \"2%\"]}}\n\n{\"id\": \"\u{e4}\", \"document\": {\"version\": 2}}";
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        let (mut read, mut refused) = (0, 0);
        for _ in 0..20_000 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=random(3) {
                let (place, with) = (random(bytes.len()), b"{}[]\":,\\\n0e-\xff a"[random(15)]);
                bytes[place] = with;
            }
            match parse(&bytes) {
                Ok(jobs) => {
                    read += 1;
                    let lines: String = jobs.iter().map(|job| serde_json::to_string(job).unwrap() + "\n").collect();
                    assert_eq!(parse(lines.as_bytes()).unwrap(), jobs);
                }
                Err(faults) => {
                    refused += 1;
                    let count = bytes.split(|b| *b == b'\n').count();
                    assert!(faults.iter().all(|f| (1..=count).contains(&f.line) && !f.reason.is_empty()));
                }
            }
        }
        assert!(read > 500 && refused > 500, "{read} {refused}");
    }
}
