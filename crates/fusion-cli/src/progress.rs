//! Progress bars on a terminal and lines elsewhere, Ctrl-C, and the time limit.

use crate::failure::Failure;
use fusion::mesh_core::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Nothing is shown before this: most jobs are done by then.
const PATIENCE: Duration = Duration::from_millis(500);
/// How long a cancelled job may take to stop by itself.
const GRACE: Duration = Duration::from_secs(1);

/// Held while output files are moved into place, so that Ctrl-C cannot leave half of them.
static WRITING: Mutex<()> = Mutex::new(());

/// Keeps Ctrl-C waiting until the guard is dropped.
pub fn hold_cancel() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Where there is no terminal, a line is printed this often.
const LINES: Duration = Duration::from_secs(5);

/// The bar of one command. Dropping it wipes the line.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
    /// Set once the time limit has ended the job.
    late: Arc<AtomicBool>,
    /// Set by Ctrl-C and by the time limit.
    stopped: Arc<AtomicBool>,
    /// What long loops report to.
    pub watch: Watch,
}

impl Progress {
    /// A bar on standard error if that is a terminal, else lines, if `wanted`; Ctrl-C and the end of `limit` cancel its watch.
    /// A job that does not stop within a second of that limit is ended, after `give_up`.
    pub fn start(wanted: bool, limit: Option<Duration>, give_up: impl Fn(&Failure) + Send + 'static) -> Self {
        let start = Instant::now();
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        let watch = match (wanted, std::io::stderr().is_terminal()) {
            (false, _) => Watch::default(),
            (true, true) => {
                let style = ProgressStyle::with_template("{msg:24} {bar:40} {percent:>3}% {elapsed}");
                bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
                Watch::new(painter(bar.clone()))
            }
            (true, false) => Watch::new(liner(LINES, |line| {
                // A closed standard error is no reason to stop.
                let _ = writeln!(std::io::stderr(), "{line}");
            })),
        };
        let stopped = Arc::new(AtomicBool::new(false));
        let (stop, stopping) = (watch.clone(), Arc::clone(&stopped));
        // Without a handler Ctrl-C still ends the process, only less politely.
        let _ = ctrlc::set_handler(move || {
            stopping.store(true, Ordering::Relaxed);
            stop.cancel();
            // A job between two looks at its watch, or waiting for its input, is not waited for.
            std::thread::sleep(GRACE);
            let _finished = hold_cancel();
            let _ = writeln!(std::io::stderr(), "error: cancelled");
            std::process::exit(130);
        });
        let late = Arc::new(AtomicBool::new(false));
        if let Some(limit) = limit {
            let (stop, late, stopping) = (watch.clone(), Arc::clone(&late), Arc::clone(&stopped));
            std::thread::spawn(move || {
                std::thread::sleep(limit);
                late.store(true, Ordering::Relaxed);
                stopping.store(true, Ordering::Relaxed);
                stop.cancel();
                std::thread::sleep(GRACE);
                let finished = hold_cancel();
                let failure = Failure::late(start.elapsed());
                drop(finished);
                give_up(&failure);
                let _finished = hold_cancel();
                failure.say();
                std::process::exit(failure.code().into());
            });
        }
        Self { bar, start, late, stopped, watch }
    }

    /// How long the job has run, if the time limit has ended it.
    pub fn late(&self) -> Option<Duration> {
        self.late.load(Ordering::Relaxed).then(|| self.start.elapsed())
    }
}

impl Progress {
    /// Whether the user or the time limit has asked to stop, for those who have nothing to report to the watch.
    pub fn stopped(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.stopped)
    }

    /// Wipes the bar while something else is printed.
    pub fn suspend(&self, print: impl FnOnce()) {
        self.bar.suspend(print);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Draws at most twenty times a second, since long loops report from many threads.
fn painter(bar: ProgressBar) -> impl Fn(&'static str, f64) + Send + Sync + 'static {
    let start = Instant::now();
    let next = Arc::new(AtomicU64::new(PATIENCE.as_millis() as u64));
    move |stage, share| {
        let now = start.elapsed().as_millis() as u64;
        let due = next.load(Ordering::Relaxed);
        if now < due || next.compare_exchange(due, now + 50, Ordering::Relaxed, Ordering::Relaxed).is_err() {
            return;
        }
        if bar.is_hidden() {
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.set_message(stage);
        bar.set_position((1000.0 * share.clamp(0.0, 1.0)) as u64);
    }
}

/// Gives a line with the stage and its share at most this often.
fn liner(every: Duration, print: impl Fn(String) + Send + Sync + 'static) -> impl Fn(&'static str, f64) + Send + Sync {
    let start = Instant::now();
    let every = every.as_millis() as u64;
    let next = AtomicU64::new(every);
    move |stage, share| {
        let now = start.elapsed().as_millis() as u64;
        let due = next.load(Ordering::Relaxed);
        if now >= due && next.compare_exchange(due, now + every, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
            print(format!("{stage} {:.0} %", 100.0 * share.clamp(0.0, 1.0)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_at_their_pace() {
        let lines = Arc::new(Mutex::new(vec![]));
        let kept = Arc::clone(&lines);
        let tell = liner(Duration::from_millis(40), move |line| kept.lock().unwrap().push(line));
        tell("blend", 0.1);
        std::thread::sleep(Duration::from_millis(50));
        tell("blend", 0.404);
        tell("blend", 0.5);
        assert_eq!(*lines.lock().unwrap(), ["blend 40 %"]);
    }
}
