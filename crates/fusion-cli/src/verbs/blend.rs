//! `blend`: rounds feature curves.

use crate::args::Blend as Args;
use crate::failure::Failure;
use crate::output::print;
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::{Error, Outcome, blend, features, round, sharpen};
use mesh_io::{Format, Model};
use serde_json::json;

/// Blends the chosen curves and writes the result, or tells how large a ball may be.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    if args.limit.max_radius {
        if args.rolling.profile.is_some() {
            return Err(Failure::usage("--max-radius is that of an arc; leave out --profile"));
        }
        return limit(session, args);
    }
    let missing = || Failure::usage("`blend` needs --radius R and -o OUTPUT, or --max-radius");
    let target = args.target.target().ok_or_else(missing)?;
    let sharp = args.rolling.is_sharp() && !args.choosing.near.is_empty() && args.choosing.curves.is_none();
    if args.radius.is_none() && args.choosing.own_radius(1.0).is_none() && !sharp {
        return Err(missing());
    }
    let destination = Destination::check(&target, session)?;
    args.rolling.prepare()?;
    let model = session.read(&args.input, &args.source)?;
    let models = std::slice::from_ref(&model);
    let inputs = || counts(std::slice::from_ref(&args.input), models);
    if sharp && let Some(mut outcome) = sharpened(session, args, &model, destination.format)? {
        outcome.report.inputs = inputs();
        return session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report);
    }
    let diagonal = joint_diagonal(models);
    let own = args.choosing.own_radius(diagonal).map(|r| [r; 2]);
    let radius = args.radius.map(|r| r.resolve(diagonal)).or(own).ok_or_else(missing)?;
    let params = round::Params {
        features: features::Params { angle: args.angle, ..features::Params::default() },
        choice: args.choosing.choice(session, diagonal)?,
        blend: args.rolling.with_radius(radius, diagonal)?,
        format: destination.format,
    };
    let outcome = round(&model, &params, session.watch()).map_err(|e| refused(args, &e));
    let mut outcome = args.rolling.keep_drawings(&params.blend.sketch, outcome)?;
    outcome.report.inputs = inputs();
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// The same with the straight chord for a section.
pub fn run_chamfer(session: &Session, mut args: Args) -> Result<(), Failure> {
    if !args.rolling.make_chamfer() {
        return Err(Failure::usage("`chamfer` has its own profile; take `blend` for another"));
    }
    run(session, &args)
}

/// The mesh with its fillets at the picked places taken back. `None` if the first of these is on no fillet and there is a
/// radius, which then means a blend with a sharp section along feature curves.
fn sharpened(session: &Session, args: &Args, model: &Model, format: Format) -> Result<Option<Outcome>, Failure> {
    let diagonal = joint_diagonal(std::slice::from_ref(model));
    let near = args.choosing.places();
    let params = sharpen::Params {
        near: near.clone(),
        radius: args.radius.map(|r| r.resolve(diagonal)).map(|[one, other]| one.max(other)),
        angle: args.angle,
        format,
    };
    match fusion::sharpen(model, &params, session.watch()) {
        Ok(outcome) => Ok(Some(outcome)),
        Err(Error::Sharpen(sharpen::Refusal::NotRounded { at })) if args.radius.is_some() && at == near[0] => Ok(None),
        Err(e) => Err(refused(args, &e)),
    }
}

fn refused(args: &Args, error: &fusion::Error) -> Failure {
    Failure::of_files(error, std::slice::from_ref(&args.input))
}

/// Prints the largest radius that fits.
fn limit(session: &Session, args: &Args) -> Result<(), Failure> {
    let model = session.read(&args.input, &args.source)?;
    let params = round::Params {
        features: features::Params { angle: args.angle, ..features::Params::default() },
        choice: args.choosing.choice(session, joint_diagonal(std::slice::from_ref(&model)))?,
        blend: blend::Params::new(1.0),
        format: Format::Obj,
    };
    let limit = round::max_radius(&model, &params, session.watch()).map_err(|e| refused(args, &e))?;
    print_limit(&limit, args.limit.json)
}

/// Prints a radius, and what is in the way of a larger one.
pub fn print_limit(limit: &blend::Limit, as_json: bool) -> Result<(), Failure> {
    let at = limit.at.map(|p| p.to_array());
    if as_json {
        return print(&format!("{:#}\n", json!({ "max_radius": limit.radius, "limited_by": limit.what, "at": at })));
    }
    let place = at.map_or(String::new(), |[x, y, z]| format!(" at {x},{y},{z}"));
    print(&format!("{}  (beyond it: {}{place})\n", limit.radius, limit.what))
}
