//! One evaluation at a time, of the newest document.

use crate::desk::Desk;
use fusion::document::Shapes;
use fusion::mesh_core::Watch;
use fusion::{Document, Error};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// An evaluation that takes no longer than this is let finish although a newer value waits: else nothing would be seen of a drag.
const PATIENCE: Duration = Duration::from_millis(250);

/// What is to be evaluated.
#[derive(Clone, Debug)]
pub struct Job {
    /// The document's version.
    pub version: u64,
    /// The document.
    pub document: Arc<Document>,
    /// Its folder, relative to the root.
    pub folder: String,
    /// Shapes that are shown besides the results.
    pub show: Vec<String>,
}

/// What came of it.
#[derive(Debug)]
pub enum Outcome {
    /// Shapes, and how long they took.
    Made(Shapes, Duration),
    /// No shape at all.
    Failed(Error),
    /// The user stopped it.
    Cancelled,
}

/// The queue of one.
#[derive(Debug, Default)]
pub struct Evaluator {
    queue: Mutex<Queue>,
    wake: Condvar,
}

#[derive(Default)]
struct Queue {
    next: Option<Job>,
    running: Option<Running>,
    /// How long the last one took.
    last: Duration,
    stopped: bool,
}

impl std::fmt::Debug for Queue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Queue").field("next", &self.next).finish_non_exhaustive()
    }
}

struct Running {
    watch: Watch,
    since: Instant,
}

impl Job {
    /// The desk as it is.
    pub fn of(desk: &Desk) -> Self {
        Self {
            version: desk.version,
            document: Arc::clone(desk.document()),
            folder: desk.folder().to_string(),
            show: desk.show.iter().cloned().collect(),
        }
    }
}

impl Evaluator {
    /// Takes a job in the place of the one that waits, and stops the one under way if that takes long.
    pub fn submit(&self, job: Job) {
        let mut queue = self.lock();
        queue.next = Some(job);
        if let Some(running) = &queue.running
            && queue.last.max(running.since.elapsed()) > PATIENCE
        {
            running.watch.cancel();
        }
        self.wake.notify_all();
    }

    /// Stops the evaluation under way, and gives back the job that waited.
    pub fn cancel(&self) -> Option<Job> {
        let mut queue = self.lock();
        if let Some(running) = &queue.running {
            running.watch.cancel();
        }
        queue.next.take()
    }

    /// Ends [`Self::work`].
    pub fn stop(&self) {
        self.cancel();
        self.lock().stopped = true;
        self.wake.notify_all();
    }

    /// Evaluates job after job, until it is stopped. What a newer job has cancelled is not published.
    pub fn work(
        &self,
        progress: impl Fn(&Job, &'static str, f64) + Clone + Send + Sync + 'static,
        evaluate: impl Fn(&Job, &Watch) -> Result<Shapes, Error>,
        publish: impl Fn(&Job, Outcome),
    ) {
        while let Some(job) = self.next() {
            let (start, tell, told) = (Instant::now(), progress.clone(), job.clone());
            let watch = Watch::new(move |stage, share| tell(&told, stage, share));
            self.lock().running = Some(Running { watch: watch.clone(), since: start });
            let made = evaluate(&job, &watch);
            let took = start.elapsed();
            let is_outdated = {
                let mut queue = self.lock();
                queue.running = None;
                if made.is_ok() {
                    queue.last = took;
                }
                queue.next.is_some() || queue.stopped
            };
            match made {
                Ok(shapes) => publish(&job, Outcome::Made(shapes, took)),
                Err(error) if error.is_cancelled() && is_outdated => {}
                Err(error) if error.is_cancelled() => publish(&job, Outcome::Cancelled),
                Err(error) => publish(&job, Outcome::Failed(error)),
            }
        }
    }

    /// Stops the evaluation under way if a newer job waits and this one has had its time.
    pub fn give_way(&self) {
        let queue = self.lock();
        if let Some(running) = &queue.running
            && queue.next.is_some()
            && running.since.elapsed() > PATIENCE
        {
            running.watch.cancel();
        }
    }

    fn next(&self) -> Option<Job> {
        let mut queue = self.lock();
        loop {
            if queue.stopped {
                return None;
            }
            if let Some(job) = queue.next.take() {
                return Some(job);
            }
            queue = self.wake.wait(queue).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
