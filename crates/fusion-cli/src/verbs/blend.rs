//! `blend`: fillets feature curves.

use crate::drawings::Drawings;
use crate::failure::Failure;
use crate::options::{Read, unread, wrong};
use crate::output::print;
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{MaxRadius, OptionalTarget, Source};
use clap::Args;
use fusion::operation::{Blend, Options, Section};
use fusion::{Error, Profile, blend, round};
use serde_json::json;
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct BlendArgs {
    /// The mesh to blend
    input: PathBuf,
    #[command(flatten)]
    target: OptionalTarget,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    limit: MaxRadius,
    #[command(flatten)]
    blend: Blend,
    #[command(flatten)]
    drawings: Drawings,
}

/// Blends the chosen curves and writes the result, or tells how large a ball may be.
pub fn run(session: &Session, mut args: BlendArgs) -> Result<(), Failure> {
    if args.limit.max_radius && args.blend.profile != Section::default() {
        return Err(Failure::usage("--max-radius is that of an arc; leave out --profile"));
    }
    let Some(target) = args.target.target() else { return limit(session, args) };
    args.blend.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&target, session)?;
    let sketch = args.drawings.sketch()?;
    args.blend.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let model = session.read(&args.input, &args.source)?;
    let inputs = || counts(std::slice::from_ref(&args.input), std::slice::from_ref(&model));
    let diagonal = joint_diagonal(std::slice::from_ref(&model));
    let sharpened = args.blend.sharpened(&model, diagonal, destination.format, session.watch());
    if let Some(mut outcome) = sharpened.map_err(|e| refused(&args.input, &e))? {
        outcome.report.inputs = inputs();
        return session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report);
    }
    let mut params = args.blend.params(diagonal, destination.format).map_err(|e| wrong(&e))?;
    params.blend.sketch = sketch.clone();
    let outcome = round(&model, &params, session.watch()).map_err(|e| refused(&args.input, &e));
    let mut outcome = args.drawings.keep(&sketch, outcome)?;
    outcome.report.inputs = inputs();
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// The same with the straight chord for a section, which is the default of this verb.
pub fn run_chamfer(session: &Session, args: BlendArgs) -> Result<(), Failure> {
    if args.blend.profile != Profile::Chamfer.into() {
        return Err(Failure::usage("`chamfer` has its own profile; take `blend` for another"));
    }
    run(session, args)
}

fn refused(input: &PathBuf, error: &Error) -> Failure {
    Failure::of_files(error, std::slice::from_ref(input))
}

/// Prints the largest radius that fits.
fn limit(session: &Session, mut args: BlendArgs) -> Result<(), Failure> {
    args.blend.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let model = session.read(&args.input, &args.source)?;
    let limit = args.blend.max_radius(&model, session.watch()).map_err(|e| refused(&args.input, &e))?;
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
