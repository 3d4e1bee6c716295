//! `blend`: rounds feature curves.

use crate::args::Blend as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::{features, round};

/// Blends the chosen curves and writes the result.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let model = session.read(&args.input, &args.source)?;
    let models = std::slice::from_ref(&model);
    let params = round::Params {
        features: features::Params { angle: args.angle, ..features::Params::default() },
        near: args.near.clone(),
        blend: args.rolling.with_radius(args.radius.resolve(joint_diagonal(models)))?,
        format: destination.format,
    };
    let name = args.input.display();
    let mut outcome = round(&model, &params, session.watch())
        .map_err(|e| Failure::of(&e, e.to_string().replace("part 0 ", &format!("{name} "))))?;
    outcome.report.inputs = counts(std::slice::from_ref(&args.input), models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
