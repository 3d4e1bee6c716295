//! Runs the benchmarks and puts their times into docs/benchmarks.md.

use crate::pages::Part;
use crate::{Fault, root, walk};
use clap::Args;
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

const TABLE: Part = on_page(["<!-- table: written by cargo xtask bench -->", "<!-- end of table -->"]);
const SCALING: Part = on_page(["<!-- scaling: written by cargo xtask bench --scaling -->", "<!-- end of scaling -->"]);
const PEERS: Part = on_page(["<!-- peers: written by cargo xtask bench --peers -->", "<!-- end of peers -->"]);

const fn on_page(marks: [&'static str; 2]) -> Part {
    Part { page: "docs/benchmarks.md", marks }
}

/// What to run.
#[derive(Args)]
pub struct Options {
    /// Run the same jobs through this program and through the Python packages that are there, instead of the benchmarks
    #[arg(long)]
    peers: bool,
    /// Measure time and memory against size instead, and draw both into docs/images
    #[arg(long, conflicts_with = "peers")]
    scaling: bool,
}

/// Runs `cargo bench`, or a script, and renews its table.
pub fn run(options: &Options) -> Result<(), Fault> {
    let program = |name: &str| root().join("target/release").join(name).with_extension(std::env::consts::EXE_EXTENSION);
    if options.peers {
        build(&["-p", "fusion-cli"])?;
        build(&["-p", "rbf-solve", "--example", "fit"])?;
        build(&["-p", "fusion", "--example", "stage"])?;
        let programs = [program("fusion-cli"), program("examples/fit"), program("examples/stage")];
        PEERS.renew(&script("peers.py", &programs)?)
    } else if options.scaling {
        build(&["-p", "fusion-cli"])?;
        build(&["-p", "rbf-solve", "--example", "fit"])?;
        let programs = [program("fusion-cli"), program("examples/fit"), root().join("docs/images")];
        SCALING.renew(&script("scaling.py", &programs)?)
    } else {
        benchmarks()
    }
}

fn build(what: &[&str]) -> Result<(), Fault> {
    let built = Command::new(env!("CARGO")).args(["build", "--release"]).args(what).current_dir(root()).status()?;
    if built.success() { Ok(()) } else { Err(format!("cargo build {} failed", what.join(" ")).into()) }
}

/// What a script of this folder prints.
fn script(name: &str, arguments: &[PathBuf]) -> Result<String, Fault> {
    let output = Command::new("python3")
        .arg(root().join("xtask").join(name))
        .args(arguments)
        .stderr(Stdio::inherit())
        .output()?;
    if !output.status.success() {
        return Err(format!("{name} failed").into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

fn benchmarks() -> Result<(), Fault> {
    if !Command::new(env!("CARGO")).args(["bench", "--workspace", "--benches"]).current_dir(root()).status()?.success()
    {
        return Err("a benchmark failed".into());
    }
    TABLE.renew(&table()?)
}

/// One row per benchmark, in order of name.
fn table() -> Result<String, Fault> {
    let mut files = vec![];
    walk(&root().join("target/criterion"), &mut files);
    let mut rows = vec![];
    for file in files.iter().filter(|f| f.ends_with("new/estimates.json")) {
        let read = |path| -> Result<Value, Fault> { Ok(serde_json::from_str(&fs::read_to_string(path)?)?) };
        let (name, estimates) = (read(file.with_file_name("benchmark.json"))?, read(file.clone())?);
        let nanoseconds = estimates["median"]["point_estimate"].as_f64().unwrap_or(f64::NAN);
        rows.push((name["full_id"].as_str().unwrap_or_default().to_string(), nanoseconds));
    }
    rows.sort_by(|a, b| a.0.cmp(&b.0));
    let mut text = String::from("| benchmark | median |\n|---|---|\n");
    for (name, nanoseconds) in rows {
        writeln!(text, "| {name} | {} |", human(nanoseconds))?;
    }
    Ok(text)
}

fn human(nanoseconds: f64) -> String {
    match nanoseconds {
        n if n < 1e3 => format!("{n:.0} ns"),
        n if n < 1e6 => format!("{:.1} µs", n / 1e3),
        n if n < 1e9 => format!("{:.1} ms", n / 1e6),
        n => format!("{:.2} s", n / 1e9),
    }
}
