//! `blend`: rounds feature curves.

use crate::args::{Blend as Args, Target};
use crate::failure::Failure;
use crate::output::print;
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::text_file::read_text;
use fusion::{Error, Outcome, Picked, blend, features, picked_from_text, round, sharpen};
use mesh_io::{Format, Model};
use serde_json::json;

/// Blends the chosen curves and writes the result, or tells how large a ball may be.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    if args.max_radius {
        if args.rolling.profile.is_some() {
            return Err(Failure::usage("--max-radius is that of an arc; leave out --profile"));
        }
        return limit(session, args);
    }
    let missing = || Failure::usage("`blend` needs --radius R and -o OUTPUT, or --max-radius");
    let output = args.output.as_ref().ok_or_else(missing)?;
    let sharp = args.rolling.is_sharp() && !args.near.is_empty() && args.curves.is_none();
    if args.radius.is_none() && !sharp {
        return Err(missing());
    }
    let target = Target { output: output.clone(), to: args.to.clone(), origins: args.origins.clone() };
    let destination = Destination::check(&target, session)?;
    args.rolling.prepare()?;
    let model = session.read(&args.input, &args.source)?;
    let models = std::slice::from_ref(&model);
    let inputs = || counts(std::slice::from_ref(&args.input), models);
    if sharp && let Some(mut outcome) = sharpened(session, args, &model, destination.format)? {
        outcome.report.inputs = inputs();
        return session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report);
    }
    let radius = args.radius.ok_or_else(missing)?;
    let params = round::Params {
        features: features::Params { angle: args.angle, ..features::Params::default() },
        near: args.near.clone(),
        picked: picked(args)?,
        blend: args.rolling.with_radius(radius, joint_diagonal(models))?,
        format: destination.format,
    };
    let outcome = round(&model, &params, session.watch()).map_err(|e| refused(args, &e));
    let mut outcome = args.rolling.keep_drawings(&params.blend.sketch, outcome)?;
    outcome.report.inputs = inputs();
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// The mesh with its fillets at the picked places taken back. `None` if the first of these is on no fillet and there is a
/// radius, which then means a blend with a sharp section along feature curves.
fn sharpened(session: &Session, args: &Args, model: &Model, format: Format) -> Result<Option<Outcome>, Failure> {
    let diagonal = joint_diagonal(std::slice::from_ref(model));
    let params = sharpen::Params {
        near: args.near.clone(),
        radius: args.radius.map(|r| r.sides.map(|r| r.resolve(diagonal))).map(|[one, other]| one.max(other)),
        angle: args.angle,
        format,
    };
    match fusion::sharpen(model, &params, session.watch()) {
        Ok(outcome) => Ok(Some(outcome)),
        Err(Error::Sharpen(sharpen::Refusal::NotRounded { at })) if args.radius.is_some() && at == args.near[0] => {
            Ok(None)
        }
        Err(e) => Err(refused(args, &e)),
    }
}

fn refused(args: &Args, error: &fusion::Error) -> Failure {
    Failure::of_files(error, std::slice::from_ref(&args.input))
}

fn picked(args: &Args) -> Result<Vec<Picked>, Failure> {
    args.curves.as_ref().map_or(Ok(vec![]), |path| read_text(path, picked_from_text))
}

/// Prints the largest radius that fits.
fn limit(session: &Session, args: &Args) -> Result<(), Failure> {
    let model = session.read(&args.input, &args.source)?;
    let params = round::Params {
        features: features::Params { angle: args.angle, ..features::Params::default() },
        near: args.near.clone(),
        picked: picked(args)?,
        blend: blend::Params::new(1.0),
        format: Format::Obj,
    };
    let limit = fusion::round::max_radius(&model, &params, session.watch()).map_err(|e| refused(args, &e))?;
    let at = limit.at.map(|p| p.to_array());
    if args.json {
        return print(&format!("{:#}\n", json!({ "max_radius": limit.radius, "limited_by": limit.what, "at": at })));
    }
    let place = at.map_or(String::new(), |[x, y, z]| format!(" at {x},{y},{z}"));
    print(&format!("{}  (beyond it: {}{place})\n", limit.radius, limit.what))
}
