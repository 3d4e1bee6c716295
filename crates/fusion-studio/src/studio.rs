//! What all clients share: the desk, the evaluation, the audience.

use crate::audience::Audience;
use crate::autosave::{self, Autosave};
use crate::desk::Desk;
use crate::evaluator::{Evaluator, Job, Outcome};
use crate::event;
use crate::refusal::Refusal;
use crate::remedy;
use crate::request::Edit;
use crate::root::Root;
use crate::scene::{Scene, chosen};
use crate::sources::{Meshes, Rooted};
use fusion::document::{Cache, Shapes};
use fusion::mesh_core::Watch;
use serde_json::Value;
use std::io;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Bytes of results that are kept in memory, about.
const CACHE: usize = 1 << 30;
/// Bytes of the evaluation's stack, as main threads have.
const STACK: usize = 16 << 20;
/// Progress is told no more often than this, and not of what takes less.
const PROGRESS: Duration = Duration::from_millis(80);

/// One document, whoever looks at it.
#[derive(Debug)]
pub struct Studio {
    /// What everything is below.
    pub root: Root,
    /// Who looks on.
    pub audience: Audience,
    /// Results that are kept.
    pub cache: Cache,
    /// Meshes that are kept.
    pub meshes: Meshes,
    desk: Mutex<Desk>,
    evaluator: Evaluator,
    autosave: Autosave,
    scene: Mutex<Arc<Scene>>,
    /// What an earlier session left unsaved, relative to the root.
    pub left: Option<&'static str>,
}

impl Studio {
    /// An empty desk, and a thread that evaluates what comes onto it until [`Self::stop`].
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(root: Root) -> io::Result<Arc<Self>> {
        let left = autosave::put_aside(&root);
        let studio = Arc::new(Self {
            left,
            autosave: Autosave::start(root.clone())?,
            root,
            audience: Audience::default(),
            cache: Cache::in_memory(CACHE),
            meshes: Meshes::default(),
            desk: Mutex::new(Desk::new()),
            evaluator: Evaluator::default(),
            scene: Mutex::default(),
        });
        let worker = Arc::clone(&studio);
        std::thread::Builder::new().name("evaluation".into()).stack_size(STACK).spawn(move || worker.work())?;
        Ok(studio)
    }

    /// Ends the thread.
    pub fn stop(&self) {
        self.evaluator.stop();
    }

    /// The desk, for a look.
    pub fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What the clients see.
    pub fn scene(&self) -> Arc<Scene> {
        Arc::clone(&self.scene.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Does an edit, tells everyone, and has it evaluated.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn edit(&self, edit: Edit) -> Result<Value, Refusal> {
        let mut desk = self.desk();
        let before = desk.version;
        let answer = desk.edit(&self.root, edit)?;
        if desk.version != before {
            self.changed(&desk);
        }
        Ok(answer)
    }

    /// Adds an output where there is none for this file; see [`Desk::add_output`].
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn add_output(&self, of: &str, file: &str) -> Result<u64, Refusal> {
        let mut desk = self.desk();
        let before = desk.version;
        desk.add_output(&self.root, of, file)?;
        if desk.version != before {
            self.changed(&desk);
        }
        Ok(desk.version)
    }

    /// Shows other shapes besides the results.
    pub fn show(&self, names: Vec<String>) {
        let mut desk = self.desk();
        desk.show = names.into_iter().collect();
        self.evaluator.submit(Job::of(&desk));
    }

    /// Stops the evaluation under way.
    pub fn cancel(&self) {
        if let Some(job) = self.evaluator.cancel() {
            self.audience.tell(&event::cancelled(job.version));
        }
    }

    fn changed(&self, desk: &Desk) {
        self.audience.tell(&event::document(desk));
        self.evaluator.submit(Job::of(desk));
        self.autosave.keep((!desk.is_saved()).then(|| desk.autosave()));
    }

    fn work(self: Arc<Self>) {
        let (start, told) = (Instant::now(), Arc::new(AtomicU64::new(0)));
        let studio = Arc::clone(&self);
        let progress = move |job: &Job, stage: &'static str, share: f64| {
            studio.evaluator.give_way();
            let now = start.elapsed().as_millis() as u64;
            let before = told.load(Ordering::Relaxed);
            let is_due = now >= before + PROGRESS.as_millis() as u64;
            if is_due && told.compare_exchange(before, now, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
                studio.audience.tell(&event::progress(job.version, stage, share));
            }
        };
        self.evaluator.work(
            progress,
            |job, watch| self.evaluate(job, watch),
            |job, outcome| self.publish(job, outcome),
        );
    }

    fn evaluate(&self, job: &Job, watch: &Watch) -> Result<Shapes, fusion::Error> {
        let mut sources = Rooted { root: &self.root, folder: &job.folder, meshes: &self.meshes };
        job.document.shapes(&mut sources, &self.cache, watch)
    }

    fn publish(&self, job: &Job, outcome: Outcome) {
        let (made, took) = match outcome {
            Outcome::Made(made, took) => (made, took),
            Outcome::Cancelled => return self.audience.tell(&event::cancelled(job.version)),
            Outcome::Failed(error) => {
                return self.audience.fail(event::failed(job.version, None, &Refusal::of(&error)));
            }
        };
        let (shown, results) = chosen(&made, &job.document, &job.show);
        let is_first = self.audience.is_empty();
        let stopped = made.stopped.clone();
        // What was seen stays in view where a step has failed.
        let keep = stopped.is_some() && !is_first;
        let seen = if keep {
            self.scene().seen.clone()
        } else {
            shown.iter().map(|(n, s)| (n.clone(), (*s).clone())).collect()
        };
        let scene = Scene { document: Arc::clone(&job.document), folder: job.folder.clone(), made: made.clone(), seen };
        *self.scene.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(scene);
        if !keep {
            self.audience.show(&shown, event::evaluated(job.version, took, &made, &shown, results));
        }
        if let Some(stopped) = stopped {
            self.audience.fail(event::failed(job.version, Some(stopped.step), &remedy::refusal(&stopped)));
        }
    }
}
