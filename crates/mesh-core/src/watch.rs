//! Progress and cancellation, handed through every long loop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

type Listener = dyn Fn(&'static str, f64) + Send + Sync;

/// A handle that long loops report to and ask whether to go on. Cheap to clone; `Watch::default()` listens to nothing.
#[derive(Clone, Default)]
pub struct Watch {
    cancelled: Arc<AtomicBool>,
    listener: Option<Arc<Listener>>,
}

/// The caller asked to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Watch {
    /// A handle whose `listener` hears the stage's name and the share of it that is done, in [0, 1].
    pub fn new(listener: impl Fn(&'static str, f64) + Send + Sync + 'static) -> Self {
        Self { cancelled: Arc::default(), listener: Some(Arc::new(listener)) }
    }

    /// Asks every loop that holds this handle to stop at its next step.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Reports progress of `stage` and returns whether to go on.
    ///
    /// # Errors
    /// [`Cancelled`] once [`Watch::cancel`] has been called.
    pub fn step(&self, stage: &'static str, share: f64) -> Result<(), Cancelled> {
        if let Some(listener) = &self.listener {
            listener(stage, share);
        }
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}
