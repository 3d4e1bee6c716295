//! `batch`: many documents in worker processes.

use crate::batch::folders::{Folders, name};
use crate::batch::memory;
use crate::batch::meter::Meter;
use crate::batch::outcome::{Outcome, State};
use crate::batch::pool::{self, Plan};
use crate::batch::program::program;
use crate::batch::results::Results;
use crate::batch::seat::Terms;
use crate::batch::shard::Shard;
use crate::failure::Failure;
use crate::job_line::{Fault, Job, parse};
use crate::length::seconds;
use crate::output::make_folder;
use crate::session::{Session, is_stream};
use clap::Args;
use fusion::Report;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Write};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Malformed lines, and kinds of failures, that are told of.
const TOLD: usize = 10;

/// Arguments of `batch`.
#[derive(Args)]
#[command(after_long_help = AFTER_HELP)]
pub struct BatchArgs {
    /// The jobs, a JSON object a line: `id`, `document` (a path or a whole document), `parameters`
    #[arg(value_name = "JOBS.jsonl")]
    pub jobs: PathBuf,
    /// Append what becomes of each job here as it ends, a JSON object a line (docs/scale.md lists its keys)
    #[arg(long, value_name = "RESULTS.jsonl")]
    pub results: PathBuf,
    /// Put the outputs of each job into DIR/ID; the folder of the results if not given
    #[arg(long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Work on this many jobs at a time; as many as there are cores if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    /// End a job after this many seconds
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub timeout: Option<Duration>,
    /// End a job whose worker holds more than this many megabytes in memory
    #[arg(long, value_name = "MB", value_parser = clap::value_parser!(u32).range(1..))]
    pub memory: Option<u32>,
    /// Take every n-th job only, beginning with the i-th; array jobs of Kubernetes, Slurm and AWS Batch tell it by themselves
    #[arg(long, value_name = "i/n")]
    pub shard: Option<Shard>,
    /// Go on where a batch was ended: keep finished lines, cut a torn one off, do the rest
    #[arg(long)]
    pub resume: bool,
    /// Keep finished steps in this folder, and take them from there
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
}

const AFTER_HELP: &str = "\
The exit code is 0 once every job has a line, whatever its outcome; with --strict it is 4 if a job is not done or told a warning.";

/// Does the jobs that are not done.
pub fn run(session: &Session, args: &BatchArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let jobs = read_jobs(&args.jobs)?;
    let shard = shard(args, session)?;
    if is_stream(&args.results) {
        return Err(Failure::usage("--results needs a file"));
    }
    let beside = args.results.parent().unwrap_or(Path::new("")).to_path_buf();
    let root = args.output.clone().unwrap_or_else(|| beside.clone());
    let root = if root.as_os_str().is_empty() { PathBuf::from(".") } else { root };
    if let Some(cache) = &args.cache {
        make_folder(cache)?;
    }
    make_folder(&root)?;
    let (results, before) = if args.resume { Results::resume(&args.results)? } else { Results::create(&args.results)? };
    let known: BTreeSet<&str> = jobs.iter().map(|job| job.id.as_str()).collect();
    if let Some(id) = before.outcomes.keys().find(|id| !known.contains(id.as_str())) {
        let (results, jobs) = (args.results.display(), args.jobs.display());
        return Err(Failure::unreadable(format!("{results} has a result of `{id}`, which is no job of {jobs}")));
    }
    if let Some(moved) = &before.moved {
        session.warn(&format!("older results are now in {}", moved.display()));
    }
    if before.torn > 0 {
        session.warn(&format!("a line that was torn after {} bytes was cut off; its job is done again", before.torn));
    }
    if args.memory.is_some() && !memory::KNOWN {
        session.warn("--memory is not enforced on this system, which does not tell the memory of a process");
    }
    let folders = Folders::new(&root, &args.results);
    folders.sweep().map_err(|e| Failure::unwritable(format!("cannot write into {}: {e}", root.display())))?;
    let mine = jobs.iter().enumerate().filter(|(place, _)| shard.takes(*place)).map(|(_, job)| job);
    let (old, new): (Vec<&Job>, Vec<&Job>) = mine.partition(|job| before.outcomes.contains_key(&job.id));
    let cores = session
        .common()
        .threads
        .map_or_else(|| std::thread::available_parallelism().map_or(1, NonZero::get), Into::into);
    let workers = args.workers.map_or(cores, Into::into);
    let terms = Terms {
        program: program(),
        threads: (cores / workers).max(1),
        cache: args.cache.clone(),
        timeout: args.timeout,
        memory: args.memory.map(f64::from),
    };
    let base = args.jobs.parent().filter(|_| !is_stream(&args.jobs)).unwrap_or(Path::new("")).to_path_buf();
    let count = new.len();
    let plan = Plan { jobs: new, base, folders, beside, workers, terms };
    let shows = !session.common().quiet && !session.common().no_progress;
    let stopped = session.stopped();
    let stopped = || stopped.load(Ordering::Relaxed);
    let (ended, failure) = pool::run(&plan, results, Meter::start(count, shows), stopped);
    let seconds = start.elapsed().as_secs_f64();
    let all: Vec<&Outcome> = old.iter().filter_map(|job| before.outcomes.get(&job.id)).chain(&ended).collect();
    if !session.common().quiet {
        tell(&all, ended.len(), old.len(), seconds);
    }
    if let Some(failure) = failure {
        return Err(failure);
    }
    if stopped() {
        return Err(Failure::cancelled());
    }
    if session.common().report.is_some() {
        session.write_files(vec![], &report(&all, ended.len(), seconds))?;
    }
    let bad = all.iter().filter(|o| o.state != State::Done || o.has_warnings()).count();
    if session.common().strict && bad > 0 {
        return Err(Failure::impossible(format!(
            "{bad} of {} jobs are not done or told a warning, with --strict",
            all.len()
        )));
    }
    Ok(())
}

