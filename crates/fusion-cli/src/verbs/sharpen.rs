//! `sharpen`: takes fillets back to edges.

use crate::failure::Failure;
use crate::options::wrong;
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::operation::{Options, Sharpen};
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct SharpenArgs {
    /// The mesh with the fillets
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    sharpen: Sharpen,
}

/// Sharpens the input and writes the result.
pub fn run(session: &Session, args: &SharpenArgs) -> Result<(), Failure> {
    args.sharpen.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&args.target, session)?;
    let models = [session.read(&args.input, &args.source)?];
    let params = args.sharpen.params(joint_diagonal(&models), destination.format).map_err(|e| wrong(&e))?;
    let inputs = std::slice::from_ref(&args.input);
    let mut outcome =
        fusion::sharpen(&models[0], &params, session.watch()).map_err(|e| Failure::of_files(&e, inputs))?;
    outcome.report.command = Sharpen::NAME.into();
    outcome.report.inputs = counts(inputs, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
