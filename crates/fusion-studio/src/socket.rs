//! One client: its requests in order, answers and events as they come.

use crate::answer::{answer, is_quick};
use crate::event;
use crate::outbox::Outbox;
use crate::refusal::Refusal;
use crate::request::{Question, Request};
use crate::studio::Studio;
use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use fusion::mesh_core::Watch;
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;
use tokio::time::timeout;

/// The most bytes of a request.
pub const LONGEST: usize = 8 << 20;
/// Long questions of one client that are worked on at once; the rest waits.
const AT_ONCE: usize = 2;
/// Long questions of one client that wait, at most.
const WAITING: usize = 32;
/// A client that takes no byte for so long is gone.
const PATIENCE: Duration = Duration::from_secs(60);

/// Serves a client until it is gone.
pub async fn serve(studio: Arc<Studio>, mut socket: WebSocket) {
    let Some(outbox) = studio.audience.join() else {
        let reason = "too many pages are open".into();
        let _ = socket.send(Message::Close(Some(CloseFrame { code: close_code::AGAIN, reason }))).await;
        return;
    };
    greet(&studio, &outbox);
    let gone = Watch::default();
    let mut client = Client {
        studio: &studio,
        outbox: &outbox,
        gone: &gone,
        radius: Watch::default(),
        due: Arc::new(Semaphore::new(AT_ONCE)),
        waiting: Arc::new(Semaphore::new(WAITING)),
    };
    loop {
        tokio::select! {
            message = outbox.next() => {
                let Some(message) = message else { break };
                if !matches!(timeout(PATIENCE, socket.send(message)).await, Ok(Ok(()))) {
                    break;
                }
            }
            message = socket.recv() => match message {
                Some(Ok(Message::Text(text))) => client.take(&text),
                Some(Ok(Message::Binary(_))) => outbox.answer(&refused(None, &Refusal::new("requests are text"))),
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                Some(Ok(Message::Close(_)) | Err(_)) | None => break,
            },
        }
    }
    // Nobody waits for its answers any more.
    gone.cancel();
    client.radius.cancel();
    studio.audience.leave(&outbox);
}

fn greet(studio: &Studio, outbox: &Outbox) {
    outbox.event(&event::document(&studio.desk()));
    if let Some(path) = studio.left {
        outbox.event(&json!({ "event": "autosave", "path": path }));
    }
    studio.audience.show_all(outbox);
}

struct Client<'a> {
    studio: &'a Arc<Studio>,
    outbox: &'a Arc<Outbox>,
    /// Cancelled with the client.
    gone: &'a Watch,
    /// The last search for a largest radius, which a newer one takes the place of.
    radius: Watch,
    due: Arc<Semaphore>,
    waiting: Arc<Semaphore>,
}

impl Client<'_> {
    /// Does a request, or has it done.
    fn take(&mut self, text: &str) {
        let json: Value = match serde_json::from_str(text) {
            Ok(json) => json,
            Err(e) => return self.outbox.answer(&refused(None, &Refusal::new(format!("this is no JSON: {e}")))),
        };
        let Some(id) = json["id"].as_u64() else {
            return self.outbox.answer(&refused(None, &Refusal::new("a request needs an `id`, a number")));
        };
        match Request::read(json) {
            Err(sentence) => self.outbox.answer(&refused(Some(id), &Refusal::new(sentence))),
            Ok(Request::Edit(edit)) => {
                let done = tokio::task::block_in_place(|| self.studio.edit(edit));
                self.outbox.answer(&answered(id, done));
            }
            Ok(Request::Ask(question)) if is_quick(&question) => {
                let done = answer(self.studio, self.outbox, id, question, self.gone);
                self.outbox.answer(&answered(id, done));
            }
            Ok(Request::Ask(question)) => self.queue(id, question),
        }
    }

    /// Has a long question answered on another thread.
    fn queue(&mut self, id: u64, question: Question) {
        let Ok(place) = Arc::clone(&self.waiting).try_acquire_owned() else {
            return self.outbox.answer(&refused(Some(id), &Refusal::new("too many requests wait; try again")));
        };
        let mut watch = self.gone.clone();
        if matches!(question, Question::MaxRadius { .. }) {
            self.radius.cancel();
            self.radius = Watch::default();
            watch = self.radius.clone();
        }
        let (studio, outbox, due) = (Arc::clone(self.studio), Arc::clone(self.outbox), Arc::clone(&self.due));
        tokio::spawn(async move {
            let _place = place;
            let Ok(_turn) = due.acquire_owned().await else { return };
            let work = move || {
                let done = answer(&studio, &outbox, id, question, &watch);
                outbox.answer(&answered(id, done));
            };
            // A panic is answered by silence, and no other request suffers.
            let _ = tokio::task::spawn_blocking(work).await;
        });
    }
}

fn answered(id: u64, done: Result<Value, Refusal>) -> Value {
    match done {
        Ok(done) => json!({ "re": id, "ok": done }),
        Err(refusal) => refused(Some(id), &refusal),
    }
}

fn refused(id: Option<u64>, refusal: &Refusal) -> Value {
    json!({ "re": id, "error": refusal.to_json(json!({})) })
}
