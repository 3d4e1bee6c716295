//! Builds the Python module with the build of the tests, and runs its tests in an environment of its own.

use crate::doors::{absent, insisted, succeeds_in_time, target, target_profile};
use crate::{Fault, root};
use mesh_core::Stopwatch;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX, EXE_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// What the tests need besides NumPy; only pytest must be there.
const PACKAGES: [&str; 6] = ["numpy", "pytest", "trimesh", "pyvista", "mypy", "pyright"];
/// The tests are ended, as failed, after this long.
const LIMIT: Duration = Duration::from_secs(600);

/// Jobs of the test on a Ray cluster: enough for a node to die among them, few enough for half a minute.
const JOBS: &str = "60";

/// Builds and tests the module, or says why not.
pub fn run() -> Result<(), Fault> {
    let start = Stopwatch::start();
    let Some(python) = interpreter() else { return absent("python", "Python 3.9 or later is not installed") };
    let target = target()?;
    let Some(python) = environment(&python, &target.join("python"))? else {
        return absent("python", "an environment with NumPy and pytest cannot be made");
    };
    if !has_ray(&python)? {
        println!("ci: skipped the test on a Ray cluster: Ray is not in {}", python.display());
    }
    let module = build(&target)?;
    let site = install(&python, &module, &target.join("python"))?;
    // Errors of the tests are to be seen with everything they print.
    let mut tests = Command::new(&python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "--durations=5"]).arg(crate_folder().join("tests"));
    tests.env("PYTHONPATH", &site).env("PYTHONDONTWRITEBYTECODE", "1").current_dir(crate_folder());
    let program = module.with_file_name(format!("fusion-cli{EXE_SUFFIX}"));
    tests.env("FUSION_CLI", program).env("JOBS", JOBS);
    if !succeeds_in_time(&mut tests, LIMIT)? {
        return Err("the tests of the Python module failed".into());
    }
    println!("ci: python: {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Whether the environment has Ray, which is installed only where that is insisted on: it takes 600 MB.
fn has_ray(python: &Path) -> Result<bool, Fault> {
    let there = || Command::new(python).args(["-c", "import ray, pyarrow"]).output().is_ok_and(|o| o.status.success());
    if there() || !insisted("ray") {
        return Ok(there());
    }
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "ray[data]"];
    let installed = Command::new(python).args(pip).status()?.success() && there();
    if installed { Ok(true) } else { absent("ray", "Ray cannot be installed").map(|()| false) }
}

/// A Python that is recent enough.
pub fn interpreter() -> Option<PathBuf> {
    let recent = "import sys; sys.exit(sys.version_info < (3, 9))";
    let works = |name: &&str| Command::new(name).args(["-c", recent]).output().is_ok_and(|o| o.status.success());
    ["python3", "python"].iter().find(|name| works(name)).map(PathBuf::from)
}

/// The interpreter of an environment with what the tests need; `None` if it cannot be made.
fn environment(python: &Path, folder: &Path) -> Result<Option<PathBuf>, Fault> {
    let own = if cfg!(windows) { folder.join("Scripts/python.exe") } else { folder.join("bin/python") };
    let has = |names: &str| {
        let import = format!("import {names}");
        Command::new(&own).args(["-c", &import]).output().is_ok_and(|o| o.status.success())
    };
    if !has(&PACKAGES.join(", ")) {
        println!("ci: python -m venv {}", folder.display());
        fs::create_dir_all(folder)?;
        let made = Command::new(python).args(["-m", "venv"]).arg(folder).status()?;
        if !made.success() {
            return Ok(None);
        }
        let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
        // Together where that works, else what there is.
        if !Command::new(&own).args(pip).args(PACKAGES).status()?.success() {
            for package in PACKAGES {
                let _ = Command::new(&own).args(pip).arg(package).status()?;
            }
        }
    }
    Ok(has("numpy, pytest").then_some(own))
}

/// Builds the module; with this program it has the features that are built already.
pub fn build(target: &Path) -> Result<PathBuf, Fault> {
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    let packages = ["-p", "xtask", "-p", "fusion-python", "--features", "fusion-python/extension"];
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--quiet", "--profile", profile]).args(packages).current_dir(root());
    if !build.status()?.success() {
        return Err("the Python module does not build".into());
    }
    Ok(target_profile(target).join(format!("{DLL_PREFIX}fusion_python{DLL_SUFFIX}")))
}

/// Packs a wheel and installs it into a folder of its own.
fn install(python: &Path, module: &Path, environment: &Path) -> Result<PathBuf, Fault> {
    let site = emptied(environment.join("package"))?;
    let wheel = packed(python, module, environment)?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-index", "--target"];
    if !Command::new(python).args(pip).arg(&site).arg(wheel).status()?.success() {
        return Err("the wheel cannot be installed".into());
    }
    Ok(site)
}

/// A wheel of a module that is built already.
pub fn packed(python: &Path, module: &Path, environment: &Path) -> Result<PathBuf, Fault> {
    let folder = emptied(environment.join("wheel"))?;
    let project: toml::Table = fs::read_to_string(crate_folder().join("pyproject.toml"))?.parse()?;
    let about = folder.join("project.json");
    fs::write(&about, serde_json::to_string(&project["project"])?)?;
    let package = crate_folder().join("python/fusion_mesh");
    let mut pack = Command::new(python);
    pack.arg(root().join("xtask/wheel.py")).arg(module).arg(package).arg(about);
    let made = pack.arg(env!("CARGO_PKG_VERSION")).arg(&folder).output()?;
    if !made.status.success() {
        return Err(format!("the wheel cannot be packed: {}", String::from_utf8_lossy(&made.stderr)).into());
    }
    Ok(String::from_utf8(made.stdout)?.trim().into())
}

/// A folder with nothing in it.
fn emptied(folder: PathBuf) -> Result<PathBuf, Fault> {
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

fn crate_folder() -> PathBuf {
    root().join("crates/fusion-python")
}
