//! Joins and blends triangle meshes from the command line: arguments, progress and exit codes, nothing else.
//!
//! | file | holds |
//! |---|---|
//! | `args.rs`, `choosing.rs`, `rolling.rs`, `clustering.rs`, `composing.rs`, `cutting.rs`, `detailing.rs`, `smoothing.rs`, `length.rs`, `place.rs` | what can be typed |
//! | `failure.rs` | exit codes |
//! | `session.rs` | one command: reading, progress, messages, writing |
//! | `text_file.rs` | files of curves, clusters, profiles and the like |
//! | `output.rs` | files that appear all at once or not at all |
//! | `progress.rs` | bars and Ctrl-C |
//! | `verbs/` | one file per verb |

mod args;
mod choosing;
mod clustering;
mod composing;
mod cutting;
mod detailing;
mod failure;
mod length;
mod output;
mod place;
mod progress;
mod rolling;
mod session;
mod smoothing;
mod text_file;
mod verbs;

use args::{Cli, Verb, with_bare_weld};
use clap::Parser;
use detailing::with_curves;
use failure::Failure;
use fusion::Operation;
use session::Session;
use std::process::ExitCode;

/// Large meshes come and go from stage to stage: the system's allocator gives their pages back and asks for them again,
/// which costs a third of a blend's time on a million triangles.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let cli = Cli::parse_from(with_curves(with_bare_weld(std::env::args_os())));
    match run(cli) {
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
        Verb::Features(args) => verbs::features::run(session, &args),
        Verb::Union(args) => verbs::join::run(session, &args, Operation::Union),
        Verb::Difference(args) => verbs::join::run(session, &args, Operation::Difference),
        Verb::Intersection(args) => verbs::join::run(session, &args, Operation::Intersection),
        Verb::Compose(args) => verbs::compose::run(session, &args),
        Verb::Remesh(args) => verbs::remesh::run(session, &args),
        Verb::Cut(args) => verbs::cut::run(session, &args),
        Verb::Run(args) => verbs::run::run(session, &args),
        Verb::Render(args) => verbs::render::run(session, &args),
        Verb::Completions(args) => verbs::completions::run(&args),
        Verb::Man(args) => verbs::man::run(session, &args),
        Verb::Demo(args) => verbs::demo::run(session, &args),
        Verb::Detail(args) => verbs::detail::run(session, &args),
        Verb::Cluster(args) => verbs::cluster::run(session, &args),
        Verb::Blend(args) => verbs::blend::run(session, &args),
        Verb::Chamfer(args) => verbs::blend::run_chamfer(session, args),
    }
}