fn read_jobs(path: &Path) -> Result<Vec<Job>, Failure> {
    let mut bytes = vec![];
    let read = if is_stream(path) {
        std::io::stdin().lock().read_to_end(&mut bytes).map(drop)
    } else {
        std::fs::read(path).map(|read| bytes = read)
    };
    read.map_err(|e| Failure::unreadable(format!("cannot read the jobs {}: {e}", path.display())))?;
    let jobs = parse(&bytes).map_err(|faults| malformed(path, &faults))?;
    let mut folders = BTreeMap::new();
    for job in &jobs {
        // Where case does not tell names apart, it must not have to.
        let folder = name(&job.id);
        let key = if cfg!(any(windows, target_os = "macos")) { folder.to_lowercase() } else { folder };
        if let Some(other) = folders.insert(key, &job.id) {
            return Err(Failure::unreadable(format!("the ids `{other}` and `{}` have the same folder here", job.id)));
        }
    }
    Ok(jobs)
}

fn malformed(path: &Path, faults: &[Fault]) -> Failure {
    let told = faults.iter().take(TOLD);
    let mut lines: Vec<String> =
        told.map(|fault| format!("{}: line {}: {}", path.display(), fault.line, fault.reason)).collect();
    if faults.len() > TOLD {
        lines.push(format!("and {} more lines", faults.len() - TOLD));
    }
    lines.push("no job was started".into());
    Failure::unreadable(lines.join("\n  "))
}

fn shard(args: &BatchArgs, session: &Session) -> Result<Shard, Failure> {
    if let Some(shard) = args.shard {
        return Ok(shard);
    }
    let found = Shard::from_environment(|name| std::env::var(name).ok()).map_err(Failure::usage)?;
    Ok(found.map_or(Shard::ALL, |(shard, variable)| {
        session.warn(&format!("shard {shard}, from {variable}; --shard 1/1 takes all jobs"));
        shard
    }))
}

/// Counts, and the reasons of failures with an example each.
fn tell(all: &[&Outcome], ended: usize, old: usize, seconds: f64) {
    let done = all.iter().filter(|o| o.state == State::Done).count();
    let rate = ended as f64 / seconds.max(1e-3);
    let before = if old > 0 { format!("; {old} were there before") } else { String::new() };
    let mut lines = vec![format!(
        "{ended} jobs in {seconds:.1} s, {rate:.1} a second{before}: {done} done, {} not",
        all.len() - done
    )];
    let mut reasons: BTreeMap<(State, i32, &str), Vec<&Outcome>> = BTreeMap::new();
    for outcome in all.iter().filter(|o| o.state != State::Done) {
        reasons.entry((outcome.state, outcome.code, outcome.reason())).or_default().push(outcome);
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, jobs)| std::cmp::Reverse(jobs.len()));
    for ((state, code, reason), jobs) in reasons.iter().take(TOLD) {
        let first: String = jobs[0].sentence().chars().take(100).collect();
        lines.push(format!("{:>7} {:<8} {code:>3} {reason:<18} {}: {first}", jobs.len(), state.name(), jobs[0].id));
    }
    if reasons.len() > TOLD {
        lines.push(format!("        and {} more reasons", reasons.len() - TOLD));
    }
    let _ = writeln!(std::io::stderr(), "{}", lines.join("\n"));
}

fn report(all: &[&Outcome], ended: usize, seconds: f64) -> Report {
    let mut report = Report::new("batch", vec![]);
    let states = [State::Done, State::Failed, State::Crashed, State::Timeout, State::Memory];
    let counts = states.map(|state| (state.name(), all.iter().filter(|o| o.state == state).count() as f64));
    let rates = [("jobs", all.len() as f64), ("ended", ended as f64), ("seconds", seconds)];
    report.figures.extend(counts.into_iter().chain(rates).map(|(name, value)| (name.to_string(), value)));
    report
}
