//! Results beside those of another build: whether their connectivity is the same, and how far their vertices moved.

use crate::Fault;
use mesh_core::{TriMesh, bounds};
use mesh_io::{Format, Model};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder with the results of another build. A result that it lacks is put there.
pub struct Against {
    folder: PathBuf,
    rows: Vec<(String, Verdict)>,
}

/// How a result compares with that of the other build.
#[derive(Debug, PartialEq)]
enum Verdict {
    /// There was none; this one is kept.
    Kept,
    /// The same bits.
    Same,
    /// The same corners; the largest distance of a vertex, as a share of the diagonal.
    Moved(f64),
    /// Other vertices or corners.
    Reconnected,
    /// The file could not be read or written.
    Failed(String),
}

impl Against {
    /// Compares with the results in `folder`.
    pub fn new(folder: &Path) -> Result<Self, Fault> {
        fs::create_dir_all(folder)?;
        Ok(Self { folder: folder.to_owned(), rows: vec![] })
    }

    /// Compares one result.
    pub fn add(&mut self, name: &str, mesh: &TriMesh) {
        let path = self.folder.join(format!("{name}.ply"));
        let verdict = verdict(&path, mesh).unwrap_or_else(|fault| Verdict::Failed(fault.to_string()));
        self.rows.push((name.to_owned(), verdict));
    }

    /// Lists what differs.
    pub fn finish(self) -> Result<(), Fault> {
        let mut failed = vec![];
        for (name, verdict) in &self.rows {
            match verdict {
                Verdict::Kept => println!("regress: {name}: kept for comparison"),
                Verdict::Same => {}
                Verdict::Moved(share) => {
                    println!("regress: {name}: vertices moved by up to {share:.1e} of the diagonal");
                }
                Verdict::Reconnected => println!("regress: {name}: connectivity changed"),
                Verdict::Failed(reason) => failed.push(format!("{name}: {reason}")),
            }
        }
        let same = self.rows.iter().filter(|(_, verdict)| *verdict == Verdict::Same).count();
        println!("regress: {same} of {} results have the bits of {}", self.rows.len(), self.folder.display());
        if failed.is_empty() { Ok(()) } else { Err(failed.join("; ").into()) }
    }
}

fn verdict(path: &Path, mesh: &TriMesh) -> Result<Verdict, Fault> {
    if !path.exists() {
        let model = Model { mesh: mesh.clone(), ..Model::default() };
        // PLY holds f64 and keeps the order of vertices and faces.
        mesh_io::write_as(&model, path, Format::Ply)?;
        return Ok(Verdict::Kept);
    }
    Ok(compare(mesh, &mesh_io::read(path)?.mesh))
}

fn compare(now: &TriMesh, before: &TriMesh) -> Verdict {
    if now.faces != before.faces || now.positions.len() != before.positions.len() {
        return Verdict::Reconnected;
    }
    let pairs = || now.positions.iter().zip(&before.positions);
    if pairs().all(|(a, b)| a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits)) {
        return Verdict::Same;
    }
    let farthest = pairs().map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    Verdict::Moved(farthest / bounds(before).diagonal())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::shapes;

    #[test]
    fn results_are_kept_first_and_compared_then() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ball.ply");
        let mut ball = shapes::icosphere(1.0, 2);
        assert_eq!(verdict(&path, &ball).unwrap(), Verdict::Kept);
        assert_eq!(verdict(&path, &ball).unwrap(), Verdict::Same);
        ball.positions[3].x += 1e-9;
        let Verdict::Moved(share) = verdict(&path, &ball).unwrap() else { panic!("not moved") };
        assert!((share - 1e-9 / 12f64.sqrt()).abs() < 1e-12, "{share}");
        ball.faces[0].rotate_left(1);
        assert_eq!(verdict(&path, &ball).unwrap(), Verdict::Reconnected);
    }
}
