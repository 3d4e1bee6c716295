//! Broken files through the command line: whatever they hold, no panic, no hang, a valid result or a sentence and no file.

use crate::{Fault, binary};
use mesh_core::{Stopwatch, TriMesh, validate};
use std::fmt::Write;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// These take a mesh as it is, whatever its defects: all of it must come out.
const CONVERT: &str = "convert IN -o out.ply";
const POSE: &str = "pose IN -o out.ply --translate 0,0,1 --rotate 1,2,3,40";

/// What is done with every file, IN, and how many seconds it may take.
const JOBS: [(&str, u64); 17] = [
    ("info IN", 10),
    (CONVERT, 10),
    ("convert IN -o out.ply --weld 0.01% --orient --split", 10),
    ("features IN", 60),
    ("render IN -o out.png --size 64", 10),
    ("union IN block.off -o out.ply", 10),
    ("difference block.off IN -o out.ply --radius 1%", 30),
    (POSE, 10),
    ("cut IN -o out.ply --plane 0,0,0,1,0.2,0.1", 10),
    ("sharpen IN -o out.ply --near 0,0,0", 10),
    ("remesh IN -o out.ply --edge-length 4%", 30),
    ("remesh IN -o out.ply --smooth taubin", 10),
    ("blend IN -o out.ply --radius 1%", 60),
    ("compose IN -o out.ply", 300),
    ("detail IN -o out.ply --target near=0,0,0,0.3 --source near=1,0,0,0.5", 30),
    ("cluster IN -o out.ply", 300),
    ("run job.toml", 10),
];

/// With `--quick`, a file goes through every so many of the jobs that end within `SHORT` seconds, the next one beginning with the next.
const QUICK: usize = 4;
const SHORT: u64 = 10;

/// Runs every file of a folder through every verb and counts the faults.
pub fn run(folder: &Path, quick: bool) -> Result<usize, Fault> {
    let program = binary("fusion-cli")?;
    let bench = tempfile::tempdir()?;
    fs::write(bench.path().join("block.off"), BLOCK)?;
    let mut files = vec![];
    crate::walk(folder, &mut files);
    let mut slowest = [Duration::ZERO; JOBS.len()];
    let stride = if quick { QUICK } else { 1 };
    let (mut faults, mut accepted, mut runs) = (0, 0, 0);
    for (number, file) in files.iter().enumerate() {
        let file = file.canonicalize()?;
        fs::write(bench.path().join("job.toml"), document(&file)?)?;
        let before = listed(bench.path())?;
        let jobs = JOBS.into_iter().zip(&mut slowest).filter(|((_, seconds), _)| !quick || *seconds <= SHORT);
        for ((line, seconds), slowest) in jobs.skip(number % stride).step_by(stride) {
            runs += 1;
            let start = Stopwatch::start();
            let words = line.split(' ').map(|w| if w == "IN" { file.as_os_str() } else { w.as_ref() });
            let mut command = Command::new(&program);
            let said = tempfile::NamedTempFile::new()?;
            command.args(words).current_dir(bench.path()).stderr(said.reopen()?);
            let verdict = watch(&mut command, Duration::from_secs(seconds))?;
            *slowest = start.elapsed().max(*slowest);
            let left: Vec<PathBuf> = listed(bench.path())?.into_iter().filter(|p| !before.contains(p)).collect();
            let fault = match verdict {
                None => Some(format!("took over {seconds} s")),
                Some(0) => unsound(line, &file, &bench.path().join("out.ply")),
                Some(3..=5) if !left.is_empty() => Some(format!("failed but left {}", left[0].display())),
                Some(3..=5) => unsaid(said.reopen()?)?,
                Some(code) => Some(format!("ended with code {code}")),
            };
            accepted += usize::from(verdict == Some(0));
            if let Some(fault) = fault {
                println!("regress: {} on {}: {fault}", line.replace("IN ", ""), file.display());
                faults += 1;
            }
            for path in left {
                fs::remove_file(path)?;
            }
        }
    }
    println!("regress: {} broken files, {accepted} of {runs} runs accepted, {faults} faults", files.len());
    for ((line, _), slowest) in JOBS.into_iter().zip(slowest) {
        println!("regress: {line}: {:.1} s at most", slowest.as_secs_f64());
    }
    Ok(faults)
}

fn listed(folder: &Path) -> Result<Vec<PathBuf>, Fault> {
    Ok(fs::read_dir(folder)?.flatten().map(|e| e.path()).collect())
}

/// What is wrong with what a job wrote, read back.
fn unsound(line: &str, input: &Path, output: &Path) -> Option<String> {
    if !line.contains("out.ply") && !line.starts_with("run") {
        return None;
    }
    let made = match mesh_io::read(output) {
        Ok(made) => made.mesh,
        Err(error) => return Some(format!("wrote what cannot be read: {error}")),
    };
    if [CONVERT, POSE].contains(&line) {
        let bits = |m: &TriMesh| -> Vec<_> { m.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect() };
        let taken = mesh_io::read(input).map(|m| m.mesh);
        // Polygons are written as such, and reading may split them along other diagonals once they are turned.
        let turned = |taken: &TriMesh| {
            let counts = |m: &TriMesh| (m.positions.len(), m.faces.len());
            line == POSE && counts(&made) == counts(taken) && made.positions.iter().all(|p| p.is_finite())
        };
        let same = |taken: TriMesh| turned(&taken) || made.faces == taken.faces && bits(&made) == bits(&taken);
        let faithful = taken.is_ok_and(same);
        return (!faithful).then(|| "is not faithful".into());
    }
    let defects = validate(&made);
    let sound = defects.is_manifold() && defects.non_finite.is_empty();
    (!sound).then(|| format!("wrote what is not valid: {defects}"))
}

/// A failure must be explained.
fn unsaid(said: File) -> Result<Option<String>, Fault> {
    let text = std::io::read_to_string(said)?;
    Ok((!text.contains("error: ") || text.len() < 25).then(|| format!("failed with no more than {text:?}")))
}

/// The exit code, −1 for a signal, `None` when it took too long and was stopped.
fn watch(command: &mut Command, patience: Duration) -> Result<Option<i32>, Fault> {
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).spawn()?;
    let start = Stopwatch::start();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status.code().unwrap_or(-1)));
        }
        if start.elapsed() > patience {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// A document that joins the file to the block.
fn document(file: &Path) -> Result<String, Fault> {
    let mut text = String::from("version = 2\n");
    for (name, mesh) in [("file", file), ("block", Path::new("block.off"))] {
        writeln!(text, "[[part]]\nname = {name:?}\nmesh = {:?}", mesh.to_string_lossy())?;
    }
    text.push_str("[[step]]\ndo = \"union\"\n[[output]]\nfile = \"out.ply\"\n");
    Ok(text)
}

/// A unit cube.
const BLOCK: &str = "OFF\n8 12 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n\
3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n";
