#![no_main]
//! Documents: what parses is evaluated as far as its parts' places, on a pipe for each part; what does not names a line of the text.
//! Set options and what is pushed must parse again, and parsing must give the same text.

use fusion::document::{self, Cache, Document, Precisions, Sources};
use fusion::mesh_core::{TriMesh, Watch, shapes};
use fusion::operation::{Files, Pose};
use mesh_io::Model;
use std::path::Path;
use std::sync::Arc;

/// More parts only cost time.
const MOST_PARTS: usize = 6;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match Document::parse(text) {
        Ok(document) => edit(document, text),
        Err(error) => check(&error, text),
    }
});

/// A text and a pipe in the place of every file.
struct Itself<'a>(&'a str);

impl Sources for Itself<'_> {
    fn model(&mut self, _: &Path) -> Result<Arc<Model>, String> {
        Ok(Arc::new(shapes::open_cylinder(1.0, 2.0, 8, 3).into()))
    }
}

impl Files for Itself<'_> {
    fn text(&mut self, _: &Path) -> Result<String, String> {
        Ok(self.0.into())
    }

    fn mesh(&mut self, _: &Path) -> Result<TriMesh, String> {
        Ok(shapes::open_cylinder(1.0, 2.0, 8, 3))
    }
}

fn check(error: &document::Error, text: &str) {
    assert!(!error.message.is_empty());
    assert!(error.line <= text.lines().count().max(1) + 1, "{error}");
}

/// Poses and cuts. Booleans, joins and blends take seconds, which leaves too few inputs for the language.
fn edit(mut document: Document, text: &str) {
    assert_eq!(document.to_toml(), text);
    if document.parts().len() > MOST_PARTS || document.steps().len() > MOST_PARTS {
        return;
    }
    for (i, step) in (1..).zip(document.clone().steps()) {
        if !matches!(step.action.verb(), "pose" | "cut") {
            // What cannot be switched off stands in a list that is no list of tables.
            if document.set(&format!("{i}.off"), "true").is_err() {
                return;
            }
        }
    }
    let whole = document.to_toml();
    if document.push_part("fuzzed part", Path::new("pipe"), &Pose::default()).is_ok() {
        assert!(document.parts().iter().any(|p| p.name == "fuzzed part"));
    }
    match document.evaluate_from(&mut Itself(text), &Cache::default(), Precisions::ByFile, &Watch::default()) {
        Ok(made) => made.outputs.iter().for_each(|o| assert!(o.outcome.model.mesh.positions.iter().all(|p| p.is_finite()))),
        Err(fusion::Error::Document(error)) => check(&error, &(whole + "\n\n\n\n\n\n")),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
