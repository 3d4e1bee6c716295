//! Joins and blends triangle meshes from the command line: arguments, progress and exit codes, nothing else.
//!
//! ```no_run
//! let code = fusion_cli::main(["fusion-cli", "info", "bunny.obj"].map(Into::into));
//! # let _ = code;
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `args.rs`, `shared_args.rs`, `length.rs` | what can be typed; what several verbs share of it |
//! | `options.rs` | options of operations: the files they name, what is wrong with them |
//! | `drawings.rs` | what the stages of a blend draw |
//! | `evaluation.rs` | documents read, and told about |
//! | `failure.rs` | exit codes |
//! | `session.rs` | one command: reading, progress, messages, writing |
//! | `text_file.rs` | files of curves, clusters, profiles and the like |
//! | `output.rs` | files that appear all at once or not at all |
//! | `picture.rs` | still pictures |
//! | `progress.rs` | bars and Ctrl-C |
//! | `job_line.rs`, `job.rs` | lines of a jobs file; one document without a session |
//! | `batch/` | many jobs in worker processes |
//! | `page/` | the page that sums them up |
//! | `watched.rs` | a job done again after every save |
//! | `verbs/` | one file per verb |

mod args;
mod batch;
mod drawings;
mod evaluation;
mod failure;
mod job;
pub mod job_line;
mod length;
mod options;
mod output;
mod page;
mod picture;
mod progress;
mod session;
mod shared_args;
mod text_file;
mod verbs;
mod watched;

use args::{Cli, Verb, with_bare_weld};
use clap::FromArgMatches;
use failure::Failure;
use fusion::operation::SetOperation;
use session::Session;
use std::ffi::OsString;
use std::process::ExitCode;

/// Runs one command line, whose first argument is the program's name, and gives its exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let matches = args::command().get_matches_from(verbs::detail::with_curves(with_bare_weld(arguments)));
    match Cli::from_arg_matches(&matches).map_err(Failure::usage).and_then(run) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

fn run(cli: Cli) -> Result<(), Failure> {
    if let Some(threads) = cli.common.threads {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads.into())
            .build_global()
            .map_err(|e| Failure::usage(format!("cannot start {threads} threads: {e}")))?;
    }
    let name = cli.verb.name();
    let session = Session::start(cli.common, name)?;
    session.close(dispatch(&session, cli.verb))
}

fn dispatch(session: &Session, verb: Verb) -> Result<(), Failure> {
    match verb {
        Verb::Info(args) => verbs::info::run(session, &args),
        Verb::Convert(args) => verbs::convert::run(session, &args),
        Verb::Repair(args) => verbs::repair::run(session, &args),
        Verb::Features(args) => verbs::features::run(session, &args),
        Verb::Union(args) => verbs::boolean::run(session, args, SetOperation::Union),
        Verb::Difference(args) => verbs::boolean::run(session, args, SetOperation::Difference),
        Verb::Intersection(args) => verbs::boolean::run(session, args, SetOperation::Intersection),
        Verb::Sharpen(args) => verbs::sharpen::run(session, &args),
        Verb::Compose(args) => verbs::compose::run(session, &args),
        Verb::Remesh(args) => verbs::remesh::run(session, args),
        Verb::Pose(args) => verbs::pose::run(session, args),
        Verb::Cut(args) => verbs::cut::run(session, &args),
        Verb::Run(args) => verbs::run::run(session, &args),
        Verb::Batch(args) => verbs::batch::run(session, &args),
        Verb::Worker(args) => verbs::worker::run(session, &args),
        Verb::Grid(args) => verbs::grid::run(session, &args),
        Verb::Summary(args) => verbs::summary::run(session, &args),
        Verb::Render(args) => verbs::render::run(session, &args),
        Verb::Completions(args) => verbs::completions::run(&args),
        Verb::Schema => verbs::schema::run(),
        Verb::Man(args) => verbs::man::run(session, &args),
        Verb::Demo(args) => verbs::demo::run(session, &args),
        Verb::Detail(args) => verbs::detail::run(session, args),
        Verb::Cluster(args) => verbs::cluster::run(session, args),
        Verb::Blend(args) => verbs::blend::run(session, args),
        Verb::Chamfer(args) => verbs::blend::run_chamfer(session, args),
    }
}
