//! `pose`: moves a mesh.

use crate::failure::Failure;
use crate::options::{Read, unread, wrong};
use crate::session::{Destination, Session, counts};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::operation::{Options, Pose};
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct PoseArgs {
    /// The mesh to move
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    pose: Pose,
}

/// Moves the mesh and writes the result.
pub fn run(session: &Session, mut args: PoseArgs) -> Result<(), Failure> {
    args.pose.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&args.target, session)?;
    args.pose.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let inputs = std::slice::from_ref(&args.input);
    let model = session.read(&args.input, &args.source)?;
    let outcome = args.pose.run(&model, session.watch());
    let mut outcome = outcome.map_err(|e| Failure::of_files(&e, inputs))?;
    outcome.report.inputs = counts(inputs, std::slice::from_ref(&model));
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
