#![no_main]
//! Recipes: what parses is replayed as far as its parts' places, on a pipe for each part; what does not names a line of the text.

use fusion::mesh_core::{TriMesh, Watch, shapes};
use fusion::operation::Files;
use fusion::{Recipe, recipe};
use std::path::Path;

/// More parts only cost time.
const MOST_PARTS: usize = 6;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match Recipe::parse(text) {
        Ok(recipe) => replay(recipe, text),
        Err(error) => check(&error, text),
    }
});

/// A text in the place of every file.
struct Itself<'a>(&'a str);

impl Files for Itself<'_> {
    fn text(&mut self, _: &Path) -> Result<String, String> {
        Ok(self.0.into())
    }

    fn mesh(&mut self, _: &Path) -> Result<TriMesh, String> {
        Ok(shapes::open_cylinder(1.0, 2.0, 8, 3))
    }
}

fn check(error: &recipe::Error, text: &str) {
    assert!(!error.message.is_empty());
    assert!((1..=text.lines().count().max(1) + 1).contains(&error.line), "{error}");
}

/// Cuts and poses. Booleans, joins and blends take seconds, which leaves too few inputs for the language.
fn replay(mut recipe: Recipe, text: &str) {
    assert!(!recipe.parts.is_empty() && recipe.order().len() <= recipe::Step::ORDER.len());
    // The recipe itself in the place of a file of curves: anything may stand there.
    if let Err(error) = recipe.load(&mut Itself(text)) {
        check(&error, text);
    }
    if recipe.parts.len() > MOST_PARTS {
        return;
    }
    recipe.boolean.clear();
    recipe.compose.clear();
    recipe.blend.clear();
    recipe.cluster.clear();
    recipe.detail.clear();
    let pipe = shapes::open_cylinder(1.0, 2.0, 8, 3).into();
    let parts = vec![pipe; recipe.parts.len()];
    match recipe.run(&parts, mesh_io::Format::Off, &Watch::default()) {
        Ok(outcome) => assert!(outcome.model.mesh.positions.iter().all(|p| p.is_finite())),
        Err(fusion::Error::Recipe(error)) => check(&error, text),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
