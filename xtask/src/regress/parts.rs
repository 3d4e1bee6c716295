//! CAD parts exported from exact solids: all edges beside OCCT's fillets of the solids, and each straight edge alone.

use super::blends::{Run, blend};
use crate::{Fault, root};
use fusion::Choice;
use fusion::features::{self, feature_curves};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, dihedral_angle};
use mesh_io::Model;
use mesh_query::TriBvh;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::Duration;

/// Least dihedral angle of an edge that is blended, in degrees: the facets of the parts' round faces turn by less.
const ANGLE: f64 = 25.0;
const LIMIT: Duration = Duration::from_secs(60);
/// The radius of straight edges alone, in model units, and the fold that none may have unless the part had it, in degrees.
const ALONE: f64 = 0.5;
const FOLD: f64 = 95.0;
/// A curve is straight where no edge of it turns from its chord by more than this, in degrees.
const STRAIGHT: f64 = 0.5;

struct Row {
    part: String,
    share: String,
    run: Run,
    /// Whether OCCT blends the solid.
    theirs: bool,
    /// 99% of OCCT's points are nearer to the result than this, in radii.
    apart: Option<f64>,
}

/// What came of the straight edges of one part.
#[derive(Default)]
struct Straight {
    edges: usize,
    refused: usize,
    folded: Vec<String>,
}

/// Runs both, writes the table, and counts results that are not as promised.
pub fn run(folder: &Path, quick: bool) -> Result<usize, Fault> {
    let mut models: BTreeMap<String, Model> = BTreeMap::new();
    let mut rows = vec![];
    for line in fs::read_to_string(folder.join("occt.tsv"))?.lines().skip(1).step_by(if quick { 9 } else { 1 }) {
        let fields: Vec<&str> = line.split('\t').collect();
        let [part, share, radius, _, _, theirs, ..] = fields[..] else { continue };
        if !models.contains_key(part) {
            models.insert(part.into(), mesh_io::read(&folder.join(part))?);
        }
        let radius: f64 = radius.parse()?;
        let run = blend(&models[part], ANGLE, Choice::default(), radius, LIMIT);
        let points = folder.join(format!("{}-{share}.npy", part.trim_end_matches(".stl")));
        let apart = match (&run.outcome, points.exists()) {
            (Ok((mesh, _)), true) => Some(p99(mesh, &read_points(&fs::read(&points)?)?)? / radius),
            _ => None,
        };
        println!("regress: {part} at {share}: exit {} in {:.2} s", run.exit(), run.seconds);
        rows.push(Row { part: part.into(), share: share.into(), run, theirs: theirs == "1", apart });
    }
    let mut alone = BTreeMap::new();
    for (name, model) in models.iter().step_by(if quick { 9 } else { 1 }) {
        alone.insert(name.clone(), straight_edges(model)?);
    }
    if !quick {
        fs::write(root().join("docs/regress-parts.md"), table(&rows, &alone)?)?;
    }
    let invalid = rows.iter().filter(|r| r.run.outcome.is_err()).count();
    let folded: usize = alone.values().map(|s| s.folded.len() + s.refused).sum();
    println!(
        "regress: {} blends of parts, {} at full radius, {invalid} without a result; of {} straight edges alone {folded} folded or refused",
        rows.len(),
        rows.iter().filter(|r| r.run.is_full()).count(),
        alone.values().map(|s| s.edges).sum::<usize>(),
    );
    Ok(invalid + folded)
}

/// Points of a `.npy` file of three columns of 32-bit numbers in rows.
fn read_points(bytes: &[u8]) -> Result<Vec<DVec3>, Fault> {
    let wrong = "not an array of float32 in three columns";
    if !bytes.starts_with(b"\x93NUMPY\x01") || bytes.len() < 10 {
        return Err(wrong.into());
    }
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = std::str::from_utf8(bytes.get(10..start).ok_or(wrong)?)?;
    if !header.contains("'<f4'") || !header.contains("'fortran_order': False") || !header.contains(", 3)") {
        return Err(wrong.into());
    }
    let number = |b: &[u8]| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let numbers: Vec<f64> = bytes[start..].chunks_exact(4).map(number).collect();
    Ok(numbers.chunks_exact(3).map(DVec3::from_slice).collect())
}

/// The distance from a mesh that 99% of some points keep.
fn p99(mesh: &TriMesh, points: &[DVec3]) -> Result<f64, Fault> {
    let tree = TriBvh::build(mesh)?;
    let distance = |&p: &DVec3| tree.closest_point(mesh, p).map_or(f64::INFINITY, |c| c.distance);
    let mut distances: Vec<f64> = points.iter().map(distance).collect();
    distances.sort_by(f64::total_cmp);
    let index = (0.99 * distances.len().saturating_sub(1) as f64).round() as usize;
    Ok(distances.get(index).copied().unwrap_or_default())
}

