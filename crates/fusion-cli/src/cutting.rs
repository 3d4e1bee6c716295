//! What can be typed for `cut`.

use crate::args::{Source, Target};
use crate::length::{not_negative, plane, point, snap};
use clap::{Args, ValueEnum};
use glam::DVec3;
use std::ffi::OsString;
use std::path::PathBuf;

#[derive(Args)]
pub struct Cut {
    /// The mesh to cut, closed or open
    pub input: PathBuf,
    #[command(flatten)]
    pub target: Target,
    #[command(flatten)]
    pub source: Source,
    /// A point of the plane and its normal; the side the normal points away from is kept
    #[arg(long, value_name = "PX,PY,PZ,NX,NY,NZ", value_parser = plane, allow_hyphen_values = true)]
    pub plane: Option<(DVec3, DVec3)>,
    /// Cut along a closed path over the surface through these picks, two or more, in concave creases where there are any
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true,
          required_unless_present = "plane", conflicts_with = "plane")]
    pub path: Vec<DVec3>,
    /// Which side of the path stays
    #[arg(long, value_enum, default_value = "larger", requires = "path", conflicts_with = "seed")]
    pub keep: Keep,
    /// How strongly creases attract the path; 0 gives the geodesic
    #[arg(long, value_name = "STRENGTH", default_value_t = 4.0, value_parser = not_negative, requires = "path")]
    pub crease: f64,
    /// With a plane, cut only the contour nearest this point; with a path, keep the side nearest to it
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub seed: Option<DVec3>,
    /// Move crossings onto vertices nearer than this share of an edge, which gives openings without short edges [default: 1e-6; 0.05
    /// for a path]
    #[arg(long, value_name = "SHARE", value_parser = snap)]
    pub snap: Option<f64>,
    /// Rounds by which the rim is made smooth on the surface
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub smooth: u16,
}

/// A side of a path.
#[derive(Clone, Copy, ValueEnum)]
pub enum Keep {
    /// The one with more area
    Larger,
    /// The one with less
    Smaller,
}

/// Repeats `--path` before each of several points.
pub fn spread_path(arguments: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let is_point = |a: &OsString| a.to_str().is_some_and(|a| point(a).is_ok());
    let mut spread: Vec<OsString> = vec![];
    for argument in arguments {
        let n = spread.len();
        if n > 1 && spread[n - 2] == "--path" && is_point(&spread[n - 1]) && is_point(&argument) {
            spread.push("--path".into());
        }
        spread.push(argument);
    }
    spread
}
