//! `completions`: what a shell needs to complete the command line.

use crate::args::{Cli, Completions as Args};
use crate::failure::Failure;
use crate::output::stream;
use clap::CommandFactory;

/// Prints the script of one shell.
pub fn run(args: &Args) -> Result<(), Failure> {
    let mut script = vec![];
    clap_complete::generate(args.shell, &mut Cli::command(), "fusion-cli", &mut script);
    stream(&script)
}
