//! `cut`: takes away what lies beyond a plane or a path over the surface.

use crate::failure::Failure;
use crate::options::wrong;
use crate::session::{Destination, Session, counts};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::cut;
use fusion::operation::{Cut, Options, point};
use std::ffi::OsString;
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct CutArgs {
    /// The mesh to cut, closed or open
    pub input: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    pub cut: Cut,
}

/// Cuts the input and writes what stays.
pub fn run(session: &Session, args: &CutArgs) -> Result<(), Failure> {
    args.cut.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&args.target, session)?;
    let models = [session.read(&args.input, &args.source)?];
    let params = args.cut.params(destination.format).map_err(|e| wrong(&e))?;
    let inputs = std::slice::from_ref(&args.input);
    let mut outcome = cut(&models[0], &params, session.watch()).map_err(|e| Failure::of_files(&e, inputs))?;
    outcome.report.inputs = counts(inputs, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
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
