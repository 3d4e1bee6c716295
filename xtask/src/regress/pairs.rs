//! Pairs of real models, joined and blended at four radii.

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
const RADII: [f64; 4] = [0.005, 0.01, 0.02, 0.04];
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
    writeln!(
        text,
        "| radius | succeed | of | by strips alone | by fields alone | by both | full radius throughout | median ms | 90% ms |\n|---|---|---|---|---|---|---|---|---|"
    )?;
    for (share, done, all) in totals(rows, radii) {
        let good: Vec<&Joined> =
            rows.iter().filter(|r| r.share == share).filter_map(|r| r.outcome.as_ref().ok()).collect();
        let count = |test: &dyn Fn(&Joined) -> bool| good.iter().filter(|j| test(j)).count();
        let [strips, fields] = ["strips", "fields"].map(|name| move |j: &Joined| j.figure(name) > 0.0);
        let mut times: Vec<f64> = good.iter().map(|j| j.milliseconds).collect();
        times.sort_by(f64::total_cmp);
        let quantile = |q: f64| times.get(((times.len().max(1) - 1) as f64 * q) as usize).copied().unwrap_or_default();
        writeln!(
            text,
            "| {}% | {done} ({:.0}%) | {all} | {} | {} | {} | {} | {:.0} | {:.0} |",
            100.0 * share,
            100.0 * done as f64 / all.max(1) as f64,
            count(&|j| strips(j) && !fields(j)),
            count(&|j| fields(j) && !strips(j)),
            count(&|j| fields(j) && strips(j)),
            count(&|j| j.figure("full_share") >= 0.999),
            quantile(0.5),
            quantile(0.9),
        )?;
    }
    writeln!(
        text,
        "\nThe outcome names what made the blend, and where the ball had to be made smaller: at how many places, down to what share of the radius, and the share of the seam that keeps the full one.\n\n| pair | radius | ms | outcome |\n|---|---|---|---|"
    )?;
    for row in rows {
        let (time, words) = match &row.outcome {
            Ok(joined) => (joined.milliseconds, account(joined)),
            Err(failure) => (failure.milliseconds, failure.reason.clone()),
        };
        let faults: Vec<_> = row.faults.iter().map(|f| format!("; **{f}**")).collect();
        let faults = faults.concat();
        writeln!(text, "| {} | {}% | {time:.0} | {}{faults} |", row.name, 100.0 * row.share, words.replace('|', "/"))?;
    }
    Ok(text)
}

/// What made the blend, and what it took.
fn account(joined: &Joined) -> String {
    let many = |n: f64, what: &str| match n {
        0.0 => None,
        1.0 => Some(format!("1 {what}")),
        _ => Some(format!("{n} {what}s")),
    };
    let made: Vec<String> = [("strips", "strip"), ("fields", "field")]
        .into_iter()
        .filter_map(|(figure, word)| many(joined.figure(figure), word))
        .collect();
    let mut words = if made.is_empty() { "done".to_string() } else { made.join(" and ") };
    if let Some(places) = many(joined.figure("shrunk_places"), "place") {
        let least = joined.figure("smallest_radius") / joined.figure("radius");
        let full = 100.0 * joined.figure("full_share");
        let _ = write!(words, "; smaller at {places}, down to {least:.2}, {full:.0}% full");
    }
    for warning in joined.warnings.iter().filter(|w| !w.contains("does not fit near")) {
        let _ = write!(words, "; {warning}");
    }
    words
}
