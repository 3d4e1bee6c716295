//! `union`, `difference` and `intersection`, with or without a blended seam.

use crate::drawings::Drawings;
use crate::failure::Failure;
use crate::options::{Read, unread, wrong};
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{MaxRadius, OptionalTarget, Source};
use crate::verbs::blend::print_limit;
use clap::Args;
use fusion::operation::{Boolean, Options, SetOperation};
use fusion::{Error, join};
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct BooleanArgs {
    /// The solids, two or more, as they are posed in their files
    #[arg(required = true, num_args = 2.., value_name = "MESH")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    target: OptionalTarget,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    limit: MaxRadius,
    #[command(flatten)]
    boolean: Boolean,
    #[command(flatten)]
    drawings: Drawings,
}

/// Joins the inputs and writes the result, or tells how large a ball along the seams may be.
pub fn run(session: &Session, args: BooleanArgs, operation: SetOperation) -> Result<(), Failure> {
    let mut boolean = args.boolean.with_operation(operation);
    let chooses = !boolean.near.is_empty() || boolean.longer.is_some();
    if boolean.radius.is_none() && chooses && !args.limit.max_radius {
        return Err(Failure::usage("--near and --longer choose seams to blend: they need --radius R or --max-radius"));
    }
    boolean.validate().map_err(|e| wrong(&e))?;
    let destination = args.target.target().map(|t| Destination::check(&t, session)).transpose()?;
    let sketch = args.drawings.sketch()?;
    boolean.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let models = session.read_all(&args.inputs, &args.source)?;
    let Some(destination) = destination else {
        let limit = boolean.max_radius(&models, session.watch()).map_err(|e| explain(&e, &args.inputs))?;
        return print_limit(&limit, args.limit.json);
    };
    let mut params = boolean.params(joint_diagonal(&models), destination.format).map_err(|e| wrong(&e))?;
    if let Some(blend) = &mut params.blend {
        blend.sketch = sketch.clone();
    }
    let outcome = join(&models, &params, session.watch()).map_err(|e| explain(&e, &args.inputs));
    let mut outcome = args.drawings.keep(&sketch, outcome)?;
    outcome.report.command = operation.to_string();
    outcome.report.inputs = counts(&args.inputs, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// The library counts parts; the user knows files.
fn explain(error: &Error, inputs: &[PathBuf]) -> Failure {
    let mut text = error.to_string();
    let two = inputs.len() == 2;
    for (i, path) in inputs.iter().enumerate() {
        if two || matches!(error, Error::NotManifold { .. }) {
            text = text.replace(&format!("part {i} "), &format!("{} ", path.display()));
        }
        text = text.replace(&format!("solid {i} "), &format!("{} ", path.display()));
    }
    Failure::of(error, text)
}
