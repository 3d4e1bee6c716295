//! The Blender extension: its zip, and its tests in Blender as a Python module.

use crate::doors::{absent, insisted, target, target_profile};
use crate::{Fault, blender_options, python_tests, root};
use clap::Args;
use mesh_core::Stopwatch;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The version of Blender that the tests run in, and what it needs.
const PACKAGES: [&str; 2] = ["bpy==5.0.1", "numpy<2,>=1.26"];
/// Names of interpreters that may be the version that this Blender takes.
const INTERPRETERS: [&str; 2] = ["python3.11", "python3"];

/// What is packed.
#[derive(Args)]
pub struct Options {
    /// Where the zip goes [default: fusion-VERSION.zip in the folder of builds]
    #[arg(short, long, value_name = "ZIP")]
    output: Option<PathBuf>,
    /// The wheel to put in, as maturin makes it; without it one is packed from a build of the profile that xtask has
    #[arg(long, value_name = "FILE")]
    wheel: Option<PathBuf>,
    /// Run its tests instead, as `ci` does
    #[arg(long, conflicts_with_all = ["output", "wheel"])]
    test: bool,
}

/// Writes the options and packs the extension, or tests it.
pub fn run(options: &Options) -> Result<(), Fault> {
    if options.test {
        return test();
    }
    blender_options::OPTIONS.write()?;
    pack(options)
}

fn pack(options: &Options) -> Result<(), Fault> {
    let python = python_tests::interpreter().ok_or("Python 3.9 or later is not installed")?;
    let target = target()?;
    let output = options.output.clone().unwrap_or_else(|| zip(&target));
    let wheel = match &options.wheel {
        Some(wheel) => wheel.clone(),
        None => python_tests::packed(&python, &python_tests::build(&target)?, &target.join("python"))?,
    };
    let mut pack = Command::new(python);
    pack.arg(root().join("xtask/extension.py")).arg(source()).arg(output).arg(wheel);
    if pack.status()?.success() { Ok(()) } else { Err("the extension cannot be packed".into()) }
}

/// Packs the extension and runs its tests, or says why not.
pub fn test() -> Result<(), Fault> {
    let start = Stopwatch::start();
    let target = target()?;
    let Some(python) = blender(&target.join("bpy"))? else {
        return absent("blender", "Blender as a Python module (pip install bpy) is not there");
    };
    pack(&Options { output: None, wheel: None, test: false })?;
    let program = target_profile(&target).join(format!("fusion-cli{}", std::env::consts::EXE_SUFFIX));
    let mut tests = Command::new(python);
    tests.arg(source().join("tests/run.py")).arg(zip(&target)).env("FUSION_CLI", program);
    if !tests.env("PYTHONDONTWRITEBYTECODE", "1").status()?.success() {
        return Err("the tests of the Blender extension failed".into());
    }
    println!("ci: blender: {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// A Python that has Blender: that of an environment of its own, filled only where Blender is insisted on, since it takes 1 GB.
fn blender(folder: &Path) -> Result<Option<PathBuf>, Fault> {
    let own = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let there = || Command::new(&own).args(["-c", "import bpy"]).output().is_ok_and(|o| o.status.success());
    if there() || !insisted("blender") {
        return Ok(there().then_some(own));
    }
    let right = "import sys; sys.exit(sys.version_info[:2] != (3, 11))";
    let works = |name: &&&str| Command::new(name).args(["-c", right]).output().is_ok_and(|o| o.status.success());
    let Some(python) = INTERPRETERS.iter().find(works) else { return Ok(None) };
    println!("ci: {python} -m venv {}", folder.display());
    fs::create_dir_all(folder)?;
    if !Command::new(python).args(["-m", "venv"]).arg(folder).status()?.success() {
        return Ok(None);
    }
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    let _ = Command::new(&own).args(pip).args(PACKAGES).status()?;
    Ok(there().then_some(own))
}

fn source() -> PathBuf {
    root().join("crates/fusion-python/blender")
}

fn zip(target: &Path) -> PathBuf {
    target.join(format!("fusion-{}.zip", env!("CARGO_PKG_VERSION")))
}
