//! Arguments that verbs share.

use crate::length::seconds;
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;

/// Options of every verb.
#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag that can be typed")]
pub struct Common {
    /// Write a machine-readable report of the job (docs/report.md lists its keys)
    #[arg(long, value_name = "FILE.json", global = true, hide_short_help = true, help_heading = "Common options")]
    pub report: Option<PathBuf>,
    /// Use this many threads; the result is the same for any number
    #[arg(long, value_name = "N", global = true, hide_short_help = true, help_heading = "Common options",
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Show no progress: neither a bar on a terminal nor a line every five seconds elsewhere
    #[arg(long, global = true, hide_short_help = true, help_heading = "Common options")]
    pub no_progress: bool,
    /// Say nothing but errors
    #[arg(
        short,
        long,
        global = true,
        hide_short_help = true,
        conflicts_with = "verbose",
        help_heading = "Common options"
    )]
    pub quiet: bool,
    /// Say what was chosen, what each stage did and how long it took
    #[arg(short, long, global = true, hide_short_help = true, help_heading = "Common options")]
    pub verbose: bool,
    /// Count any warning as a failure: exit code 4, and no output
    #[arg(long, global = true, hide_short_help = true, help_heading = "Common options")]
    pub strict: bool,
    /// Stop with exit code 4 after this many seconds
    #[arg(long, value_name = "S", global = true, hide_short_help = true, help_heading = "Common options", value_parser = seconds)]
    pub time_limit: Option<Duration>,
}

/// How standard input is read.
#[derive(Args)]
pub struct Source {
    /// Read inputs as this format (obj, stl, ply, off, glb, gltf, 3mf), whatever their extension; needed for `-`
    #[arg(long, hide_short_help = true, value_name = "FORMAT")]
    pub from: Option<String>,
}

/// Where a mesh goes.
#[derive(Args)]
pub struct Target {
    /// Write the result here, or to standard output for `-`
    #[arg(short, long, value_name = "OUTPUT")]
    pub output: PathBuf,
    /// Format of the output, where its extension does not tell; needed for `-`
    #[arg(long, hide_short_help = true, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Write where every vertex and face of the result came from, as JSON
    #[arg(long, hide_short_help = true, value_name = "FILE.json")]
    pub origins: Option<PathBuf>,
}

/// Where a mesh goes, if one is made.
#[derive(Args)]
pub struct OptionalTarget {
    /// Write the result here, or to standard output for `-`
    #[arg(short, long, value_name = "OUTPUT", required_unless_present = "max_radius")]
    pub output: Option<PathBuf>,
    /// Format of the output, where its extension does not tell; needed for `-`
    #[arg(long, hide_short_help = true, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Write where every vertex and face of the result came from, as JSON
    #[arg(long, hide_short_help = true, value_name = "FILE.json")]
    pub origins: Option<PathBuf>,
}

impl OptionalTarget {
    /// The target, if there is an output.
    pub fn target(&self) -> Option<Target> {
        let output = self.output.clone()?;
        Some(Target { output, to: self.to.clone(), origins: self.origins.clone() })
    }
}

/// A question for the largest radius.
#[derive(Args)]
pub struct MaxRadius {
    /// Print the largest radius with which the curves can be blended, and what is in the way of a larger one; write nothing
    #[arg(long, conflicts_with_all = ["radius", "output"])]
    pub max_radius: bool,
    /// Print JSON instead of a sentence, with --max-radius
    #[arg(long, requires = "max_radius")]
    pub json: bool,
}
