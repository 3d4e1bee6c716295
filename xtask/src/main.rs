//! Chores of the workspace, run as `cargo xtask CHORE`.
//!
//! | file | holds |
//! |---|---|
//! | `ci.rs` | everything a change must pass, in order |
//! | `regress/` | cases against approved records, real models in bulk |
//! | `fixtures.rs`, `models.rs` | the parts of all cases and documents as files |
//! | `collect.rs` | real models from where they come from |
//! | `bench.rs` | benchmarks into a page |
//! | `pages.rs`, `generated.rs` | parts of pages, and whole files, that are generated |
//! | `python.rs`, `python_types.rs` | the Python functions of all operations |
//! | `doors.rs` | what the tests of all doors share |
//! | `python_tests.rs` | the Python module, built and tested |
//! | `blender.rs`, `blender_options.rs` | the Blender extension: its zip, its tests, its options |
//! | `studio.rs` | the studio's page, built, and driven in a browser |
//! | `circles.rs` | files that import each other |
//! | `tidy.rs` | crate arrows, file lengths, citations, paths, pages that are stale |

mod bench;
mod blender;
mod blender_options;
mod ci;
mod circles;
mod collect;
mod doors;
mod fixtures;
mod generated;
mod models;
mod pages;
mod python;
mod python_tests;
mod python_types;
mod regress;
mod studio;
mod tidy;

use clap::{Parser, Subcommand};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// What stopped a chore, as one sentence.
type Fault = Box<dyn std::error::Error>;

#[derive(Parser)]
#[command(about = "Chores of the fusion workspace")]
struct Cli {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Everything a change must pass: format, lints, tests, tidy, regress
    Ci,
    /// Runs the benchmarks, or the same jobs through peers, and renews docs/benchmarks.md
    Bench(bench::Options),
    /// Writes the options of the Blender extension and packs it, or tests it
    Blender(blender::Options),
    /// Writes the parts of all regression cases as files
    Fixtures(fixtures::Options),
    /// Collects the real models behind the tables in docs/ into a folder, and checks that they are the ones measured
    Models(collect::Options),
    /// Writes the Python functions of all operations
    Python,
    /// Writes the keys of documents into docs/documents.md
    Reference,
    /// Runs the cases of fixtures/ against their approved records; with --models also real models
    Regress(regress::Options),
    /// Builds the studio's page into target/studio
    Studio,
    /// Checks crate arrows, file lengths, citations, paths and the reference of documents
    Tidy,
}

fn main() -> ExitCode {
    let result = match Cli::parse().chore {
        Chore::Ci => ci::run(),
        Chore::Bench(options) => bench::run(&options),
        Chore::Blender(options) => blender::run(&options),
        Chore::Fixtures(options) => fixtures::run(&options),
        Chore::Models(options) => collect::run(&options),
        Chore::Python => python::FUNCTIONS.write(),
        Chore::Reference => pages::DOCUMENTS.renew(&fusion::document::reference()),
        Chore::Regress(options) => regress::run(&options),
        Chore::Studio => studio::build(),
        Chore::Tidy => tidy::run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("error: {fault}");
            ExitCode::FAILURE
        }
    }
}

/// The root of the workspace: the folder above this crate's.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf).unwrap_or_default()
}

/// The build of a program of this workspace that belongs to the running one, made if need be.
fn binary(name: &str) -> Result<PathBuf, Fault> {
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    // Together with this program it has the features that are built already.
    let build = ["build", "--quiet", "--profile", profile, "-p", "xtask", "-p", name];
    let status = Command::new(env!("CARGO")).args(build).current_dir(root()).status()?;
    if !status.success() {
        return Err(format!("{name} does not build").into());
    }
    // This program was put into the same folder by the same build.
    let program = std::env::current_exe()?.with_file_name(name).with_extension(std::env::consts::EXE_EXTENSION);
    Ok(program)
}

/// Every file below a folder, in order of name.
fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            if path.file_name().is_none_or(|n| n != "target" && n != "node_modules") {
                walk(&path, files);
            }
        } else {
            files.push(path);
        }
    }
}
