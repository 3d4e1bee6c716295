//! Questions answered, those that take long on threads of their own.

use crate::edges;
use crate::event;
use crate::export::export;
use crate::frame;
use crate::limits;
use crate::listing;
use crate::outbox::Outbox;
use crate::questions::{self, curvature, quality};
use crate::refusal::Refusal;
use crate::request::{Of, Question};
use crate::studio::Studio;
use fusion::mesh_core::Watch;
use serde_json::{Value, json};

/// Whether a question is answered at once.
pub fn is_quick(question: &Question) -> bool {
    matches!(
        question,
        Question::State | Question::Show { .. } | Question::Cancel | Question::Pick { .. } | Question::Measure(_)
    )
}

/// Answers a question of a client; frames that belong to the answer go before it.
///
/// # Errors
/// [`Refusal`].
pub fn answer(studio: &Studio, client: &Outbox, id: u64, question: Question, watch: &Watch) -> Result<Value, Refusal> {
    let scene = studio.scene();
    match question {
        Question::State => {
            client.event(&event::document(&studio.desk()));
            studio.audience.show_all(client);
            Ok(json!({}))
        }
        Question::Show { names } => {
            studio.show(names);
            Ok(json!({}))
        }
        Question::Cancel => {
            studio.cancel();
            Ok(json!({}))
        }
        Question::Export { of, file } => export(studio, &of, &file, watch),
        Question::Curves { step: Some(step), angle, .. } => edges::of_step(studio, &scene, step, angle, watch),
        Question::Curves { shape, revision, angle, .. } => {
            Ok(edges::listed(&edges::of_shape(scene.shape(&Of { shape, revision })?, angle)?))
        }
        Question::Loops(of) => questions::loops(scene.shape(&of)?),
        Question::Info(of) => questions::info(scene.shape(&of)?, watch),
        Question::MaxRadius { step: Some(step), curves, angle, .. } => {
            limits::of_step(studio, &scene, step, (&curves, angle), watch)
        }
        Question::MaxRadius { shape, curves, angle, .. } => {
            limits::of_curves(scene.shape(&Of { shape, revision: None })?, &curves, angle, watch)
        }
        Question::Pick { of, face, bary } => {
            let point = questions::pick(scene.shape(&of)?, face, bary)?;
            Ok(json!({ "point": point.to_array() }))
        }
        Question::Measure(between) => questions::measure(&scene, &between),
        Question::Quality(of) => {
            let shown = scene.shape(&of)?;
            Ok(values(client, id, "quality", &of, shown, quality(shown)))
        }
        Question::Curvature(of) => {
            let shown = scene.shape(&of)?;
            Ok(values(client, id, "curvature", &of, shown, curvature(shown)?))
        }
        Question::Files => Ok(json!({ "files": listing::files(&studio.root) })),
    }
}

fn values(client: &Outbox, id: u64, what: &str, of: &Of, shown: &fusion::document::Shown, values: Vec<f32>) -> Value {
    let finite = values.iter().copied().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    client.frame(frame::values(id, what, &of.shape, shown, values));
    json!({ "revision": frame::revision(shown), "low": low, "high": high })
}
