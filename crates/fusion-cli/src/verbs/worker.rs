//! `worker`: what `batch` starts, once for each job at a time.

use crate::batch::work::serve;
use crate::failure::Failure;
use crate::session::Session;
use clap::Args;
use std::path::PathBuf;

/// Arguments of a worker.
#[derive(Args)]
pub struct WorkerArgs {
    /// Keep finished steps in this folder
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
}

/// Answers requests until standard input ends.
pub fn run(session: &Session, args: &WorkerArgs) -> Result<(), Failure> {
    serve(args.cache.as_deref(), session.watch())
}
