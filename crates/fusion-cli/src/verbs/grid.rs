//! `grid`: a line of a jobs file for each combination of parameters.

use crate::failure::Failure;
use crate::job_line::{Document, Job};
use crate::output::check_writable;
use crate::session::Session;
use crate::text_file::read_text;
use clap::Args;
use fusion::{Code, Diagnostic, Report, Severity};
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// Most lines that are written.
const MOST: usize = 10_000_000;

/// Arguments of `grid`.
#[derive(Args)]
pub struct GridArgs {
    /// The document
    #[arg(value_name = "DOCUMENT.toml")]
    pub document: PathBuf,
    /// A parameter, or `N.option` of step N, and its values
    #[arg(long = "set", value_name = "NAME=V,V…", required = true, value_parser = axis)]
    pub sets: Vec<Axis>,
    /// Write the jobs here
    #[arg(short, long, value_name = "JOBS.jsonl")]
    pub output: PathBuf,
}

/// One parameter and its values, as typed.
#[derive(Clone, Debug)]
pub struct Axis {
    name: String,
    values: Vec<String>,
}

/// Writes all combinations, the last parameter changing fastest.
pub fn run(session: &Session, args: &GridArgs) -> Result<(), Failure> {
    check_writable(&args.output)?;
    let table = read_text(&args.document, |text| text.parse::<toml::Table>().map_err(|e| e.message().to_string()))?;
    let mut report = Report::new("grid", vec![]);
    for (i, axis) in args.sets.iter().enumerate() {
        if args.sets[..i].iter().any(|before| before.name == axis.name) {
            return Err(Failure::usage(format!("--set {} is there twice: give all its values at once", axis.name)));
        }
        if !is_used(&axis.name, &table) {
            let said = format!("{} has no use for the parameter `{}`", args.document.display(), axis.name);
            let remedy =
                format!("write \"${0}\" where its value belongs, or N.option for an option of step N", axis.name);
            report.tell(Diagnostic::new(Code::Other, Severity::Warning, said).remedy(remedy));
        }
    }
    let count = args.sets.iter().try_fold(1_usize, |n, axis| n.checked_mul(axis.values.len())).filter(|n| *n <= MOST);
    let count = count.ok_or_else(|| Failure::usage(format!("that is more than {MOST} combinations")))?;
    let document = seen_from(&args.document, args.output.parent().unwrap_or(Path::new("")));
    let stem = args.document.file_stem().unwrap_or_default().to_string_lossy();
    let mut lines = String::new();
    for place in 0..count {
        let chosen = choose(&args.sets, place);
        let id = chosen.iter().fold(stem.to_string(), |id, (name, value)| format!("{id},{name}={value}"));
        let parameters: Map<String, Value> = chosen.iter().map(|(name, v)| (name.to_string(), typed(v))).collect();
        let job = Job { id, document: Document::File(document.clone()), parameters };
        lines += &(serde_json::to_string(&job).map_err(Failure::impossible)? + "\n");
    }
    // What is written must be readable: values may make an id too long.
    crate::job_line::parse(lines.as_bytes())
        .map_err(|faults| Failure::impossible(format!("line {}: {}", faults[0].line, faults[0].reason)))?;
    report.figures.insert("jobs".into(), count as f64);
    session.write_files(vec![(args.output.clone(), lines.into_bytes())], &report)
}

