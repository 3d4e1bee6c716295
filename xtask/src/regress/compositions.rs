//! Random compositions of open pieces of scans.

use super::case::Operation;
use super::join::{Failure, Joined, join};
use super::pose::SplitMix;
use super::reference::Reference;
use crate::{Fault, root};
use glam::{DQuat, DVec3};
use mesh_core::{Connected, Faces, Positions, TriMesh, boundary_loops};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Pieces with one opening.
const PIECES: [&str; 9] = [
    "armadillo_piece0",
    "armadillo_piece1",
    "dino_piece0",
    "dino_piece1",
    "dino_piece2",
    "elephant_piece0",
    "elephant_piece1",
    "elephant_piece2",
    "elephant_piece3",
];
/// Bodies with several, which are closed by foreign pieces.
const BODIES: [&str; 3] = ["armadillo_body", "dino_body", "elephant_body"];
/// How many compositions.
const COUNT: u64 = 40;
/// With `--quick`, every so many.
const QUICK: usize = 8;

struct Row {
    name: String,
    outcome: Result<Joined, Failure>,
    faults: Vec<String>,
}

/// Composes all, writes the table, and counts results that are wrong. A failure that says where is no fault.
pub fn run(models: &Path, quick: bool, reference: &mut Option<Reference>) -> Result<usize, Fault> {
    let folder = models.join("detail/derived");
    if !folder.is_dir() {
        return Ok(0);
    }
    let read = |name: &str| mesh_io::read(&folder.join(name).with_extension("off")).map(|m| m.mesh);
    let mut rows = vec![];
    for seed in (0..COUNT).step_by(if quick { QUICK } else { 1 }) {
        let mut random = SplitMix(seed);
        // Poses in which pieces cross are no question to a composition: others are drawn.
        let (name, parts, outcome) = loop {
            let (names, parts) = draw(seed, &read, &mut random)?;
            let outcome = join(&parts, Operation::Compose, None);
            if !outcome.as_ref().is_err_and(|e| e.reason.contains(" cross at ")) {
                break (format!("#{seed}: {}", names.join(" + ")), parts, outcome);
            }
        };
        let faults = match &outcome {
            Ok(joined) => {
                if let Some(reference) = reference {
                    reference.add(&name, &joined.mesh)?;
                }
                joined.faults(&parts, Operation::Compose, None)
            }
            Err(failure) if failure.place.is_none() => vec![format!("fails without a place: {}", failure.reason)],
            Err(_) => vec![],
        };
        rows.push(Row { name, outcome, faults });
    }
    let verdicts: BTreeMap<_, _> = match reference {
        Some(reference) => reference.verdicts()?.into_iter().collect(),
        None => BTreeMap::new(),
    };
    for row in &mut rows {
        if let Some(verdict) = verdicts.get(&row.name).filter(|v| *v != "ok") {
            row.faults.push(format!("libigl: {verdict}"));
        }
        for fault in &row.faults {
            println!("regress: {}: {fault}", row.name);
        }
    }
    let good = rows.iter().filter(|r| r.outcome.is_ok() && r.faults.is_empty()).count();
    println!("regress: {good} of {} compositions succeed", rows.len());
    if !quick {
        fs::write(root().join("docs/regress-compositions.md"), table(&rows, good, reference.is_some())?)?;
    }
    Ok(rows.iter().map(|r| r.faults.len()).sum())
}

/// Some pieces in a random pose, by name.
fn draw(
    seed: u64,
    read: &impl Fn(&str) -> Result<TriMesh, mesh_io::Error>,
    random: &mut SplitMix,
) -> Result<(Vec<&'static str>, Vec<TriMesh>), Fault> {
    let mut names = vec![];
    let mut parts = vec![];
    if seed % 4 == 3 {
        let body = BODIES[pick(random, BODIES.len())];
        let mesh = read(body)?;
        names.push(body);
        for opening in discs(&mesh)? {
            let piece = PIECES[pick(random, PIECES.len())];
            parts.push(opposite(read(piece)?, opening, random)?);
            names.push(piece);
        }
        parts.insert(0, mesh);
    } else {
        let count = 2 + pick(random, 3);
        let turn = random.rotation();
        for direction in &DIRECTIONS[count - 2][..count] {
            let piece = PIECES[pick(random, PIECES.len())];
            parts.push(around(read(piece)?, turn * *direction, random)?);
            names.push(piece);
        }
    }
    Ok((names, parts))
}

