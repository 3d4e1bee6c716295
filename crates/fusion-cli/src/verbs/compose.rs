//! `compose`: joins openings by a smooth surface.

use crate::composing::Compose as Args;
use crate::failure::{Failure, with_files};
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::compose::{self, compose};
use fusion::{Region, detail};

/// Composes the inputs and writes the result.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let models = session.read_all(&args.inputs, &args.source)?;
    let diagonal = joint_diagonal(&models);
    let params = compose::Params {
        kernel: args.kernel.into(),
        method: args.method.into(),
        rings: args.rings.map(usize::from),
        cell: args.cell,
        edge_length: args.edge_length.map(|l| l.resolve(diagonal)),
        loops: (!args.loops.is_empty()).then(|| args.loops.clone()),
        space: args.space,
        crease: args.crease,
        adjust: args.adjust.map(|l| l.resolve(diagonal)),
        ..compose::Params::new(destination.format)
    };
    let mut outcome = compose(&models, &params, session.watch()).map_err(|e| Failure::of_files(&e, &args.inputs))?;
    if !args.details.is_empty() {
        let sources = args.details.iter().map(|d| Ok((d.part, d.place.resolve(diagonal)?)));
        let params = detail::Params {
            target: Region::Origin(String::new()),
            sources: sources.collect::<Result<_, Failure>>()?,
            transfer: fusion::detail_transfer::Params::default(),
            format: destination.format,
        };
        outcome = detail::onto(outcome, &models, &params, session.watch())
            .map_err(|e| Failure::of_files(&e, &args.inputs))?;
    }
    outcome.report.inputs = counts(&args.inputs, &models);
    for warning in &mut outcome.report.warnings {
        *warning = with_files(warning, &args.inputs);
    }
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