/// `NAME=V,V…`; commas within brackets or quotes belong to a value.
fn axis(text: &str) -> Result<Axis, String> {
    let (name, values) = text.split_once('=').ok_or("must be NAME=V,V…")?;
    let (mut parts, mut depth, mut quoted) = (vec![String::new()], 0_usize, false);
    for c in values.chars() {
        match c {
            '"' => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        match parts.last_mut() {
            Some(part) if c != ',' || quoted || depth > 0 => part.push(c),
            _ => parts.push(String::new()),
        }
    }
    let values: Vec<String> = parts.iter().map(|part| part.trim().to_string()).collect();
    let name = name.trim().to_string();
    if name.is_empty() || values.iter().any(String::is_empty) {
        return Err("must be NAME=V,V… without empty values".into());
    }
    match (1..values.len()).find(|i| values[..*i].contains(&values[*i])) {
        Some(i) => Err(format!("the value {} is there twice", values[i])),
        None => Ok(Axis { name, values }),
    }
}

/// The values of the combination at a place.
fn choose(axes: &[Axis], mut place: usize) -> Vec<(&str, &str)> {
    let mut chosen = vec![];
    for axis in axes.iter().rev() {
        chosen.push((axis.name.as_str(), axis.values[place % axis.values.len()].as_str()));
        place /= axis.values.len();
    }
    chosen.reverse();
    chosen
}

/// Numbers, lists, true and false as such; everything else is text.
fn typed(value: &str) -> Value {
    match serde_json::from_str(value) {
        Ok(value @ (Value::Number(_) | Value::Bool(_) | Value::Array(_) | Value::String(_))) => value,
        _ => value.into(),
    }
}

/// Whether a document refers to a parameter, or has the step that an option is for.
fn is_used(name: &str, table: &toml::Table) -> bool {
    if let Some((step, option)) = name.split_once('.').and_then(|(n, option)| Some((n.parse::<usize>().ok()?, option)))
    {
        let steps = table.get("step").and_then(toml::Value::as_array).map_or(0, Vec::len);
        return (1..=steps).contains(&step) && !option.is_empty();
    }
    let reference = format!("${name}");
    table.iter().any(|(key, value)| key != "parameters" && refers(value, &reference))
}

fn refers(value: &toml::Value, reference: &str) -> bool {
    match value {
        toml::Value::String(text) => text == reference,
        toml::Value::Array(values) => values.iter().any(|v| refers(v, reference)),
        toml::Value::Table(table) => table.iter().any(|(_, v)| refers(v, reference)),
        _ => false,
    }
}

/// A path as seen from a folder: below it, else from the root.
fn seen_from(path: &Path, folder: &Path) -> PathBuf {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    match (std::fs::canonicalize(path), std::fs::canonicalize(folder)) {
        (Ok(path), Ok(folder)) => path.strip_prefix(&folder).map_or(path.clone(), Path::to_path_buf),
        _ => path.to_path_buf(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_split_outside_of_brackets_and_quotes() {
        let values = |text| axis(text).map(|a| a.values);
        assert_eq!(values("r=1, 2%,3").unwrap(), ["1", "2%", "3"]);
        assert_eq!(values("v=[0,0,1],[1,0,0]").unwrap(), ["[0,0,1]", "[1,0,0]"]);
        assert_eq!(values(r#"s="a,b",c"#).unwrap(), [r#""a,b""#, "c"]);
        assert!(["r", "=1", "r=", "r=1,,2", "r=1,1"].iter().all(|text| axis(text).is_err()));
    }

    #[test]
    fn every_combination_comes_once_and_the_last_parameter_changes_fastest() {
        let axes = ["a=1,2", "b=x,y,z"].map(|text| axis(text).unwrap());
        let all: Vec<String> = (0..6).map(|i| choose(&axes, i).iter().map(|c| c.1).collect()).collect();
        assert_eq!(all, ["1x", "1y", "1z", "2x", "2y", "2z"]);
    }

    #[test]
    fn parameters_are_used_where_a_value_refers_to_them() {
        let table = "[parameters]\nsoft = 1\nlost = \"$lost\"\n[[step]]\ndo = \"blend\"\nradius = [\"$soft\", 2]\n";
        let table = table.parse::<toml::Table>().unwrap();
        let used = ["soft", "lost", "1.profile", "2.profile", "0.profile", "1."].map(|name| is_used(name, &table));
        assert_eq!(used, [true, false, true, false, false, false]);
    }
}
