//! The house rules a compiler does not check: crate arrows, circles of files, file lengths, lints switched on, citations, paths, pages written by the machine.

use crate::{Fault, blender_options, circles, pages, python, root, walk};
use serde_json::Value;
use std::fs;
use std::process::Command;

/// A longer source file is refused.
const MOST_LINES: usize = 500;
/// A longer source file is listed, as a hint to split it.
const MANY_LINES: usize = 400;

/// Where the table of crates stands.
const TABLE: &str = "docs/architecture.md";

/// Runs every check and lists all that is wrong.
pub fn run() -> Result<(), Fault> {
    let mut faults = arrows()?;
    faults.extend(circles::faults()?);
    let mut sources = vec![];
    for folder in ["crates", "xtask", "docs", "fixtures", ".github", ".ci"] {
        walk(&root().join(folder), &mut sources);
    }
    sources.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "Cargo.toml"].map(|f| root().join(f)));
    let bibliography = fs::read_to_string(root().join("docs/bibliography.md")).unwrap_or_default();
    for path in sources {
        // Binary fixtures and files that are not there yet have nothing to check.
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let name = path.strip_prefix(root()).unwrap_or(&path).display().to_string();
        let kind = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        if kind == "rs" {
            lengths(&name, &text, &mut faults);
            documented(&name, &text, &mut faults);
        }
        if matches!(kind, "rs" | "md" | "toml" | "yml" | "py") {
            machine_paths(&name, &text, &mut faults);
        }
        if matches!(kind, "rs" | "md") {
            citations(&name, &text, &bibliography, &mut faults);
        }
        if kind == "toml" && name.ends_with("/Cargo.toml") && !text.contains("[lints]\nworkspace = true") {
            faults.push(format!("{name}: does not inherit the workspace's lints"));
        }
    }
    if !pages::DOCUMENTS.holds(&fusion::document::reference())? {
        faults
            .push(format!("{}: its keys are not those of the code; run cargo xtask reference", pages::DOCUMENTS.page));
    }
    for generated in [python::FUNCTIONS, blender_options::OPTIONS] {
        if !generated.is_current()? {
            faults.push(format!("{}: out of date; run cargo xtask {}", generated.file, generated.chore));
        }
    }
    for fault in &faults {
        println!("tidy: {fault}");
    }
    if faults.is_empty() {
        println!("tidy: all in order");
        Ok(())
    } else {
        Err(format!("tidy found {} faults", faults.len()).into())
    }
}

/// Every dependency that is not in the table.
fn arrows() -> Result<Vec<String>, Fault> {
    let page = fs::read_to_string(root().join(TABLE))?;
    let table = Table::of(&page);
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .current_dir(root())
        .output()?;
    let metadata: Value = serde_json::from_slice(&output.stdout)?;
    let packages = || metadata["packages"].as_array().into_iter().flatten();
    let mut faults = vec![];
    for package in packages() {
        let name = package["name"].as_str().unwrap_or_default();
        let dependencies = package["dependencies"].as_array().into_iter().flatten();
        let on = dependencies.map(|d| (d["name"].as_str().unwrap_or_default(), d["kind"] == "dev"));
        faults.extend(table.faults(name, on));
    }
    Ok(faults)
}

/// The table of crates: what each may stand on.
struct Table<'a> {
    rows: Vec<(&'a str, Vec<&'a str>)>,
    /// Open to every crate, and to the tests and benchmarks of every crate.
    open: [Vec<&'a str>; 2],
}

