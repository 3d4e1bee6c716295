//! Broken files through the command line: whatever they hold, no panic, no hang, no output on failure.

use crate::{Fault, binary};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A verb may take no longer than this on any of the files.
const PATIENCE: Duration = Duration::from_secs(10);

/// Runs every file of a folder through three verbs and counts the faults.
pub fn run(folder: &Path) -> Result<usize, Fault> {
    let program = binary("fusion-cli")?;
    let work = tempfile::tempdir()?;
    let block = work.path().join("block.off");
    fs::write(&block, BLOCK)?;
    let mut files = vec![];
    crate::walk(folder, &mut files);
    let (mut faults, mut accepted) = (0, 0);
    for file in &files {
        let output = work.path().join("out.ply");
        let verbs: [(&str, Vec<&Path>); 3] = [
            ("info", vec![file]),
            ("convert", vec![file, Path::new("-o"), &output]),
            ("union", vec![file, &block, Path::new("-o"), &output]),
        ];
        for (verb, arguments) in verbs {
            let verdict = watch(Command::new(&program).arg(verb).args(arguments))?;
            let left: Vec<PathBuf> =
                fs::read_dir(work.path())?.flatten().map(|e| e.path()).filter(|p| *p != block).collect();
            let fault = match verdict {
                None => Some(format!("took over {} s", PATIENCE.as_secs())),
                Some(0) => None,
                Some(3..=6) if left.is_empty() => None,
                Some(3..=6) => Some(format!("failed but left {}", left[0].display())),
                Some(code) => Some(format!("ended with code {code}")),
            };
            accepted += usize::from(verdict == Some(0));
            if let Some(fault) = fault {
                println!("regress: {verb} {}: {fault}", file.display());
                faults += 1;
            }
            for path in left {
                fs::remove_file(path)?;
            }
        }
    }
    println!("regress: {} broken files, {accepted} of {} runs accepted, {faults} faults", files.len(), 3 * files.len());
    Ok(faults)
}

/// The exit code, −1 for a signal, `None` when it took too long and was stopped.
fn watch(command: &mut Command) -> Result<Option<i32>, Fault> {
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status.code().unwrap_or(-1)));
        }
        if start.elapsed() > PATIENCE {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// A unit cube.
const BLOCK: &str = "OFF\n8 12 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n\
3 0 2 3\n3 0 3 1\n3 4 5 7\n3 4 7 6\n3 0 1 5\n3 0 5 4\n3 2 6 7\n3 2 7 3\n3 0 4 6\n3 0 6 2\n3 1 3 7\n3 1 7 5\n";
