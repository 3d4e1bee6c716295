//! The house rules a compiler does not check: crate arrows, file lengths, lints switched on, citations, paths, pages written by the machine.

use crate::{Fault, pages, root, walk};
use serde_json::Value;
use std::fs;
use std::process::Command;

/// A longer source file is refused.
const MOST_LINES: usize = 500;
/// A longer source file is listed, as a hint to split it.
const MANY_LINES: usize = 400;

/// Which crates each crate may depend on, beside [`OPEN_TO_ALL`]. The map of docs/architecture.md in full.
const ARROWS: &[(&str, &[&str])] = &[
    ("mesh-core", &[]),
    ("mesh-query", &["mesh-core", "obvhs"]),
    ("mesh-io", &["mesh-core", "flate2", "gltf", "quick-xml", "robust", "serde_json", "tobj", "zip"]),
    ("tri-intersect", &["mesh-core", "mesh-query", "robust", "spade"]),
    ("profile-nurbs", &["nalgebra"]),
    ("spine", &["mesh-core", "mesh-query", "tri-intersect"]),
    ("param-conformal", &["mesh-core", "faer"]),
    ("rbf-solve", &["faer"]),
    ("lmc-tessellate", &["mesh-core", "mesh-query"]),
    ("remesh", &["mesh-core", "mesh-query", "faer"]),
    ("detail-transfer", &["mesh-core", "mesh-query", "param-conformal", "remesh", "faer"]),
    ("edge-cluster", &["mesh-core", "profile-nurbs", "spade"]),
    ("render", &["mesh-core", "mesh-query", "image"]),
    (
        "fusion",
        &[
            "mesh-core",
            "mesh-query",
            "mesh-io",
            "tri-intersect",
            "profile-nurbs",
            "spine",
            "param-conformal",
            "rbf-solve",
            "lmc-tessellate",
            "remesh",
            "detail-transfer",
            "edge-cluster",
            "render",
            "mimalloc",
            "serde",
            "serde_json",
            "toml",
        ],
    ),
    (
        "fusion-cli",
        &[
            "fusion",
            "mesh-io",
            "anstyle",
            "clap",
            "clap_complete",
            "clap_mangen",
            "ctrlc",
            "indicatif",
            "mimalloc",
            "serde_json",
            "tempfile",
        ],
    ),
    (
        "xtask",
        &[
            "fusion",
            "lmc-tessellate",
            "mesh-core",
            "mesh-io",
            "mesh-query",
            "param-conformal",
            "tri-intersect",
            "clap",
            "either",
            "getrandom",
            "libc",
            "serde",
            "serde_json",
            "tempfile",
            "toml",
        ],
    ),
];
const OPEN_TO_ALL: &[&str] = &["glam", "rayon", "thiserror"];
/// Open to the tests and benchmarks of every crate.
const OPEN_TO_TESTS: &[&str] = &["criterion", "mesh-core", "proptest", "serde_json", "tempfile"];

/// Runs every check and lists all that is wrong.
pub fn run() -> Result<(), Fault> {
    let mut faults = arrows()?;
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
    if !pages::RECIPES.holds(&fusion::recipe::reference())? {
        faults.push(format!("{}: its keys are not those of the code; run cargo xtask reference", pages::RECIPES.page));
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
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .current_dir(root())
        .output()?;
    let metadata: Value = serde_json::from_slice(&output.stdout)?;
    let mut faults = vec![];
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let name = package["name"].as_str().unwrap_or_default();
        let Some((_, allowed)) = ARROWS.iter().find(|(n, _)| *n == name) else {
            faults.push(format!("{name}: is not in the table of crates (xtask/src/tidy.rs)"));
            continue;
        };
        for dependency in package["dependencies"].as_array().into_iter().flatten() {
            let other = dependency["name"].as_str().unwrap_or_default();
            let for_tests = dependency["kind"] == "dev" && OPEN_TO_TESTS.contains(&other);
            if !allowed.contains(&other) && !OPEN_TO_ALL.contains(&other) && !for_tests {
                faults.push(format!("{name} -> {other}: this arrow is not in the table (xtask/src/tidy.rs)"));
            }
        }
    }
    Ok(faults)
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
