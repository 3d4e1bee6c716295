//! What is wrong with a recipe.

use std::ops::Range;

/// What is wrong with a recipe, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}{}: {message}", if .key.is_empty() { String::new() } else { format!(", `{}`", .key) })]
pub struct Error {
    /// The line, counting from 1.
    pub line: usize,
    /// The key on that line, or the table it opens.
    pub key: String,
    /// What is wrong, and what would be right.
    pub message: String,
}

impl Error {
    /// An error about the bytes `span` of the recipe `text`.
    pub(super) fn at(text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let start = span.start.min(text.len());
        let line = 1 + text.get(..start).map_or(0, |before| before.matches('\n').count());
        let whole = text.lines().nth(line - 1).unwrap_or_default();
        let key = whole.split('=').next().unwrap_or_default();
        let key = key.trim_matches(|c: char| c.is_whitespace() || "[]".contains(c)).to_string();
        Self { line, key, message: message.into() }
    }

    pub(super) fn of(text: &str, error: &toml::de::Error) -> Self {
        Self::at(text, error.span().unwrap_or(0..0), error.message())
    }
}
