//! Progress bars on a terminal, and Ctrl-C.

use fusion::mesh_core::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicU64, Ordering};
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

/// The bar of one command. Dropping it wipes the line.
pub struct Progress {
    bar: ProgressBar,
    /// What long loops report to.
    pub watch: Watch,
}

impl Progress {
    /// A bar on standard error if that is a terminal and `wanted`; Ctrl-C cancels its watch.
    pub fn start(wanted: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::hidden());
        let watch = if wanted && std::io::stderr().is_terminal() {
            let style = ProgressStyle::with_template("{msg:24} {bar:40} {percent:>3}% {elapsed}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            Watch::new(painter(bar.clone()))
        } else {
            Watch::default()
        };
        let stop = watch.clone();
        // Without a handler Ctrl-C still ends the process, only less politely.
        let _ = ctrlc::set_handler(move || {
            stop.cancel();
            // A job between two looks at its watch, or waiting for its input, is not waited for.
            std::thread::sleep(GRACE);
            let _finished = hold_cancel();
            let _ = writeln!(std::io::stderr(), "error: cancelled");
            std::process::exit(130);
        });
        Self { bar, watch }
    }
}

impl Progress {
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
