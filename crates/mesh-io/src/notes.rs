//! Collects notes while reading: one entry per kind, with a count and the first place.

use crate::error::Spot;
use crate::model::Note;

/// Notes in order of first appearance.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    entries: Vec<(String, u64, Option<Spot>)>,
}

impl Notes {
    /// Counts `count` more things that `what` happened to.
    pub fn add(&mut self, what: &str, count: usize, at: Option<Spot>) {
        match self.entries.iter_mut().find(|(text, ..)| text == what) {
            Some((_, total, _)) => *total += count as u64,
            None if count > 0 => self.entries.push((what.to_owned(), count as u64, at)),
            None => {}
        }
    }

    /// Counts one more thing, found at `offset` of a text file.
    pub fn text(&mut self, what: &str, offset: usize) {
        self.add(what, 1, Some(Spot::Text(offset)));
    }

    /// Takes over what another part of the file gave, keeping this one's places where both know the kind.
    pub fn append(&mut self, later: Self) {
        for (what, count, at) in later.entries {
            self.add(&what, count as usize, at);
        }
    }

    /// The finished notes, with offsets told as lines.
    pub fn resolve(self, bytes: &[u8]) -> Vec<Note> {
        self.entries
            .into_iter()
            .map(|(what, count, at)| Note { what, count, first: at.map(|spot| spot.resolve(bytes)) })
            .collect()
    }
}
