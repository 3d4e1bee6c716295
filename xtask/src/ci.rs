//! Everything a change must pass, in order of how fast it fails.

use crate::{Fault, blender, python_tests, regress, root, studio, tidy};
use mesh_core::Stopwatch;
use std::process::Command;

/// Runs every check and stops at the first that fails.
pub fn run() -> Result<(), Fault> {
    let start = Stopwatch::start();
    tidy::run()?;
    if installed("fmt") {
        cargo(&["fmt", "--all", "--check"])?;
    }
    if installed("clippy") {
        // The Python module as well; the tests below build without it.
        let module = "fusion-python/extension";
        cargo(&["clippy", "--workspace", "--all-targets", "--features", module, "--", "-D", "warnings"])?;
    }
    cargo(&["test", "--workspace"])?;
    python_tests::run()?;
    blender::test()?;
    studio::test()?;
    // Packs every crate as it would be published, without building it again.
    cargo(&["package", "--workspace", "--exclude", "xtask", "--no-verify", "--allow-dirty", "--quiet"])?;
    regress::run(&regress::Options::default())?;
    println!("ci: all passed in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Whether a component of the toolchain is there; a minimal installation lacks some.
fn installed(component: &str) -> bool {
    let found = Command::new(env!("CARGO")).args([component, "--version"]).output().is_ok_and(|o| o.status.success());
    if !found {
        println!("ci: skipped {component}, which is not installed (rustup component add {component})");
    }
    found
}

fn cargo(arguments: &[&str]) -> Result<(), Fault> {
    let line = arguments.join(" ");
    println!("ci: cargo {line}");
    let start = Stopwatch::start();
    // A change must not fail by what another day's cases found: the workflow's `seeds` job draws new ones every week.
    let seed = std::env::var("PROPTEST_RNG_SEED").unwrap_or_else(|_| "1".into());
    let mut command = Command::new(env!("CARGO"));
    let status = command.args(arguments).env("PROPTEST_RNG_SEED", seed).current_dir(root()).status()?;
    println!("ci: cargo {line}: {:.0} s", start.elapsed().as_secs_f64());
    if status.success() { Ok(()) } else { Err(format!("cargo {line} failed").into()) }
}
