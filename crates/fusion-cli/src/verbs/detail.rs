//! `detail`: a region gets the geometry detail of others.

use crate::failure::Failure;
use crate::options::{Read, unread, wrong};
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::detail::detail;
use fusion::operation::{Detail, Options, point};
use std::ffi::OsString;
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct DetailArgs {
    /// The mesh with the region that gets detail
    input: PathBuf,
    #[command(flatten)]
    output: Target,
    #[command(flatten)]
    from: Source,
    #[command(flatten)]
    detail: Detail,
}

/// Reads the input and the sources' files, transfers, and writes the result.
pub fn run(session: &Session, mut args: DetailArgs) -> Result<(), Failure> {
    args.detail.validate().map_err(|e| wrong(&e))?;
    if args.detail.target().part.is_some() {
        return Err(Failure::usage("--target is a region of the input"));
    }
    let destination = Destination::check(&args.output, session)?;
    args.detail.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let mut paths = vec![args.input.clone()];
    for path in args.detail.source.iter().filter_map(|s| s.part.as_ref()).map(PathBuf::from) {
        if !paths.contains(&path) {
            paths.push(path);
        }
    }
    let models = session.read_all(&paths, &args.from)?;
    let place =
        |part: Option<&str>| part.map_or(0, |part| paths.iter().position(|p| p.as_os_str() == part).unwrap_or(0));
    let params = args.detail.params(joint_diagonal(&models[..1]), destination.format, place).map_err(|e| wrong(&e))?;
    let mut outcome = detail(&models, &params, session.watch()).map_err(|e| Failure::of_files(&e, &paths))?;
    outcome.report.inputs = counts(&paths, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// Gathers the points after `--along` and `--source-along` into one argument each: a point may begin with a minus, as an option does.
pub fn with_curves(arguments: Vec<OsString>) -> Vec<OsString> {
    let is_point = |a: &OsString| a.to_str().is_some_and(|a| point(a).is_ok());
    let mut out = vec![];
    let mut rest = arguments.into_iter().peekable();
    while let Some(argument) = rest.next() {
        let takes_points = argument == "--along" || argument == "--source-along";
        out.push(argument);
        let mut points = vec![];
        while takes_points && rest.peek().is_some_and(is_point) {
            points.extend(rest.next().and_then(|p| p.into_string().ok()));
        }
        if !points.is_empty() {
            out.push(points.join(" ").into());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_gathered() {
        let typed = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        let found = with_curves(typed("detail a --along -1,0,0 1,0,0 -o b"));
        assert_eq!(found, ["detail", "a", "--along", "-1,0,0 1,0,0", "-o", "b"].map(OsString::from));
    }
}
