//! Every closed, manifold CAD mesh without crossings of a folder, all edges blended with the defaults.

use super::blends::{Run, blend};
use crate::{Fault, root, walk};
use fusion::{Choice, Error, choice};
use mesh_core::{TriMesh, Watch, bounds, validate};
use mesh_io::Model;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::Duration;

/// Radii as shares of the box's diagonal.
const RADII: [f64; 3] = [0.003, 0.01, 0.03];
/// The dihedral angle of an edge, in degrees: the default.
const ANGLE: f64 = 40.0;
const LIMIT: Duration = Duration::from_secs(60);
/// What is promised of each blend, in seconds.
const PROMISED: f64 = 10.0;

struct Row {
    name: String,
    share: f64,
    run: Run,
}

/// Blends all, writes the table, and counts what is not as promised: invalid results, refusals of meshes that have edges,
/// and those that took too long.
pub fn run(folder: &Path, quick: bool) -> Result<usize, Fault> {
    let mut files = vec![];
    walk(folder, &mut files);
    let mut rows = vec![];
    for path in files {
        let Some(mesh) = mesh_io::read(&path).ok().map(|m| m.mesh).filter(serves) else { continue };
        let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
        let diagonal = bounds(&mesh).diagonal();
        let model = Model::from(mesh);
        for &share in if quick { &RADII[1..2] } else { &RADII[..] } {
            let run = blend(&model, ANGLE, Choice::default(), share * diagonal, LIMIT);
            println!("regress: {name} at {}%: exit {} in {:.2} s", 100.0 * share, run.exit(), run.seconds);
            rows.push(Row { name: name.clone(), share, run });
        }
    }
    if !quick {
        fs::write(root().join("docs/regress-cad.md"), table(&rows)?)?;
    }
    let smooth = |r: &&Row| matches!(r.run.outcome, Err(Error::Choice(choice::Refusal::NoEdges { .. })));
    let wrong = |r: &&Row| !smooth(r) && (r.run.outcome.is_err() || r.run.seconds > PROMISED);
    let faults = rows.iter().filter(wrong).count();
    println!("regress: {} blends of CAD meshes, {faults} not as promised", rows.len());
    Ok(faults)
}

/// Closed, manifold and free of crossings.
fn serves(mesh: &TriMesh) -> bool {
    let defects = validate(mesh);
    let crossings = || tri_intersect::self_intersections(mesh, &Watch::default());
    defects.is_closed() && !mesh.faces.is_empty() && crossings().is_ok_and(|pairs| pairs.is_empty())
}

fn table(rows: &[Row]) -> Result<String, Fault> {
    let mut text = String::from(
        "# All edges of CAD meshes\n\nWritten by `cargo xtask regress --models DIR`: every closed, manifold mesh without crossings in `DIR/cad`, all edges \
         over 40 degrees, default options; the radius is a share of the box's diagonal. *Blended* is the share of the length of all chosen curves that is \
         gone from the result, *full* the share along which the blend lies on balls of the radius asked for within 5%, as measured on the result. Every \
         result (exit 0) is closed, manifold and free of crossings. A mesh without any edge over the angle ends with exit 4, `no_edges`.\n\n\
         | radius | exit 0 | of | blended | full | median s | largest s |\n|---|---|---|---|---|---|---|\n",
    );
    for share in RADII {
        let own = |r: &&Row| r.share == share && !matches!(r.run.outcome, Err(Error::Choice(_)));
        let all: Vec<&Row> = rows.iter().filter(own).collect();
        let shares: Vec<[f64; 2]> = all.iter().map(|r| r.run.shares().unwrap_or_default()).collect();
        let mean = |k: usize| 100.0 * shares.iter().map(|s| s[k]).sum::<f64>() / shares.len().max(1) as f64;
        let mut times: Vec<f64> = all.iter().map(|r| r.run.seconds).collect();
        times.sort_by(f64::total_cmp);
        let (half, last) = (times.len() / 2, times.last().copied().unwrap_or_default());
        writeln!(
            text,
            "| {}% | {} | {} | {:.1}% | {:.1}% | {:.2} | {last:.1} |",
            100.0 * share,
            all.iter().filter(|r| r.run.outcome.is_ok()).count(),
            all.len(),
            mean(0),
            mean(1),
            times.get(half).copied().unwrap_or_default(),
        )?;
    }
    text +=
        "\n| mesh | radius | exit | blended | full | s | first warning or reason |\n|---|---|---|---|---|---|---|\n";
    for Row { name, share, run } in rows {
        let shares = run.shares().map_or(["-".into(), "-".into()], |s| s.map(|x| format!("{:.1}%", 100.0 * x)));
        let [blended, full] = shares;
        let (exit, seconds, words) = (run.exit(), run.seconds, run.words());
        writeln!(text, "| {name} | {}% | {exit} | {blended} | {full} | {seconds:.2} | {words} |", 100.0 * share)?;
    }
    Ok(text)
}
