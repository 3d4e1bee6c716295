//! What the tests of all doors share: whether they must run, where builds are, how long they may take.

use crate::Fault;
use mesh_core::Stopwatch;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::Duration;

/// Set by who wants a failure where the tools of a door are missing: names of doors, divided by commas.
const INSISTS: &str = "FUSION_CI_REQUIRE";

/// Whether a door must be tested.
pub fn insisted(door: &str) -> bool {
    std::env::var(INSISTS).is_ok_and(|names| names.split(',').any(|name| name.trim() == door))
}

/// Says that there was nothing to do, or fails if that was insisted on.
pub fn absent(door: &str, why: &str) -> Result<(), Fault> {
    if insisted(door) {
        return Err(format!("{why}, and {INSISTS} asks for {door}").into());
    }
    println!("ci: skipped {door}: {why}");
    Ok(())
}

/// The folder of builds.
pub fn target() -> Result<PathBuf, Fault> {
    // This program is in the folder of a profile.
    let program = std::env::current_exe()?;
    let target = program.ancestors().nth(2);
    Ok(target.ok_or("no folder of builds")?.to_path_buf())
}

/// The folder of the profile's builds.
pub fn target_profile(target: &Path) -> PathBuf {
    target.join(if cfg!(debug_assertions) { "debug" } else { "release" })
}

/// Whether a program succeeds; an error if it takes longer than `limit`, when it is ended.
pub fn succeeds_in_time(program: &mut Command, limit: Duration) -> Result<bool, Fault> {
    let (start, mut child) = (Stopwatch::start(), program.spawn()?);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status.success());
        }
        if start.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Err(format!("{} took more than {} s", program.get_program().display(), limit.as_secs()).into());
        }
        thread::sleep(Duration::from_millis(100));
    }
}
