//! What is wrong with a document.

use std::fmt;
use std::ops::Range;

/// What is wrong with a document, where, and what would be right.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Error {
    /// The line, counting from 1; 0 for what stands nowhere in the text.
    pub line: usize,
    /// The column in characters, counting from 1; 0 for what stands nowhere.
    pub column: usize,
    /// The key on that line, or the table it opens.
    pub key: String,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub remedy: Option<String>,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "line {}, column {}", self.line, self.column)?;
            if !self.key.is_empty() {
                write!(f, ", `{}`", self.key)?;
            }
            f.write_str(": ")?;
        } else if !self.key.is_empty() {
            write!(f, "`{}`: ", self.key)?;
        }
        f.write_str(&self.message)?;
        self.remedy.as_ref().map_or(Ok(()), |remedy| write!(f, "; {remedy}"))
    }
}

impl std::error::Error for Error {}

impl Error {
    /// An error about the bytes `span` of a document's text.
    pub(super) fn at(text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        let start = (0..=span.start.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0);
        let before = &text[..start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        let whole = text[line_start..].lines().next().unwrap_or_default();
        let key = whole.split('=').next().unwrap_or_default();
        let key = key.trim_matches(|c: char| c.is_whitespace() || "[]".contains(c)).to_string();
        Self {
            line: 1 + before.matches('\n').count(),
            column: 1 + before[line_start..].chars().count(),
            key,
            message: message.into(),
            remedy: None,
        }
    }

    /// An error about something that is named from outside of the text.
    pub(super) fn about(key: &str, message: impl Into<String>) -> Self {
        Self { key: key.into(), message: message.into(), ..Self::default() }
    }

    /// What a reader of TOML says, with the nearest key where one is unknown.
    pub(super) fn of(text: &str, error: &toml::de::Error) -> Self {
        let told = Self::at(text, error.span().unwrap_or(0..0), error.message());
        let Some(rest) = error.message().strip_prefix("unknown field `") else { return told };
        let mut words = rest.split('`').step_by(2);
        let key = words.next().unwrap_or_default();
        let known: Vec<&str> = words.collect();
        Self { message: format!("unknown key `{key}`"), key: key.into(), ..told.instead_of(key, known) }
    }

    /// With what is right in its place.
    #[must_use]
    pub(super) fn remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(remedy.into()), ..self }
    }

    /// With the words that would have been right in the place of one, the nearest first.
    #[must_use]
    pub(super) fn instead_of<'a>(self, word: &str, known: impl IntoIterator<Item = &'a str>) -> Self {
        let known: Vec<&str> = known.into_iter().collect();
        let far = |other: &&str| strsim::normalized_damerau_levenshtein(word, other);
        let nearest = known.iter().copied().max_by(|a, b| far(a).total_cmp(&far(b))).filter(|n| far(n) > 0.6);
        let all = known.join(", ");
        match nearest {
            Some(nearest) => self.remedy(format!("did you mean `{nearest}`? Here may stand {all}")),
            None if known.is_empty() => self,
            None => self.remedy(format!("here may stand {all}")),
        }
    }
}
