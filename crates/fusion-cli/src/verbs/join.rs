//! `union`, `difference` and `intersection`, with or without a blended seam.

use crate::args::Join as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::verbs::blend::print_limit;
use fusion::{Error, Operation, join};
use mesh_io::Format;

/// Joins the inputs and writes the result, or tells how large a ball along the seams may be.
pub fn run(session: &Session, args: &Args, operation: Operation) -> Result<(), Failure> {
    if args.radius.is_none() && args.rolling.profile.is_some() {
        return Err(Failure::usage("--profile needs --radius R"));
    }
    let chooses = !args.choosing.near.is_empty() || args.choosing.longer.is_some();
    if args.radius.is_none() && chooses && !args.limit.max_radius {
        return Err(Failure::usage("--near and --longer choose seams to blend: they need --radius R or --max-radius"));
    }
    let destination = args.target.target().map(|t| Destination::check(&t, session)).transpose()?;
    args.rolling.prepare()?;
    let models = session.read_all(&args.inputs, &args.source)?;
    let diagonal = joint_diagonal(&models);
    let seams = join::SeamChoice {
        near: args.choosing.near.clone(),
        longer: args.choosing.longer.map(|l| l.resolve(diagonal)),
    };
    let Some(destination) = destination else {
        let params = join::Params { operation, blend: None, seams, format: Format::Obj };
        let limit = join::max_radius(&models, &params, session.watch()).map_err(|e| explain(&e, args))?;
        return print_limit(&limit, args.limit.json);
    };
    let blend = args.radius.map(|r| args.rolling.with_radius(r.resolve(diagonal), diagonal)).transpose()?;
    let params = join::Params { operation, blend, seams, format: destination.format };
    let sketch = params.blend.as_ref().map(|b| b.sketch.clone()).unwrap_or_default();
    let outcome = join(&models, &params, session.watch()).map_err(|e| explain(&e, args));
    let mut outcome = args.rolling.keep_drawings(&sketch, outcome)?;
    let report = &mut outcome.report;
    report.command = match operation {
        Operation::Union => "union",
        Operation::Difference => "difference",
        Operation::Intersection => "intersection",
    }
    .into();
    report.inputs = counts(&args.inputs, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// The library counts parts; the user knows files.
fn explain(error: &Error, args: &Args) -> Failure {
    let mut text = error.to_string();
    let two = args.inputs.len() == 2;
    for (i, path) in args.inputs.iter().enumerate() {
        if two || matches!(error, Error::NotManifold { .. }) {
            text = text.replace(&format!("part {i} "), &format!("{} ", path.display()));
        }
        text = text.replace(&format!("solid {i} "), &format!("{} ", path.display()));
    }
    Failure::of(error, text)
}
