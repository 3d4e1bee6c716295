//! Documents evaluated, against approved records.
//!
//! A composed surface comes out of a large linear solve, whose last bits differ between processors; so records hold topology exactly, and
//! measures to a tolerance.

use super::reference::Reference;
use super::threads::Threads;
use crate::{Fault, root};
use fusion::Document;
use fusion::document::{Cache, Evaluation, Precisions};
use mesh_core::{Connected, Stopwatch, TriMesh, Watch, area, topology, validate, volume};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Measures may differ by this share.
const TOLERANCE: f64 = 1e-3;

/// What a document made.
#[derive(Debug, Serialize, Deserialize)]
struct Record {
    components: usize,
    boundary_loops: usize,
    genus: i64,
    area: f64,
    volume: f64,
}

impl Record {
    fn differences(&self, approved: &Self) -> Vec<String> {
        let counts = |r: &Self| (r.components, r.boundary_loops, r.genus);
        let mut all = vec![];
        if counts(self) != counts(approved) {
            all.push(format!("has components, loops and genus {:?}, had {:?}", counts(self), counts(approved)));
        }
        for (what, is, was) in [("area", self.area, approved.area), ("volume", self.volume, approved.volume)] {
            if (is - was).abs() > TOLERANCE * was.abs() {
                all.push(format!("{what} is {is}, was {was}"));
            }
        }
        all
    }
}

/// Evaluates every document of fixtures/documents and returns how many faults there were.
pub fn run(bless: bool, reference: &mut Option<Reference>, threads: &mut Threads) -> Result<usize, Fault> {
    let folder = root().join("fixtures/documents");
    let mut paths: Vec<PathBuf> = fs::read_dir(&folder)?.flatten().map(|e| e.path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    let mut faults = 0;
    for path in &paths {
        let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        for fault in replay(path, &name, bless, reference, threads)? {
            println!("regress: {name}: {fault}");
            faults += 1;
        }
    }
    println!("regress: {} documents, {faults} faults", paths.len());
    Ok(faults)
}

fn first_mesh(made: &Result<Evaluation, fusion::Error>) -> Option<&TriMesh> {
    made.as_ref().ok()?.outputs.first().map(|output| &output.outcome.model.mesh)
}

fn replay(
    path: &Path,
    name: &str,
    bless: bool,
    reference: &mut Option<Reference>,
    threads: &mut Threads,
) -> Result<Vec<String>, Fault> {
    let document = Document::parse(&fs::read_to_string(path)?)?;
    let folder = path.parent().unwrap_or(path);
    let start = Stopwatch::start();
    // A cache of each run's own, or the second would do nothing.
    let job = || document.evaluate(folder, &Cache::in_memory(0), Precisions::ByFile, &Watch::default());
    let (made, differs) = threads.twice(name, job, first_mesh);
    let made = match made {
        Ok(mut made) if made.outputs.len() == 1 => made.outputs.remove(0).outcome.model.mesh,
        Ok(made) => return Ok(vec![format!("has {} outputs instead of one", made.outputs.len())]),
        Err(error) => return Ok(vec![error.to_string()]),
    };
    println!("regress: {name}: {} triangles twice in {:.2} s", made.faces.len(), start.elapsed().as_secs_f64());
    let counts = topology(&Connected::new(&made)?);
    let now = Record {
        components: counts.components,
        boundary_loops: counts.boundary_loops,
        genus: counts.genus(),
        area: area(&made),
        volume: volume(&made),
    };
    let mut wrong: Vec<String> = differs.into_iter().collect();
    if !validate(&made).is_manifold() {
        wrong.push(format!("is not valid: {}", validate(&made)));
    }
    match tri_intersect::self_intersections(&made, &Watch::default()) {
        Ok(pairs) if pairs.is_empty() => {}
        Ok(pairs) => wrong.push(format!("intersects itself: {} pairs, first {:?}", pairs.len(), pairs[0])),
        Err(error) => wrong.push(format!("cannot be checked: {error}")),
    }
    if let Some(reference) = reference {
        reference.add(&format!("document-{name}"), &made)?;
    }
    let record = root().join("fixtures/golden").join(format!("document-{name}.toml"));
    if bless {
        fs::write(&record, toml::to_string(&now)?)?;
    } else if let Ok(text) = fs::read_to_string(&record) {
        wrong.extend(now.differences(&toml::from_str(&text)?));
    } else {
        wrong.push("has no approved record; look at it, then run `cargo xtask regress --bless`".into());
    }
    Ok(wrong)
}
