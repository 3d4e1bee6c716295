//! Origins as JSON, one entry a line: what `--origins` writes. The entries are described in `docs/report.md`.

use mesh_core::{FaceOrigin, Origins, VertexOrigin};
use std::fmt::Write;

/// The origins as JSON text, ending in a line break. O(n).
pub fn origins_to_json(origins: &Origins) -> String {
    let mut text = String::from("{\n\"version\": 1,\n\"vertices\": [");
    list(&mut text, origins.vertices.as_slice(), |text, origin| match *origin {
        VertexOrigin::Input { part, vertex } => write!(text, "[\"input\",{part},{vertex}]"),
        VertexOrigin::Edge { part, ends: [a, b], t } => write!(text, "[\"edge\",{part},{a},{b},{t:?}]"),
        VertexOrigin::Face { part, face, barycentric: [u, v, w] } => {
            write!(text, "[\"face\",{part},{face},{u:?},{v:?},{w:?}]")
        }
        VertexOrigin::New { stage } => write!(text, "[\"new\",{stage:?}]"),
    });
    text.push_str("],\n\"faces\": [");
    list(&mut text, origins.faces.as_slice(), |text, origin| match *origin {
        FaceOrigin::Input { part, face } => write!(text, "[\"input\",{part},{face}]"),
        FaceOrigin::Piece { part, face } => write!(text, "[\"piece\",{part},{face}]"),
        FaceOrigin::New { stage } => write!(text, "[\"new\",{stage:?}]"),
    });
    text.push_str("]\n}\n");
    text
}

/// The part that each face comes from, as [`origins_to_json`] wrote it; `None` for faces that no part had.
///
/// # Errors
/// A sentence with line and column.
pub fn parts_of_faces(text: &str) -> Result<Vec<Option<u32>>, String> {
    #[derive(serde::Deserialize)]
    struct File {
        faces: Vec<Vec<serde_json::Value>>,
    }
    let file: File = serde_json::from_str(text).map_err(|e| format!("no origins can be read: {e}"))?;
    let part = |entry: Vec<serde_json::Value>| {
        let known = matches!(entry.first().and_then(|k| k.as_str()), Some("input" | "piece"));
        entry.get(1).filter(|_| known).and_then(serde_json::Value::as_u64).and_then(|p| u32::try_from(p).ok())
    };
    Ok(file.faces.into_iter().map(part).collect())
}

fn list<T>(text: &mut String, items: &[T], mut entry: impl FnMut(&mut String, &T) -> std::fmt::Result) {
    for (i, item) in items.iter().enumerate() {
        text.push_str(if i == 0 { "\n" } else { ",\n" });
        // Writing to a String cannot fail.
        let _ = entry(text, item);
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{FaceId, VertexId};

    #[test]
    fn every_kind_of_entry_is_json() {
        let v = VertexId;
        let origins = Origins {
            vertices: vec![
                VertexOrigin::Input { part: 1, vertex: v(7) },
                VertexOrigin::Edge { part: 0, ends: [v(3), v(9)], t: 0.1 },
                VertexOrigin::Face { part: 0, face: FaceId(2), barycentric: [0.5, 0.25, 0.25] },
                VertexOrigin::New { stage: "blend" },
            ]
            .into(),
            faces: vec![FaceOrigin::Piece { part: 1, face: FaceId(4) }].into(),
        };
        let json: serde_json::Value = serde_json::from_str(&origins_to_json(&origins)).unwrap();
        assert_eq!(json["vertices"][0], serde_json::json!(["input", 1, 7]));
        assert_eq!(json["vertices"][1], serde_json::json!(["edge", 0, 3, 9, 0.1]));
        assert_eq!(json["vertices"][2], serde_json::json!(["face", 0, 2, 0.5, 0.25, 0.25]));
        assert_eq!(json["vertices"][3], serde_json::json!(["new", "blend"]));
        assert_eq!(json["faces"], serde_json::json!([["piece", 1, 4]]));
        assert_eq!(parts_of_faces(&origins_to_json(&origins)), Ok(vec![Some(1)]));
        assert_eq!(parts_of_faces("{\"faces\": [[\"new\", \"blend\"]]}"), Ok(vec![None]));
        assert!(parts_of_faces("[]").is_err_and(|e| e.contains("line 1")));
        assert!(serde_json::from_str::<serde_json::Value>(&origins_to_json(&Origins::default())).is_ok());
    }
}
