//! Results checked by another library: files for `reference.py`, and its verdicts.

use crate::{Fault, root};
use mesh_core::TriMesh;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
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
        let output = Command::new(python()?).arg(script).args(waiting.iter().map(|(_, path)| path)).output()?;
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

/// Python with the packages of `xtask/requirements.txt`, in an environment of its own that is made if need be.
pub fn python() -> Result<PathBuf, Fault> {
    let folder = root().join("target/regress/python");
    let program = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let wanted = root().join("xtask/requirements.txt");
    let installed = folder.join("requirements.txt");
    if fs::read(&installed).ok() != Some(fs::read(&wanted)?) {
        println!("regress: installing {} into {}", wanted.display(), folder.display());
        let run = |program: &Path, arguments: &[&Path]| match Command::new(program).args(arguments).status() {
            Ok(status) if status.success() => Ok(()),
            other => Err(format!("{} {arguments:?} failed: {other:?}", program.display())),
        };
        run("python3".as_ref(), &["-m".as_ref(), "venv".as_ref(), &folder])?;
        run(
            &program,
            &["-m", "pip", "install", "--quiet", "--requirement"]
                .map(Path::new)
                .into_iter()
                .chain([&*wanted])
                .collect::<Vec<_>>(),
        )?;
        fs::copy(&wanted, &installed)?;
    }
    Ok(program)
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
