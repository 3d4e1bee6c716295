//! All seats, the queue, and the end of each job.

use crate::batch::folders::Folders;
use crate::batch::meter::{Meter, Step};
use crate::batch::outcome::{Outcome, State};
use crate::batch::results::Results;
use crate::batch::seat::{Seat, Terms};
use crate::batch::work::Request;
use crate::failure::Failure;
use crate::job_line::Job;
use crate::progress::hold_cancel;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What is to be done, and where.
pub struct Plan<'a> {
    /// The queue.
    pub jobs: Vec<&'a Job>,
    /// What the jobs' paths are relative to.
    pub base: PathBuf,
    /// Where their outputs go.
    pub folders: Folders,
    /// The folder of the results.
    pub beside: PathBuf,
    /// Workers at a time.
    pub workers: usize,
    /// How each is started.
    pub terms: Terms,
}

/// Where all seats report to.
struct Desk {
    results: Results,
    meter: Meter,
    ended: Vec<Outcome>,
    failure: Option<Failure>,
}

/// Does all jobs, in their order where there is one worker; gives the outcome of each that ended, and what stopped the batch.
pub fn run(
    plan: &Plan,
    results: Results,
    meter: Meter,
    stop: impl Fn() -> bool + Sync,
) -> (Vec<Outcome>, Option<Failure>) {
    let desk = Mutex::new(Desk { results, meter, ended: vec![], failure: None });
    let (next, halt) = (AtomicUsize::new(0), AtomicBool::new(false));
    let stop = || stop() || halt.load(Ordering::Relaxed);
    std::thread::scope(|scope| {
        for _ in 0..plan.workers.min(plan.jobs.len()) {
            scope.spawn(|| {
                let mut seat = Seat::new(&plan.terms);
                while !stop() {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = plan.jobs.get(place) else { return };
                    if let Err(failure) = one(plan, &mut seat, place, job, &desk, stop) {
                        halt.store(true, Ordering::Relaxed);
                        desk.lock().unwrap_or_else(PoisonError::into_inner).failure.get_or_insert(failure);
                    }
                }
            });
        }
    });
    let desk = desk.into_inner().unwrap_or_else(PoisonError::into_inner);
    (desk.ended, desk.failure)
}

/// One job from its folder to its line.
fn one(
    plan: &Plan,
    seat: &mut Seat,
    place: usize,
    job: &Job,
    desk: &Mutex<Desk>,
    stop: impl Fn() -> bool,
) -> Result<(), Failure> {
    let cannot = |e: io::Error| {
        Failure::unwritable(format!("cannot write the outputs of job `{}`: {e}; --resume goes on from here", job.id))
    };
    let folder = plan.folders.open(place).map_err(cannot)?;
    let request = Request { job: job.clone(), base: plan.base.clone(), folder };
    let outcome = seat.run(&request, stop);
    let folder = &request.folder;
    let mut outcome = match outcome {
        Ok(Some(outcome)) => outcome,
        // The job is not counted, so a folder that cannot be removed does no harm.
        ended => return std::fs::remove_dir_all(folder).map_err(cannot).and(ended.map(drop)),
    };
    // Between the two renamings that end a job, Ctrl-C waits.
    let _guard = hold_cancel();
    if outcome.state == State::Done && !outcome.outputs.is_empty() {
        let kept = plan.folders.keep(folder, &job.id).map_err(cannot)?;
        outcome.folder = Some(relative(&kept, &plan.beside));
    } else {
        std::fs::remove_dir_all(folder).map_err(cannot)?;
    }
    if outcome.code == 6 {
        plan.folders.check().map_err(cannot)?;
    }
    let mut desk = desk.lock().unwrap_or_else(PoisonError::into_inner);
    desk.results.append(&outcome)?;
    desk.meter.step(if outcome.state == State::Done { Step::Done } else { Step::Failed });
    // All that the table at the end needs.
    let (figures, outputs) = (serde_json::Map::new(), vec![]);
    desk.ended.push(Outcome { figures, outputs, inputs: vec![], ..outcome });
    Ok(())
}

/// A path as seen from a folder, where it lies below; with `/` between names.
fn relative(path: &Path, from: &Path) -> String {
    let below = path.strip_prefix(from).unwrap_or(path);
    let names = below.components().filter(|c| *c != Component::CurDir);
    let names: Vec<_> = names.map(|c| c.as_os_str().to_string_lossy()).collect();
    if below.is_absolute() { path.display().to_string() } else { names.join("/") }
}
