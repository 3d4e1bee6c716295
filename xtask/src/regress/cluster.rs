//! Polyhedra rounded by clusters: models against approved records, control nets against another evaluator.

use super::golden::Golden;
use super::reference::{Reference, python};
use super::threads::Threads;
use crate::{Fault, root};
use fusion::cluster::{Clustered, Degree, Params, PatchParams, Spec, cluster, solids};
use glam::DVec2;
use mesh_core::Watch;
use mesh_io::{Format, Model, Polygons};
use serde_json::{Value, json};
use std::fs;
use std::process::Command;

/// Points at which the evaluators are compared, over all nets.
const SAMPLES: usize = 10_000;
/// Largest distance allowed between them, as a share of a net's extent.
const AGREEMENT: f64 = 1e-12;

/// The models of \[EdgeCluster2019\], and the contact and degree they are blended with.
fn cases() -> Vec<(&'static str, solids::Solid, usize, Option<Degree>)> {
    vec![
        ("cluster-pressure-meter", solids::pressure_meter(), 1, Some(Degree::Tensor(4, 2))),
        ("cluster-pressure-meter-g2", solids::pressure_meter(), 2, Some(Degree::Tensor(5, 5))),
        ("cluster-vase", solids::vase(), 1, None),
        ("cluster-flower-pot", solids::flower_pot(), 1, None),
        ("cluster-door-knob", solids::door_knob(), 1, None),
    ]
}

/// The regular and semiregular solids and ten convex-concave ones, whose clusters are chosen.
fn covered() -> impl Iterator<Item = (String, solids::Solid)> {
    let regular = solids::regular().into_iter().map(|(name, solid)| (name.to_string(), solid));
    regular.chain((0..10).map(|seed| (format!("convex-concave {seed}"), solids::convex_concave(seed))))
}

/// The polyhedra as models of polygons, with the clusters they are blended by, as a file names them, if they are not
/// chosen.
pub fn polyhedra() -> Vec<(String, Model, Option<String>)> {
    let file = |clusters: &[Vec<u32>]| {
        let entry = |c| format!("\n[[cluster]]\nvertices = {c:?}\n");
        clusters.iter().fold("version = 1\n".to_string(), |text, c: &Vec<u32>| text + &entry(c))
    };
    let named = cases().into_iter().filter(|c| c.2 == 1);
    let named = named.map(|(name, solid, ..)| (name.to_string(), model(&solid), Some(file(&solid.clusters))));
    let chosen = covered().map(|(name, solid)| (format!("cluster-{}", name.replace(' ', "-")), model(&solid), None));
    named.chain(chosen).collect()
}

fn model(solid: &solids::Solid) -> Model {
    let (mesh, of_face) = solid.triangles();
    let mut starts = vec![0];
    starts.extend(solid.polygons.iter().scan(0, |at, p| {
        *at += p.len() as u32;
        Some(*at)
    }));
    let corners = solid.polygons.concat().into_iter().map(mesh_core::VertexId).collect();
    Model { polygons: Some(Polygons { starts, corners, of_face: of_face.into() }), ..Model::from(mesh) }
}

/// Runs every model and returns how many faults there were.
pub fn run(bless: bool, reference: &mut Option<Reference>, threads: &mut Threads) -> Result<usize, Fault> {
    let mut faults = 0;
    let mut made = vec![];
    for (name, solid, continuity, degree) in cases() {
        let specs = solid.clusters.iter().map(|v| Spec { vertices: v.clone(), ..Spec::default() }).collect();
        let params = Params {
            clusters: Some(specs),
            patch: PatchParams { continuity, degree, ..PatchParams::default() },
            tolerance: 1e-3,
            ..Params::new(Format::Ply)
        };
        let part = model(&solid);
        let job = || cluster(&part, &params, &Watch::default());
        let (rounded, differs) = threads.twice(name, job, |made| made.as_ref().ok().map(|m| &m.outcome.model.mesh));
        let rounded = rounded?;
        let record = root().join("fixtures/golden").join(format!("{name}.toml"));
        let now = Golden::of(&rounded.outcome.model.mesh)?;
        let wrong = match Golden::read(&record)? {
            _ if bless => {
                now.bless(&record)?;
                vec![]
            }
            None => vec!["has no approved record; look at it, then run `cargo xtask regress --bless`".to_string()],
            Some(approved) => now.differences(&approved),
        };
        let wrong: Vec<String> = differs.into_iter().chain(wrong).collect();
        for fault in &wrong {
            println!("regress: {name}: {fault}");
        }
        faults += wrong.len();
        if let Some(reference) = reference {
            reference.add(name, &rounded.outcome.model.mesh)?;
        }
        made.push((name, rounded));
    }
    println!("regress: {} polyhedra, {faults} faults", made.len());
    if let Some(reference) = reference {
        for (name, solid) in covered() {
            let params = Params { tolerance: 2e-3, ..Params::new(Format::Ply) };
            let rounded = cluster(&model(&solid), &params, &Watch::default()).map_err(|e| format!("{name}: {e}"))?;
            reference.add(&name, &rounded.outcome.model.mesh)?;
        }
        faults += made.iter().map(|(name, m)| compare(name, m, SAMPLES / made.len())).sum::<Result<usize, Fault>>()?;
    }
    Ok(faults)
}

/// Compares our evaluation of a model's nets with that of `nets.py`.
fn compare(name: &str, made: &Clustered, count: usize) -> Result<usize, Fault> {
    let patches = &made.blend.layout.patches;
    let mut rng = fastrand::Rng::with_seed(0x2545_F491_4F6C_DD1D);
    let mut random = || rng.f64();
    let each = count.div_ceil(patches.len());
    let mut samples: Vec<Value> = vec![];
    for patch in patches {
        // Random convex combinations of the domain's corners.
        let mut point = || {
            let weights: Vec<f64> = (0..patch.sides()).map(|_| random().powi(3)).collect();
            let sum: f64 = weights.iter().sum();
            let at: DVec2 = weights.iter().enumerate().map(|(k, w)| w / sum * patch.corner(k)).sum();
            let p = patch.point(at);
            json!([at.x, at.y, p.x, p.y, p.z])
        };
        samples.push((0..each).map(|_| point()).collect());
    }
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("nets.json");
    let nets: Value = serde_json::from_str(&made.nets_to_json())?;
    fs::write(&file, json!({ "nets": nets, "samples": samples }).to_string())?;
    let output = Command::new(python()?).arg(root().join("xtask/nets.py")).arg(&file).output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let worst: Option<f64> = text.split_whitespace().next().and_then(|w| w.parse().ok());
    match worst {
        Some(worst) if worst <= AGREEMENT => {
            println!("regress: {name}: two evaluators agree to {worst:.1e} at {} points", each * patches.len());
            Ok(0)
        }
        Some(worst) => {
            println!("regress: {name}: two evaluators differ by {worst:.1e}, more than {AGREEMENT:.0e}");
            Ok(1)
        }
        None => Err(format!("nets.py gave no verdict: {}", String::from_utf8_lossy(&output.stderr)).into()),
    }
}
