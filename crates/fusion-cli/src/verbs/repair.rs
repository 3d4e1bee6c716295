//! `repair`: any mesh in, a solid out.

use crate::failure::Failure;
use crate::options::wrong;
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::Code;
use fusion::operation::{Options, Repair};
use fusion::repair::repair;
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct RepairArgs {
    /// The mesh to repair
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    repair: Repair,
}

/// Repairs the input, tells what each step mended, and writes the result.
pub fn run(session: &Session, args: &RepairArgs) -> Result<(), Failure> {
    args.repair.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&args.target, session)?;
    let models = [session.read(&args.input, &args.source)?];
    let params = args.repair.params(joint_diagonal(&models), destination.format).map_err(|e| wrong(&e))?;
    let inputs = std::slice::from_ref(&args.input);
    let mut outcome = repair(&models[0], &params, session.watch()).map_err(|e| Failure::of_files(&e, inputs))?;
    outcome.report.inputs = counts(inputs, &models);
    let mended = outcome.report.diagnostics.iter().filter(|d| d.code == Code::Repaired);
    let lines: Vec<&str> = mended.map(|d| d.message.as_str()).collect();
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)?;
    // With --verbose they are among the notes.
    if !session.common().verbose {
        for line in &lines {
            session.tell(line);
        }
    }
    if lines.is_empty() {
        session.tell("nothing to repair");
    }
    Ok(())
}
