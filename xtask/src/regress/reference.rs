//! Results checked by another library: files for `reference.py`, and its verdicts.

use crate::{Fault, root};
use mesh_core::TriMesh;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Meshes waiting for a verdict.
pub struct Reference {
    folder: tempfile::TempDir,
    waiting: Vec<(String, PathBuf)>,
}

impl Reference {
    /// An empty queue.
    pub fn new() -> Result<Self, Fault> {
        Ok(Self { folder: tempfile::tempdir()?, waiting: vec![] })
    }

    /// Queues a mesh under a name.
    pub fn add(&mut self, name: &str, mesh: &TriMesh) -> Result<(), Fault> {
        let path = self.folder.path().join(format!("{}.off", self.waiting.len()));
        fs::write(&path, off(mesh)?)?;
        self.waiting.push((name.to_string(), path));
        Ok(())
    }

    /// Each queued mesh with `ok` or what is wrong. Empties the queue.
    pub fn verdicts(&mut self) -> Result<Vec<(String, String)>, Fault> {
        let waiting = std::mem::take(&mut self.waiting);
        if waiting.is_empty() {
            return Ok(vec![]);
        }
        let script = root().join("xtask/reference.py");
        let output = Command::new("python3").arg(script).args(waiting.iter().map(|(_, path)| path)).output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let verdicts: Vec<_> = text.lines().filter_map(|line| line.split_once('\t')).map(|(_, v)| v).collect();
        if verdicts.len() != waiting.len() {
            let complaint = String::from_utf8_lossy(&output.stderr);
            return Err(
                format!("reference.py gave {} verdicts on {}: {complaint}", verdicts.len(), waiting.len()).into()
            );
        }
        Ok(waiting.into_iter().zip(verdicts).map(|((name, _), v)| (name, v.to_string())).collect())
    }
}

/// A mesh as OFF with every digit, written without the crates under test.
fn off(mesh: &TriMesh) -> Result<String, Fault> {
    let mut text = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.faces.len());
    for p in &mesh.positions {
        writeln!(text, "{:?} {:?} {:?}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in &mesh.faces {
        writeln!(text, "3 {a} {b} {c}")?;
    }
    Ok(text)
}
