//! One job: a thread of its own without the interpreter's lock, while the calling thread listens to Ctrl-C and tells of progress.

use crate::failure::Fault;
use fusion::mesh_core::Watch;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// How often the calling thread looks for Ctrl-C and tells of progress.
const INTERVAL: Duration = Duration::from_millis(25);
/// How long a job that is to stop is waited for.
const GRACE: Duration = Duration::from_millis(50);
/// That of a main thread: what runs in the program runs here.
const STACK: usize = 8 << 20;

/// Who wants to know, and with how many threads it is done.
pub struct Terms {
    /// Threads; those of the whole process where not given.
    pub threads: Option<usize>,
    /// Called with the stage's name and the share of it that is done. Ends the job by an exception or by `False`.
    pub progress: Option<Py<PyAny>>,
}

/// Does a job. One that is to stop and does not within [`GRACE`] is left to end by itself, its result dropped.
pub fn run<T: Send + 'static>(
    py: Python<'_>,
    terms: &Terms,
    job: impl FnOnce(&Watch) -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    let latest: Arc<Mutex<Option<(&'static str, f64)>>> = Arc::default();
    let heard = Arc::clone(&latest);
    let watch = match terms.progress {
        None => Watch::default(),
        // Long loops report from many threads: who finds the place taken goes on.
        Some(_) => Watch::new(move |stage, share| {
            if let Ok(mut latest) = heard.try_lock() {
                *latest = Some((stage, share));
            }
        }),
    };
    let (done, mut waiting) = channel();
    let (own, threads) = (watch.clone(), terms.threads);
    let work = move || {
        let result = catch_unwind(AssertUnwindSafe(|| on_threads(threads, || job(&own))));
        // Nobody listens any more if the caller was to stop.
        let _ = done.send(result.unwrap_or_else(|panic| Err(Fault::Internal(told(panic.as_ref())))));
    };
    let spawned = thread::Builder::new().name("fusion".into()).stack_size(STACK).spawn(work);
    spawned.map_err(|e| Fault::Internal(format!("cannot start a thread: {e}")).raise(py))?;
    let result = loop {
        let (answer, back) = py.detach(move || (waiting.recv_timeout(INTERVAL), waiting));
        waiting = back;
        match answer {
            Ok(result) => break result.map_err(|fault| fault.raise(py))?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Fault::Internal("the job's thread ended early".into()).raise(py));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Err(stop) = py.check_signals().and_then(|()| tell(py, terms, &latest)) {
                    watch.cancel();
                    let _ended = py.detach(move || waiting.recv_timeout(GRACE).is_ok());
                    return Err(stop);
                }
            }
        }
    };
    tell(py, terms, &latest)?;
    Ok(result)
}

fn on_threads<T: Send>(threads: Option<usize>, job: impl FnOnce() -> Result<T, Fault> + Send) -> Result<T, Fault> {
    let Some(threads) = threads else { return job() };
    let builder = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK);
    let pool = builder.build().map_err(|e| Fault::Internal(format!("cannot start {threads} threads: {e}")))?;
    pool.install(job)
}

/// Calls the listener with what was last heard, if anything was since the last time.
fn tell(py: Python<'_>, terms: &Terms, latest: &Mutex<Option<(&'static str, f64)>>) -> PyResult<()> {
    let news = latest.lock().ok().and_then(|mut latest| latest.take());
    let (Some(listener), Some((stage, share))) = (&terms.progress, news) else { return Ok(()) };
    let answer = listener.bind(py).call1((stage, share.clamp(0.0, 1.0)))?;
    let goes_on = answer.is_none() || answer.is_truthy()?;
    if goes_on { Ok(()) } else { Err(Fault::Cancelled.raise(py)) }
}

fn told(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let text = text.unwrap_or("no message");
    format!("internal error, please report it with the inputs: {text}")
}
