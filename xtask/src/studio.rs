//! Builds the studio's page, and drives it in a browser.

use crate::doors::{absent, succeeds_in_time, target};
use crate::{Fault, binary, root, walk};
use mesh_core::Stopwatch;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Set to a browser of the Chromium family that is not found by name.
const BROWSER: &str = "FUSION_STUDIO_BROWSER";
/// Names under which Chromium is installed.
const BROWSERS: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
/// The oldest Node.js that vite runs on.
const OLDEST_NODE: u32 = 20;
/// The scenarios are stopped after this long.
const TIME_LIMIT: Duration = Duration::from_secs(600);

/// Installs what the page needs, at the versions of its lock file, and bundles it into `target/studio`.
pub fn build() -> Result<(), Fault> {
    let Some(npm) = npm() else {
        return Err(format!("Node.js {OLDEST_NODE} or later with npm is not installed").into());
    };
    install(npm)?;
    run(npm, &["run", "build", "--silent"])?;
    println!("studio: the page is in {}", target()?.join("studio").display());
    Ok(())
}

/// Builds the page and runs its scenarios in a browser, or says why not.
pub fn test() -> Result<(), Fault> {
    let Some(browser) = browser() else { return absent("studio", "no browser of the Chromium family is installed") };
    if npm().is_none() {
        return absent("studio", &format!("Node.js {OLDEST_NODE} or later with npm is not installed"));
    }
    let start = Stopwatch::start();
    build()?;
    let (studio, cli) = (binary("fusion-studio")?, binary("fusion-cli")?);
    let mut tests = Command::new("node");
    tests.args(["--test", "--test-concurrency=1", "--test-reporter=spec"]).args(scenarios()).current_dir(page());
    tests.env("FUSION_STUDIO", studio).env("FUSION_CLI", cli).env(BROWSER, browser);
    tests.env("FUSION_STUDIO_PICTURES", target()?.join("studio-pictures"));
    if !succeeds_in_time(&mut tests, TIME_LIMIT)? {
        return Err("the studio's scenarios failed".into());
    }
    println!("ci: studio: {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The files of scenarios, in order of name.
fn scenarios() -> Vec<PathBuf> {
    let mut files = vec![];
    walk(&page().join("tests"), &mut files);
    files.retain(|file| file.to_string_lossy().ends_with(".test.mjs"));
    files
}

/// Installs the packages if the lock file is newer than what is there.
fn install(npm: &str) -> Result<(), Fault> {
    let changed = |file: &str| page().join(file).metadata().and_then(|m| m.modified()).ok();
    let installed = changed("node_modules/.package-lock.json");
    if installed.is_some() && installed >= changed("package-lock.json") {
        return Ok(());
    }
    run(npm, &["ci", "--no-audit", "--no-fund"])
}

fn run(npm: &str, arguments: &[&str]) -> Result<(), Fault> {
    println!("studio: npm {}", arguments.join(" "));
    let status = Command::new(npm)
        .args(arguments)
        .env("FUSION_STUDIO_BUNDLE", target()?.join("studio"))
        .current_dir(page())
        .status()?;
    if status.success() { Ok(()) } else { Err(format!("npm {} failed", arguments.join(" ")).into()) }
}

/// npm, where a recent enough Node.js is installed.
fn npm() -> Option<&'static str> {
    let version = Command::new("node").arg("--version").output().ok()?;
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    let major: u32 = version.trim().trim_start_matches('v').split('.').next()?.parse().ok()?;
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let works = major >= OLDEST_NODE && Command::new(npm).arg("--version").output().is_ok_and(|o| o.status.success());
    works.then_some(npm)
}

/// A browser of the Chromium family.
fn browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os(BROWSER) {
        return Some(PathBuf::from(named));
    }
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let candidates = BROWSERS.iter().flat_map(|name| folders.iter().map(move |f| f.join(name)));
    let installed = ["/Applications/Google Chrome.app/Contents/MacOS/Google Chrome"];
    candidates.map(|path| with_suffix(&path)).chain(installed.iter().map(PathBuf::from)).find(|path| path.is_file())
}

fn with_suffix(path: &Path) -> PathBuf {
    path.with_extension(std::env::consts::EXE_EXTENSION)
}

fn page() -> PathBuf {
    root().join("crates/fusion-studio/page")
}