/// Two, three and four directions far from each other.
const DIRECTIONS: [[DVec3; 4]; 3] = [
    [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::Z],
    [DVec3::X, DVec3::new(-0.5, 0.866, 0.0), DVec3::new(-0.5, -0.866, 0.0), DVec3::Z],
    [
        DVec3::new(0.577, 0.577, 0.577),
        DVec3::new(0.577, -0.577, -0.577),
        DVec3::new(-0.577, 0.577, -0.577),
        DVec3::new(-0.577, -0.577, 0.577),
    ],
];

fn pick(random: &mut SplitMix, count: usize) -> usize {
    (random.unit() * count as f64) as usize % count
}

/// An opening as middle, axis out of the part, and radius.
type Disc = (DVec3, DVec3, f64);

fn discs(mesh: &TriMesh) -> Result<Vec<Disc>, Fault> {
    let mesh = Connected::new(mesh)?;
    let disc = |walk: &Vec<mesh_core::HalfedgeId>| {
        let points: Vec<DVec3> = walk.iter().map(|&h| mesh.position(mesh.tail(h))).collect();
        let center = points.iter().sum::<DVec3>() / points.len() as f64;
        let after = |i: usize| points[(i + 1) % points.len()] - center;
        let area = (0..points.len()).map(|i| after(i).cross(points[i] - center)).sum::<DVec3>() / 2.0;
        (center, area.normalize_or(DVec3::Z), (area.length() / std::f64::consts::PI).sqrt())
    };
    Ok(boundary_loops(&mesh).iter().map(disc).collect())
}

/// Turns a piece so that its opening faces along `axis` with a tilt and a spin, and stands at `center` with `radius`.
fn pose(mut piece: TriMesh, center: DVec3, axis: DVec3, radius: f64, random: &mut SplitMix) -> Result<TriMesh, Fault> {
    let (from, out, size) = *discs(&piece)?.first().ok_or("a piece has no opening")?;
    let tilt = DQuat::from_axis_angle(axis.any_orthonormal_vector(), (30.0 * random.unit()).to_radians());
    let spin = |random: &mut SplitMix| DQuat::from_axis_angle(axis, std::f64::consts::TAU * random.unit());
    let turn = spin(random) * tilt * spin(random) * DQuat::from_rotation_arc(out, axis);
    let scale = radius / size;
    piece.positions.iter_mut().for_each(|p| *p = turn * (scale * (*p - from)) + center);
    Ok(piece)
}

/// A piece of radius 0.7 to 1.4 whose opening faces the origin from a random distance.
fn around(piece: TriMesh, direction: DVec3, random: &mut SplitMix) -> Result<TriMesh, Fault> {
    let radius = 0.7 + 0.7 * random.unit();
    let distance = 1.4 + 1.6 * random.unit();
    pose(piece, distance * direction, -direction, radius, random)
}

/// A piece of 0.7 to 1.4 times an opening's radius that faces it from 0.5 to 2 radii.
fn opposite(piece: TriMesh, (center, axis, radius): Disc, random: &mut SplitMix) -> Result<TriMesh, Fault> {
    let size = radius * (0.7 + 0.7 * random.unit());
    let gap = radius * (0.5 + 1.5 * random.unit());
    pose(piece, center + gap * axis, -axis, size, random)
}

fn table(rows: &[Row], good: usize, checked: bool) -> Result<String, Fault> {
    let mut text = format!(
        "# Random compositions of scans\n\nWritten by `cargo xtask regress --models DIR`. Two to four pieces around a point, or a body whose openings \
         face foreign pieces, in random poses: turned by up to 30°, 0.7 to 1.4 times as wide as each other, `compose` with its defaults. {good} of {} \
         are closed, oriented, 2-manifold and free of self-intersections, and all vertices of the parts have the bits of their pose.\n",
        rows.len()
    );
    text +=
        if checked { "libigl's exact self-intersection test agrees on all of them unless noted.\n\n" } else { "\n" };
    writeln!(text, "| parts | faces | ms | outcome |\n|---|---|---|---|")?;
    for row in rows {
        let (faces, time, words) = match &row.outcome {
            Ok(joined) => {
                let words = std::iter::once("done").chain(joined.warnings.iter().map(String::as_str));
                (joined.mesh.face_count(), joined.milliseconds, words.collect::<Vec<_>>().join("; "))
            }
            Err(failure) => (0, failure.milliseconds, failure.reason.clone()),
        };
        let faults: Vec<_> = row.faults.iter().map(|f| format!("; **{f}**")).collect();
        let faults = faults.concat();
        writeln!(text, "| {} | {faces} | {time:.0} | {}{faults} |", row.name, words.replace('|', "/"))?;
    }
    Ok(text)
}
