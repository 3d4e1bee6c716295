//! `remesh`: even triangles and smooth surfaces, boundaries and features kept.

use crate::args::Remesh as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::{remesh, remeshing};

/// Smooths and remeshes the input, or a region of it, and writes the result.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let model = session.read(&args.input, &args.source)?;
    let models = std::slice::from_ref(&model);
    let diagonal = joint_diagonal(models);
    let region = args.region.as_ref().map(|place| place.resolve(diagonal)).transpose()?;
    let start = match args.edge_length {
        Some(length) => remeshing::Params::new(length.resolve(diagonal), destination.format),
        None => remeshing::Params::keeping_triangles(destination.format),
    };
    let params = start
        .with_rounds(args.iterations.into())
        .smoothed(args.smooth.map(|way| way.resolve(diagonal)))
        .with_features(args.angle)
        .within(region);
    let mut outcome = remesh(&model, &params, session.watch())
        .map_err(|e| Failure::of_files(&e, std::slice::from_ref(&args.input)))?;
    outcome.report.inputs = counts(std::slice::from_ref(&args.input), models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
