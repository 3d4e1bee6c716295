//! `remesh`: even triangles and smooth surfaces, boundaries and features kept.

use crate::failure::Failure;
use crate::options::{Read, unread, wrong};
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::operation::{Options, Remesh};
use fusion::remesh;
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct RemeshArgs {
    /// The mesh to smooth and remesh
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    remesh: Remesh,
}

/// Smooths and remeshes the input, or a region of it, and writes the result.
pub fn run(session: &Session, mut args: RemeshArgs) -> Result<(), Failure> {
    args.remesh.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&args.target, session)?;
    args.remesh.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let models = [session.read(&args.input, &args.source)?];
    let params = args.remesh.params(joint_diagonal(&models), destination.format).map_err(|e| wrong(&e))?;
    let inputs = std::slice::from_ref(&args.input);
    let mut outcome = remesh(&models[0], &params, session.watch()).map_err(|e| Failure::of_files(&e, inputs))?;
    outcome.report.inputs = counts(inputs, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
