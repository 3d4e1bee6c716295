//! Pairs of real models, joined and blended at three radii.

use super::case::Operation;
use super::join::{Failure, Joined, join};
use super::pose::overlapping;
use super::reference::Reference;
use crate::{Fault, root};
use mesh_core::{Bounds, TriMesh, bounds};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Radii as shares of the joint box's diagonal.
const RADII: [f64; 3] = [0.005, 0.01, 0.02];
/// With `--quick`, every so many pairs, at the middle radius.
const QUICK: usize = 8;

#[derive(Deserialize)]
struct List {
    pair: Vec<Pair>,
}

#[derive(Deserialize)]
struct Pair {
    a: String,
    b: String,
    seed: u64,
}

struct Row {
    name: String,
    share: f64,
    outcome: Result<Joined, Failure>,
    faults: Vec<String>,
}

/// Runs all pairs, writes the table, and counts results that are wrong. A failure that says where is no fault.
pub fn run(models: &Path, quick: bool, reference: &mut Option<Reference>) -> Result<usize, Fault> {
    let list: List = toml::from_str(&fs::read_to_string(root().join("fixtures/pairs.toml"))?)?;
    let radii = if quick { &RADII[1..2] } else { &RADII[..] };
    let mut rows = vec![];
    for pair in list.pair.iter().step_by(if quick { QUICK } else { 1 }) {
        let read = |name: &str| mesh_io::read(&models.join(name)).map(|m| m.mesh);
        let parts = overlapping(read(&pair.a)?, read(&pair.b)?, pair.seed);
        let size = parts.iter().map(bounds).fold(Bounds::EMPTY, Bounds::union).diagonal();
        let stem = |p: &str| Path::new(p).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        for &share in radii {
            let name = format!("{} + {} #{}", stem(&pair.a), stem(&pair.b), pair.seed);
            rows.push(one(name, share, &parts, share * size, reference)?);
        }
    }
    let verdicts: BTreeMap<_, _> = match reference {
        Some(reference) => reference.verdicts()?.into_iter().collect(),
        None => BTreeMap::new(),
    };
    for row in &mut rows {
        if let Some(verdict) = verdicts.get(&key(&row.name, row.share)).filter(|v| *v != "ok") {
            row.faults.push(format!("libigl: {verdict}"));
        }
    }
    for (row, fault) in rows.iter().flat_map(|r| r.faults.iter().map(move |f| (r, f))) {
        println!("regress: {}: {fault}", key(&row.name, row.share));
    }
    for (share, done, all) in totals(&rows, radii) {
        println!("regress: radius {}%: {done} of {all} pairs succeed", 100.0 * share);
    }
    if !quick {
        fs::write(root().join("docs/regress-pairs.md"), table(&rows, radii, reference.is_some())?)?;
    }
    Ok(rows.iter().map(|r| r.faults.len()).sum())
}

fn one(
    name: String,
    share: f64,
    parts: &[TriMesh],
    radius: f64,
    reference: &mut Option<Reference>,
) -> Result<Row, Fault> {
    let outcome = join(parts, Operation::Union, Some(radius));
    let faults = match &outcome {
        Ok(joined) => {
            if let Some(reference) = reference {
                reference.add(&key(&name, share), &joined.mesh)?;
            }
            joined.faults(parts, Operation::Union, Some(radius))
        }
        Err(failure) if failure.place.is_none() => vec![format!("fails without a place: {}", failure.reason)],
        Err(_) => vec![],
    };
    Ok(Row { name, share, outcome, faults })
}

fn key(name: &str, share: f64) -> String {
    format!("{name} at {}%", 100.0 * share)
}

/// Radius, successes without fault, tries.
fn totals(rows: &[Row], radii: &[f64]) -> Vec<(f64, usize, usize)> {
    let of = |share: f64| rows.iter().filter(move |r| r.share == share);
    let good = |r: &&Row| r.outcome.is_ok() && r.faults.is_empty();
    radii.iter().map(|&s| (s, of(s).filter(good).count(), of(s).count())).collect()
}

fn table(rows: &[Row], radii: &[f64], checked: bool) -> Result<String, Fault> {
    let mut text = String::from(
        "# Filleted unions of real models\n\nWritten by `cargo xtask regress --models DIR`. Pairs and seeds are in `fixtures/pairs.toml`; the radius is a share of the \
         diagonal of the box around both. Every success is closed, oriented, 2-manifold and free of self-intersections, and all its \
         vertices off the seam have the bits of an input vertex.\n",
    );
    text +=
        if checked { "libigl's exact self-intersection test agrees on all of them unless noted.\n\n" } else { "\n" };
    writeln!(text, "| radius | succeed | of |\n|---|---|---|")?;
    for (share, done, all) in totals(rows, radii) {
        writeln!(text, "| {}% | {done} ({:.0}%) | {all} |", 100.0 * share, 100.0 * done as f64 / all.max(1) as f64)?;
    }
    writeln!(text, "\n| pair | radius | ms | outcome |\n|---|---|---|---|")?;
    for row in rows {
        let (time, words) = match &row.outcome {
            Ok(joined) if joined.warnings.is_empty() => (joined.milliseconds, "done".to_string()),
            Ok(joined) => (joined.milliseconds, format!("done; {}", joined.warnings.join("; "))),
            Err(failure) => (failure.milliseconds, failure.reason.clone()),
        };
        let faults: Vec<_> = row.faults.iter().map(|f| format!("; **{f}**")).collect();
        let faults = faults.concat();
        writeln!(text, "| {} | {}% | {time:.0} | {}{faults} |", row.name, 100.0 * row.share, words.replace('|', "/"))?;
    }
    Ok(text)
}
