//! Requests played without a server, for fuzz targets and tests.

use crate::desk::Desk;
use crate::request::Request;
use crate::root::Root;
use fusion::Document;
use std::path::Path;

/// Does what a client's text frames ask for, one a line, to a document whose files are below `root`, and gives its text. Questions are
/// read and not answered.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let frames = r#"
///     { "id": 1, "do": "set", "table": "parameters", "key": "soft", "value": 3 }
///     this is no request
///     { "id": 2, "do": "set", "table": "step", "index": 7, "key": "radius", "value": 3 }
/// "#;
/// assert_eq!(fusion_studio::play(folder.path(), frames.as_bytes()), Ok("version = 2\n\n[parameters]\nsoft = 3\n".into()));
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// What the desk promises and does not keep: a refused edit leaves the document as it was, and a document is always one.
pub fn play(root: &Path, frames: &[u8]) -> Result<String, String> {
    let root = Root::new(root).map_err(|e| e.to_string())?;
    let mut desk = Desk::new();
    for frame in frames.split(|&byte| byte == b'\n') {
        let Ok(json) = serde_json::from_slice(frame) else { continue };
        let Ok(Request::Edit(edit)) = Request::read(json) else { continue };
        let (before, told) = (desk.document().to_toml(), format!("{edit:?}"));
        let refused = desk.edit(&root, edit).is_err();
        let after = desk.document().to_toml();
        if refused && after != before {
            return Err(format!("{told} was refused, and the document changed:\n{before}\n{after}"));
        }
        if let Err(error) = Document::parse(&after) {
            return Err(format!("{told} made no document: {error}\n{after}"));
        }
    }
    Ok(desk.document().to_toml())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn word(random: &mut fastrand::Rng) -> &'static str {
        const WORDS: [&str; 20] = [
            "one",
            "two",
            "both",
            "one:0",
            "radius",
            "near",
            "plane.normal",
            "of",
            "as",
            "name",
            "mesh",
            "file",
            "do",
            "off",
            "a.obj",
            "../a.obj",
            "x.ply",
            "",
            "$soft",
            "on.primitive",
        ];
        WORDS[random.usize(..WORDS.len())]
    }

    fn value(random: &mut fastrand::Rng, depth: u32) -> Value {
        match random.u8(..if depth > 2 { 5 } else { 7 }) {
            0 => Value::Null,
            1 => random.bool().into(),
            2 => random.i8(..).into(),
            3 => random.f64().into(),
            4 => word(random).into(),
            5 => (0..random.usize(..4)).map(|_| value(random, depth + 1)).collect(),
            _ => json!({ word(random): value(random, depth + 1) }),
        }
    }

    fn request(random: &mut fastrand::Rng) -> Value {
        const VERBS: [&str; 6] = ["union", "blend", "pose", "cut", "compose", "nothing"];
        const TABLES: [&str; 5] = ["part", "step", "output", "primitive", "parameters"];
        let index = random.usize(..3);
        let table = TABLES[random.usize(..TABLES.len())];
        match random.u8(..12) {
            0 => json!({ "do": "add_part", "mesh": word(random), "name": word(random) }),
            1 => json!({ "do": "add_part", "mesh": "a.obj" }),
            2 => {
                json!({ "do": "add_step", "verb": VERBS[random.usize(..6)], "of": [word(random), word(random)], "at": index })
            }
            3 => {
                json!({ "do": "add_step", "verb": VERBS[random.usize(..6)], "options": { word(random): value(random, 0) } })
            }
            4 => json!({ "do": "add_output", "of": word(random), "file": word(random) }),
            5 => json!({ "do": "remove", "table": table, "index": index, "name": word(random) }),
            6 => json!({ "do": "move", "table": table, "index": index, "to": random.usize(..4) }),
            7 => json!({ "do": "rename", "table": table, "index": index, "to": word(random) }),
            8 => json!({ "do": if random.bool() { "undo" } else { "redo" } }),
            9 => {
                json!({ "do": "add_primitive", "name": word(random), "options": { "shape": "box", "size": [1, 1, 1] } })
            }
            _ => {
                json!({ "do": "set", "table": table, "index": index, "name": word(random), "key": word(random), "value": value(random, 0), "drag": random.bool().then_some(1) })
            }
        }
    }

    #[test]
    fn whatever_is_asked_for_a_document_stays_one() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.obj"), "v 0 0 0\n").unwrap();
        let mut changed = 0;
        for seed in 0..150 {
            let mut random = fastrand::Rng::with_seed(seed);
            let frames: String = (0..60).map(|_| request(&mut random).to_string() + "\n").collect();
            let text = play(folder.path(), frames.as_bytes()).unwrap_or_else(|told| panic!("seed {seed}: {told}"));
            changed += usize::from(text.contains("[[part]]") && text.contains("[[step]]"));
        }
        assert!(changed > 20, "{changed} documents have parts and steps");
    }
}
