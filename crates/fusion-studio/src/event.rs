//! What the server says by itself.

use crate::desk::Desk;
use crate::frame::revision;
use crate::refusal::Refusal;
use crate::root::below;
use crate::value::{table_to_json, to_json};
use fusion::document::{Shapes, Shown};
use serde_json::{Map, Value, json};
use std::time::Duration;
use toml_edit::{DocumentMut, Item};

/// The document as it is.
pub fn document(desk: &Desk) -> Value {
    let (document, text) = (desk.document(), desk.document().to_toml());
    let written: DocumentMut = text.parse().unwrap_or_default();
    let table = |kind: &str, index: usize| -> Map<String, Value> {
        let all = written.get(kind).map(to_json).unwrap_or_default();
        all.get(index).and_then(Value::as_object).cloned().unwrap_or_default()
    };
    let parts = document.parts().iter().enumerate().map(|(index, part)| {
        let mut pose = table("part", index);
        pose.retain(|key, _| key != "name" && key != "mesh");
        let mesh = part.mesh.display().to_string();
        let path = below(desk.folder(), &part.mesh).unwrap_or_default();
        json!({ "index": index, "name": part.name, "mesh": mesh, "path": path, "pose": pose })
    });
    let steps = document.steps().iter().enumerate().map(|(index, step)| {
        let mut options = table("step", index);
        let of = match options.remove("of") {
            Some(Value::String(one)) => json!([one]),
            other => other.unwrap_or_default(),
        };
        let name = options.remove("as").unwrap_or_default();
        let (off, verb) = (options.remove("off").unwrap_or(false.into()), options.remove("do").unwrap_or_default());
        json!({
            "index": index, "do": verb, "of": step.of, "written_of": of, "as": step.name, "written_as": name, "off": off,
            "options": options,
        })
    });
    let outputs = document.outputs().iter().enumerate().map(|(index, output)| {
        let file = below(desk.folder(), &output.file).unwrap_or_else(|_| output.file.display().to_string());
        json!({ "index": index, "of": output.of, "file": file })
    });
    let keyed = |kind: &str| written.get(kind).and_then(Item::as_table_like).map_or(json!({}), table_to_json);
    let [can_undo, can_redo] = desk.can_undo_redo();
    json!({
        "event": "document", "version": desk.version, "text": text, "path": desk.path, "folder": desk.folder(),
        "saved": desk.is_saved(), "can_undo": can_undo, "can_redo": can_redo,
        "parts": parts.collect::<Vec<_>>(), "primitives": keyed("primitive"), "steps": steps.collect::<Vec<_>>(),
        "outputs": outputs.collect::<Vec<_>>(), "parameters": keyed("parameters"), "shapes": document.left_over(),
    })
}

/// How far the evaluation is.
pub fn progress(version: u64, stage: &str, fraction: f64) -> Value {
    json!({ "event": "progress", "version": version, "stage": stage, "fraction": fraction })
}

/// What was made; of the shapes the first `results` are results.
pub fn evaluated(version: u64, took: Duration, made: &Shapes, shown: &[(String, &Shown)], results: usize) -> Value {
    let steps = made.taken.iter().map(|taken| {
        json!({ "index": taken.number - 1, "name": taken.name, "known": taken.is_known, "report": taken.report })
    });
    let shapes = shown.iter().enumerate().map(|(i, (name, shown))| {
        let validity = shown.validity.unwrap_or_default();
        json!({
            "name": name, "revision": revision(shown), "closed": validity.closed, "manifold": validity.manifold,
            "crossings": validity.self_intersections, "faces": shown.model.mesh.faces.len(),
            "vertices": shown.model.mesh.positions.len(), "result": i < results,
        })
    });
    json!({
        "event": "evaluated", "version": version, "milliseconds": 1e3 * took.as_secs_f64(),
        "steps": steps.collect::<Vec<_>>(), "shapes": shapes.collect::<Vec<_>>(),
    })
}

/// Why a step, or the document, gave nothing.
pub fn failed(version: u64, step: Option<usize>, refusal: &Refusal) -> Value {
    refusal.to_json(json!({ "event": "failed", "version": version, "step": step }))
}

/// The user stopped the evaluation.
pub fn cancelled(version: u64) -> Value {
    json!({ "event": "cancelled", "version": version })
}