/// Blends every straight edge of a part alone.
fn straight_edges(model: &Model) -> Result<Straight, Fault> {
    let mesh = Connected::new(model.mesh.clone())?;
    let features = features::Params { angle: ANGLE, ..features::Params::default() };
    let before = folds(&mesh);
    let mut found = Straight::default();
    let cosine = STRAIGHT.to_radians().cos();
    for (id, curve) in feature_curves(&mesh, &features).iter().enumerate() {
        let points: Vec<DVec3> = curve.vertices(&mesh).iter().map(|&v| mesh.position(v)).collect();
        let (Some(&a), Some(&b)) = (points.first(), points.last()) else { continue };
        let chord = (b - a).normalize_or_zero();
        if curve.closed || !points.windows(2).all(|w| (w[1] - w[0]).normalize_or_zero().dot(chord) >= cosine) {
            continue;
        }
        found.edges += 1;
        let run = blend(model, ANGLE, Choice { ids: vec![id], ..Choice::default() }, ALONE, LIMIT);
        let Ok((result, _)) = run.outcome else {
            found.refused += 1;
            continue;
        };
        let worst = folds(&Connected::new(result)?).into_iter().filter(|(key, _)| !before.contains_key(key));
        let worst = worst.map(|(_, angle)| angle).fold(0.0, f64::max);
        if worst > FOLD {
            found.folded.push(format!("{id} ({worst:.0}°)"));
        }
    }
    Ok(found)
}

/// Edges folded beyond [`FOLD`], by the bits of their ends, with their dihedral angles in degrees.
fn folds(mesh: &Connected<TriMesh>) -> BTreeMap<[[u64; 3]; 2], f64> {
    let bits = |v: VertexId| mesh.position(v).to_array().map(|x| (x + 0.0).to_bits());
    let fold = |h: HalfedgeId| {
        let twin = mesh.twin(h).filter(|&t| h < t)?;
        let angle = dihedral_angle(mesh, h)?.to_degrees().abs();
        let mut key = [bits(mesh.tail(h)), bits(mesh.tail(twin))];
        key.sort_unstable();
        (angle > FOLD).then_some((key, angle))
    };
    mesh.halfedge_ids().filter_map(fold).collect()
}

fn table(rows: &[Row], alone: &BTreeMap<String, Straight>) -> Result<String, Fault> {
    let mut text = String::from(
        "# CAD parts beside OCCT\n\nWritten by `cargo xtask regress --models DIR`, where `DIR/../cad-parts` (or `--parts`) holds parts exported as STL from exact solids. All \
         edges over 25 degrees, default options; the radius is a share of the box's diagonal. *Full* means that every edge is blended and no smaller ball \
         was used; *measured* is the share of the length of all edges along which the blend lies on balls of the radius asked for within 5%. OCCT fillets \
         all edges of the exact solid, where it can; 99% of points on its fillets are nearer to our result than the distance given, in radii.\n\n",
    );
    let count = |test: &dyn Fn(&Row) -> bool| rows.iter().filter(|r| test(r)).count();
    writeln!(
        text,
        "Of {} runs {} give a valid result, {} at full radius; OCCT succeeds in {}, and {} of those are at full radius here.\n",
        rows.len(),
        count(&|r| r.run.outcome.is_ok()),
        count(&|r| r.run.is_full()),
        count(&|r| r.theirs),
        count(&|r| r.theirs && r.run.is_full()),
    )?;
    text += "| part | radius | exit | full | measured | OCCT | distance of OCCT's points, 99% | s | first warning or reason |\n|---|---|---|---|---|---|---|---|---|\n";
    for Row { part, share, run, theirs, apart } in rows {
        let yes = |b: bool| if b { "yes" } else { "no" };
        let measured = run.shares().map_or("-".into(), |s| format!("{:.1}%", 100.0 * s[1]));
        let apart = apart.map_or(String::new(), |d| format!("{d:.3}"));
        writeln!(
            text,
            "| {part} | {share} | {} | {} | {measured} | {} | {apart} | {:.2} | {} |",
            run.exit(),
            yes(run.is_full()),
            yes(*theirs),
            run.seconds,
            run.words(),
        )?;
    }
    let total = |f: &dyn Fn(&Straight) -> usize| alone.values().map(f).sum::<usize>();
    writeln!(
        text,
        "\n## Straight edges alone\n\nEvery straight edge of the parts alone at a radius of {ALONE}: of {} edges {} are refused, and {} leave a fold beyond {FOLD} degrees that \
         the part did not have.\n\n| part | edges | refused | folded (id and dihedral angle) |\n|---|---|---|---|",
        total(&|s| s.edges),
        total(&|s| s.refused),
        total(&|s| s.folded.len()),
    )?;
    for (part, found) in alone.iter().filter(|(_, s)| s.refused + s.folded.len() > 0) {
        writeln!(text, "| {part} | {} | {} | {} |", found.edges, found.refused, found.folded.join(", "))?;
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::shapes;

    #[test]
    fn arrays_of_points_are_read() {
        let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        assert!(read_points(&bytes).unwrap().is_empty());
        bytes.extend([1.0f32, 2.0, 3.0, 4.0, 5.0, 6.5].iter().flat_map(|x| x.to_le_bytes()));
        assert_eq!(read_points(&bytes).unwrap(), [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.5)]);
        assert!(read_points(b"NUMPY").is_err());
    }

    /// Each edge of a box alone is rounded without a fold.
    #[test]
    fn edges_of_a_box_are_right() {
        let found = straight_edges(&Model::from(shapes::cuboid(DVec3::splat(4.0)))).unwrap();
        assert_eq!((found.edges, found.refused, found.folded.len()), (12, 0, 0));
    }
}
