//! The test of jobs on a Ray cluster, where there is a Python with Ray.

use crate::{Fault, root};
use std::path::PathBuf;
use std::process::Command;

/// Jobs of the test: enough for a node to die among them, few enough for half a minute.
const JOBS: &str = "60";

/// Runs the test against the built program; says so where it cannot.
pub fn run() -> Result<(), Fault> {
    let Some(python) = python() else {
        println!("ci: skipped the test on a Ray cluster: no Python with fusion-mesh and ray (pip install \"ray[data]\")");
        return Ok(());
    };
    let built = Command::new(env!("CARGO")).args(["build", "-p", "fusion-cli"]).current_dir(root()).status()?;
    if !built.success() {
        return Err("fusion-cli cannot be built".into());
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let program = target.join("debug/fusion-cli").with_extension(std::env::consts::EXE_EXTENSION);
    let tests = root().join("crates/fusion-python/tests/test_ray.py");
    println!("ci: {} {}", python.display(), tests.display());
    let status = Command::new(python).arg(tests).env("FUSION_CLI", program).env("JOBS", JOBS).status()?;
    if status.success() { Ok(()) } else { Err("the test on a Ray cluster failed".into()) }
}

/// `FUSION_PYTHON`, or the usual name, if Ray is there.
fn python() -> Option<PathBuf> {
    let named = std::env::var_os("FUSION_PYTHON").map(PathBuf::from);
    let has_ray = |python: &PathBuf| {
        Command::new(python).args(["-c", "import fusion_mesh, ray, pyarrow"]).output().is_ok_and(|o| o.status.success())
    };
    named.into_iter().chain([PathBuf::from("python3")]).find(has_ray)
}
