//! Marching cubes on random fields, against scikit-image's Lewiner through `lewiner.py`.

use super::reference::python;
use crate::{Fault, root};
use glam::DVec3;
use lmc_tessellate::isosurface;
use mesh_core::{Connected, topology, validate};
use serde_json::{Value, json};
use std::fs;
use std::process::Command;

/// Samples along each side, the outermost of them outside.
const SIDE: usize = 12;
/// Fields of each roughness.
const FIELDS: u64 = 25;
/// How often white noise is averaged over neighbours.
const ROUGHNESS: [usize; 3] = [0, 1, 2];

/// Runs all fields and returns how many faults there were.
pub fn run() -> Result<usize, Fault> {
    let mut faults = 0;
    let mut fields: Vec<Value> = vec![];
    for (rounds, seed) in ROUGHNESS.into_iter().flat_map(|r| (0..FIELDS).map(move |s| (r, s))) {
        let values = field(seed, rounds);
        let mesh = isosurface(&values, [SIDE; 3], DVec3::ZERO, 1.0);
        if !validate(&mesh).is_closed() {
            println!("regress: field {seed} averaged {rounds} times: {}", validate(&mesh));
            faults += 1;
            continue;
        }
        let counts = topology(&Connected::new(&mesh)?);
        let (euler, components, sides) = (counts.euler_characteristic(), counts.components, [SIDE; 3]);
        fields.push(json!({ "counts": sides, "values": values, "euler": euler, "components": components }));
    }
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("fields.json");
    fs::write(&file, Value::from(fields.clone()).to_string())?;
    let output = Command::new(python()?).arg(root().join("xtask/lewiner.py")).arg(&file).output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    if text.lines().count() != fields.len() {
        return Err(format!(
            "lewiner.py gave {} verdicts: {}",
            text.lines().count(),
            String::from_utf8_lossy(&output.stderr)
        )
        .into());
    }
    let count = |word: &str| text.lines().filter(|l| l.split(' ').next() == Some(word)).count();
    println!(
        "regress: marching cubes on {} fields: {} as Lewiner, {} where Lewiner is wrong, {} undecided",
        fields.len(),
        count("same"),
        count("theirs"),
        count("neither"),
    );
    for line in text.lines().filter(|l| l.starts_with("ours ")) {
        println!("regress: marching cubes: a finer grid agrees with Lewiner: {line}");
        faults += 1;
    }
    Ok(faults)
}

/// Noise in [−1, 1], averaged over neighbours, within a shell of ones; in numbers that single precision holds, as
/// scikit-image works in it.
fn field(seed: u64, rounds: usize) -> Vec<f64> {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut random = || 2.0 * rng.f64() - 1.0;
    let mut values: Vec<f64> = (0..SIDE.pow(3)).map(|_| random()).collect();
    let place = |i: usize| [i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE];
    for _ in 0..rounds {
        let old = values.clone();
        for (i, v) in values.iter_mut().enumerate() {
            let near = (0..3).flat_map(|axis| {
                let (k, step) = (place(i)[axis], SIDE.pow(axis as u32));
                [(k > 0).then(|| i - step), (k + 1 < SIDE).then(|| i + step)]
            });
            let (sum, n) = near.flatten().fold((old[i], 1.0), |(s, n), j| (s + old[j], n + 1.0));
            *v = sum / n;
        }
    }
    for (i, v) in values.iter_mut().enumerate() {
        *v = if place(i).iter().any(|&k| k == 0 || k + 1 == SIDE) { 1.0 } else { f64::from(*v as f32) };
    }
    values
}
