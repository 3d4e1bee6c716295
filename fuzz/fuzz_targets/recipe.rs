#![no_main]
//! Recipes: what parses is also printed as an error or a list of parts.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match fusion::Recipe::parse(text) {
        Ok(recipe) => assert!(!recipe.parts.is_empty()),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
