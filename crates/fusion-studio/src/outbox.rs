//! What waits to be sent to one client. A client that is slow gets the newest of a kind and not all of them, so what waits is bounded.

use axum::body::Bytes;
use axum::extract::ws::Message;
use serde_json::Value;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::Notify;

/// More answers that wait than this, and the client is given up.
const MOST: usize = 4096;

/// What waits for one client.
#[derive(Debug, Default)]
pub struct Outbox {
    waiting: Mutex<Waiting>,
    ready: Notify,
}

#[derive(Debug, Default)]
struct Waiting {
    items: VecDeque<(Slot, Message)>,
    /// The revision of every shape that was sent or waits.
    sent: BTreeMap<String, String>,
    closed: bool,
}

/// What an item takes the place of.
#[derive(Debug, PartialEq)]
enum Slot {
    /// Nothing.
    Own,
    /// The last of this name.
    Newest(String),
}

impl Outbox {
    /// Adds an answer.
    pub fn answer(&self, answer: &Value) {
        self.push(Slot::Own, Message::Text(answer.to_string().into()));
    }

    /// Adds an event, in the place of one of its kind that still waits.
    pub fn event(&self, event: &Value) {
        let kind = event["event"].as_str().unwrap_or_default().to_string();
        self.push(Slot::Newest(kind), Message::Text(event.to_string().into()));
    }

    /// Adds a frame that answers a request.
    pub fn frame(&self, frame: Bytes) {
        self.push(Slot::Own, Message::Binary(frame));
    }

    /// Adds a shape, unless the client has it.
    pub fn shape(&self, name: &str, revision: &str, frame: &Bytes) {
        let known = self.lock().sent.insert(name.into(), revision.into());
        if known.as_deref() != Some(revision) {
            self.push(Slot::Newest(format!("shape {name}")), Message::Binary(frame.clone()));
        }
    }

    /// Forgets what the client has, but for these shapes.
    pub fn retain(&self, keep: impl Fn(&str) -> bool) {
        self.lock().sent.retain(|name, _| keep(name));
    }

    /// Ends it.
    pub fn close(&self) {
        self.lock().closed = true;
        self.ready.notify_one();
    }

    /// The next item; `None` once it is closed.
    pub async fn next(&self) -> Option<Message> {
        loop {
            {
                let mut waiting = self.lock();
                if waiting.closed {
                    return None;
                }
                if let Some((_, message)) = waiting.items.pop_front() {
                    return Some(message);
                }
            }
            self.ready.notified().await;
        }
    }

    fn push(&self, slot: Slot, message: Message) {
        let mut waiting = self.lock();
        if slot != Slot::Own {
            waiting.items.retain(|(other, _)| *other != slot);
        }
        waiting.items.push_back((slot, message));
        waiting.closed |= waiting.items.len() > MOST;
        drop(waiting);
        self.ready.notify_one();
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn all(outbox: &Outbox) -> Vec<Message> {
        std::mem::take(&mut outbox.lock().items).into_iter().map(|i| i.1).collect()
    }

    #[test]
    fn a_slow_client_gets_the_newest() {
        let outbox = Outbox::default();
        for n in 0..100 {
            outbox.event(&json!({ "event": "progress", "n": n }));
            outbox.shape("a", &n.to_string(), &Bytes::from(vec![n]));
            outbox.shape("a", &n.to_string(), &Bytes::from(vec![n]));
        }
        outbox.answer(&json!({ "re": 1 }));
        let [progress, shape, answer] = &all(&outbox)[..] else { panic!("three are left") };
        assert!(progress.to_text().unwrap().contains("99"));
        assert_eq!(*shape, Message::Binary(Bytes::from(vec![99])));
        assert!(answer.to_text().unwrap().contains("re"));
        outbox.shape("a", "99", &Bytes::new());
        assert!(all(&outbox).is_empty());
        outbox.retain(|_| false);
        outbox.shape("a", "99", &Bytes::new());
        assert_eq!(all(&outbox).len(), 1);
    }

    #[test]
    fn a_client_that_never_reads_is_given_up() {
        let outbox = Outbox::default();
        (0..=MOST).for_each(|_| outbox.answer(&json!({})));
        assert!(outbox.lock().closed);
    }
}
