//! `man`: manual pages, made from the definition of the command line.

use crate::args::{Cli, Man as Args};
use crate::failure::Failure;
use crate::output::stream;
use crate::session::Session;
use clap::{Command, CommandFactory};
use fusion::Report;
use std::fs;

/// Prints the program's page, or writes it and those of all verbs.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let mut program = Cli::command();
    // Hands the common options down to the verbs.
    program.build();
    let Some(folder) = &args.output else { return stream(&page(program)?) };
    fs::create_dir_all(folder)
        .map_err(|e| Failure::unwritable(format!("cannot make the folder {}: {e}", folder.display())))?;
    let verbs = program.get_subcommands().filter(|v| v.get_name() != "help" && !v.is_hide_set());
    let mut pages: Vec<_> = verbs.map(|v| (format!("fusion-cli-{}.1", v.get_name()), v.clone())).collect();
    pages.push(("fusion-cli.1".into(), program.clone()));
    let pages = pages.into_iter().map(|(name, command)| Ok((folder.join(name), page(command)?)));
    session.write_files(pages.collect::<Result<_, Failure>>()?, &Report::new("man", vec![]))
}

fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut text = vec![];
    clap_mangen::Man::new(command).render(&mut text).map_err(Failure::unwritable)?;
    Ok(text)
}