impl<'a> Table<'a> {
    /// Reads the rows that begin with a crate's name, and the two sentences about what is open to all.
    fn of(page: &'a str) -> Self {
        let names = |text: &'a str| text.split('`').skip(1).step_by(2).collect::<Vec<_>>();
        let row = |line: &'a str| {
            let mut cells = line.strip_prefix("| `")?.split('|');
            Some((cells.next()?.trim().trim_end_matches('`'), names(cells.next()?)))
        };
        let after = |opening| page.lines().find_map(|line| line.strip_prefix(opening)).map(names).unwrap_or_default();
        Self {
            rows: page.lines().filter_map(row).collect(),
            open: ["Open to every crate:", "Open to tests and benchmarks:"].map(after),
        }
    }

    /// What a crate stands on, for tests or always, that its row does not name.
    fn faults<'d>(&self, name: &str, on: impl Iterator<Item = (&'d str, bool)>) -> Vec<String> {
        let Some((_, allowed)) = self.rows.iter().find(|(n, _)| *n == name) else {
            return vec![format!("{name}: is not in the table of {TABLE}")];
        };
        let listed = |other: &str, for_tests: bool| {
            allowed.contains(&other) || self.open[0].contains(&other) || for_tests && self.open[1].contains(&other)
        };
        let unlisted = on.filter(|&(other, for_tests)| !listed(other, for_tests));
        unlisted.map(|(other, _)| format!("{name} -> {other}: this arrow is not in the table of {TABLE}")).collect()
    }
}

fn lengths(name: &str, text: &str, faults: &mut Vec<String>) {
    let lines = text.lines().count();
    if lines > MOST_LINES {
        faults.push(format!("{name}: {lines} lines, at most {MOST_LINES} are allowed"));
    } else if lines > MANY_LINES {
        println!("tidy: note: {name}: {lines} lines; consider splitting it");
    }
}

/// The lint that asks for documentation must not be switched off, and a crate's front page must show it working.
fn documented(name: &str, text: &str, faults: &mut Vec<String>) {
    if text.contains(concat!("allow(", "missing_docs")) {
        faults.push(format!("{name}: switches off the lint that asks for documentation"));
    }
    if name.starts_with("crates/") && name.ends_with("src/lib.rs") && !text.contains("//! ```") {
        faults.push(format!("{name}: the front page has no example"));
    }
}

/// Paths that exist on one machine only.
fn machine_paths(name: &str, text: &str, faults: &mut Vec<String>) {
    let patterns = [["/ho", "me/"], ["/ro", "ot/"], ["/Use", "rs/"], ["/wo", "rk/"], ["/tm", "p/"], ["C:", "\\\\"]];
    for (i, line) in text.lines().enumerate() {
        if patterns.iter().any(|p| line.contains(&p.concat())) {
            faults.push(format!("{name}:{}: names a path of one machine", i + 1));
        }
    }
}

/// Every key such as `[Liu2005]` must be an entry of the bibliography.
fn citations(name: &str, text: &str, bibliography: &str, faults: &mut Vec<String>) {
    for (i, line) in text.lines().enumerate() {
        for key in
            line.split('[').skip(1).filter_map(|rest| rest.split_once(']')).map(|(key, _)| key.trim_end_matches('\\'))
        {
            let letters = key.trim_end_matches(|c: char| c.is_ascii_digit());
            let is_key = key.len() == letters.len() + 4
                && letters.starts_with(|c: char| c.is_ascii_uppercase())
                && letters.chars().all(|c| c.is_ascii_alphabetic());
            if is_key && !bibliography.contains(&format!("[{key}]")) {
                faults.push(format!("{name}:{}: [{key}] is not in docs/bibliography.md", i + 1));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_that_the_page_does_not_list_is_a_fault() {
        let page = "Open to every crate: `glam`.\nOpen to tests and benchmarks: `proptest`.\n| `a` | | x |\n| `b` | `a`; `zip` | x |\n";
        let table = Table::of(page);
        assert!(
            table
                .faults("b", [("a", false), ("zip", false), ("glam", false), ("proptest", true)].into_iter())
                .is_empty()
        );
        assert_eq!(table.faults("a", [("b", false), ("proptest", false)].into_iter()).len(), 2);
        assert_eq!(table.faults("c", std::iter::empty()).len(), 1);
    }

    #[test]
    fn the_page_lists_every_crate() {
        let page = fs::read_to_string(root().join(TABLE)).unwrap();
        let table = Table::of(&page);
        assert!(table.rows.iter().any(|(name, on)| *name == "rolling-blend" && on.contains(&"spine")));
        assert!(table.open.iter().all(|open| !open.is_empty()));
    }
}
