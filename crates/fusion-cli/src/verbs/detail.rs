//! `detail`: a region gets the geometry detail of others.

use crate::detailing::Detail as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::detail::{self, detail};
use std::path::PathBuf;

/// Reads the input and the sources' files, transfers, and writes the result.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.output, session)?;
    let mut paths = vec![args.input.clone()];
    let index = |path: Option<&PathBuf>, paths: &mut Vec<PathBuf>| match path {
        None => 0,
        Some(path) => paths.iter().position(|p| p == path).unwrap_or_else(|| {
            paths.push(path.clone());
            paths.len() - 1
        }),
    };
    let which: Vec<usize> = args.sources.iter().map(|s| index(s.file.as_ref(), &mut paths)).collect();
    let models = session.read_all(&paths, &args.source)?;
    let diagonal = joint_diagonal(&models[..1]);
    let sources = which.iter().zip(&args.sources).map(|(&i, s)| Ok((i, s.place.resolve(diagonal)?)));
    let params = detail::Params {
        target: args.target.resolve(diagonal)?,
        sources: sources.collect::<Result<_, Failure>>()?,
        transfer: args.how.resolve(diagonal),
        format: destination.format,
    };
    let mut outcome = detail(&models, &params, session.watch()).map_err(|e| Failure::of_files(&e, &paths))?;
    outcome.report.inputs = counts(&paths, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
