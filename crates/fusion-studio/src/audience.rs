//! The clients, and the frames of what they see.

use crate::frame;
use crate::outbox::Outbox;
use axum::body::Bytes;
use fusion::document::Shown;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// More clients than this are refused.
const MOST: usize = 16;

/// Everyone who looks on.
#[derive(Debug, Default)]
pub struct Audience {
    scene: Mutex<Scene>,
}

#[derive(Debug, Default)]
struct Scene {
    clients: Vec<Arc<Outbox>>,
    /// Every shape that is shown: its revision and its frame.
    frames: BTreeMap<String, (String, Bytes)>,
    /// What was said last of the evaluation.
    evaluated: Option<Value>,
    failed: Option<Value>,
}

impl Audience {
    /// Adds a client; `None` where there are too many.
    pub fn join(&self) -> Option<Arc<Outbox>> {
        let mut scene = self.lock();
        if scene.clients.len() >= MOST {
            return None;
        }
        let client = Arc::new(Outbox::default());
        scene.clients.push(Arc::clone(&client));
        Some(client)
    }

    /// Takes a client out.
    pub fn leave(&self, client: &Arc<Outbox>) {
        client.close();
        self.lock().clients.retain(|other| !Arc::ptr_eq(other, client));
    }

    /// Sends a client all that is shown, whatever it has.
    pub fn show_all(&self, client: &Outbox) {
        client.retain(|_| false);
        let scene = self.lock();
        for (name, (revision, frame)) in &scene.frames {
            client.shape(name, revision, frame);
        }
        scene.evaluated.iter().chain(&scene.failed).for_each(|event| client.event(event));
    }

    /// Tells everyone.
    pub fn tell(&self, event: &Value) {
        self.lock().clients.iter().for_each(|client| client.event(event));
    }

    /// Shows these shapes and no others, then says so. A shape whose revision is known is not made into a frame again.
    pub fn show(&self, shapes: &[(String, &Shown)], evaluated: Value) {
        let known = self.lock().frames.clone();
        let frame = |(name, shown): &(String, &Shown)| {
            let revision = frame::revision(shown);
            let same = known.get(name).filter(|(of, _)| *of == revision);
            let frame = same.map_or_else(|| frame::mesh(name, shown), |(_, frame)| frame.clone());
            (name.clone(), (revision, frame))
        };
        let frames: BTreeMap<_, _> = shapes.iter().map(frame).collect();
        let mut scene = self.lock();
        for client in &scene.clients {
            client.retain(|name| frames.contains_key(name));
            for (name, (revision, frame)) in &frames {
                client.shape(name, revision, frame);
            }
            client.event(&evaluated);
        }
        scene.frames = frames;
        scene.evaluated = Some(evaluated);
        scene.failed = None;
    }

    /// Tells everyone that the last evaluation failed; what is shown stays.
    pub fn fail(&self, failed: Value) {
        let mut scene = self.lock();
        scene.clients.iter().for_each(|client| client.event(&failed));
        scene.failed = Some(failed);
    }

    /// Whether nothing is shown yet.
    pub fn is_empty(&self) -> bool {
        self.lock().frames.is_empty()
    }

    fn lock(&self) -> MutexGuard<'_, Scene> {
        self.scene.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
