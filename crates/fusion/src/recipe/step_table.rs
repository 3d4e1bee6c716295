//! A step's table: the pieces it works on, and its operation.

use super::{Error, Recipe};
use crate::operation::{Files, OptionError, Options};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

/// The keys of a step that are no options of its operation.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Pieces {
    /// The part it works on, by name. The only one there is where left out.
    pub part: Option<Spanned<String>>,
    /// The parts it works on, by name, in order. All there are where left out.
    pub parts: Option<Vec<Spanned<String>>>,
    /// What the result is called. The first part's name where left out.
    pub name: Option<Spanned<String>>,
}

/// A step as written.
#[derive(Clone, Debug)]
pub struct StepTable<O> {
    /// Where it works.
    pub pieces: Pieces,
    /// What it does.
    pub operation: O,
    /// Where the options stand in the file.
    places: BTreeMap<String, Range<usize>>,
    whole: Range<usize>,
}

impl<O: Options> StepTable<O> {
    /// Takes the steps of one kind out of a recipe's tables. `keys` are those of [`Pieces`] that this kind has.
    pub(super) fn take(
        text: &str,
        tables: &mut DeTable<'_>,
        kind: &str,
        keys: &[[&str; 4]],
    ) -> Result<Vec<Self>, Error> {
        let Some(written) = tables.remove(kind) else { return Ok(vec![]) };
        let wrong = |span| Error::at(text, span, format!("a `{kind}` stands in a table of its own, `[[{kind}]]`"));
        let span = written.span();
        let DeValue::Array(steps) = written.into_inner() else { return Err(wrong(span)) };
        let one = |step: Spanned<DeValue<'_>>| {
            let span = step.span();
            match step.into_inner() {
                DeValue::Table(table) => Self::read(text, span, table, keys),
                _ => Err(wrong(span)),
            }
        };
        steps.into_iter().map(one).collect()
    }

    fn read(text: &str, whole: Range<usize>, table: DeTable<'_>, keys: &[[&str; 4]]) -> Result<Self, Error> {
        let (mut pieces, mut options, mut places) = (DeTable::new(), DeTable::new(), BTreeMap::new());
        for (key, value) in table {
            if keys.iter().any(|k| k[0] == key.get_ref().as_ref()) {
                pieces.insert(key, value);
            } else {
                places.insert(key.get_ref().to_string(), value.span());
                options.insert(key, value);
            }
        }
        let read = |table| Deserializer::from(Spanned::new(whole.clone(), table));
        let pieces = Pieces::deserialize(read(pieces)).map_err(|e| Error::of(text, &e))?;
        let operation = O::deserialize(read(options)).map_err(|e| Error::of(text, &e))?;
        Ok(Self { pieces, operation, places, whole })
    }

    /// Reads the files that the operation names.
    pub(super) fn load(&mut self, recipe: &Recipe, files: &mut dyn Files) -> Result<(), Error> {
        self.operation.load(files).map_err(|e| self.wrong(recipe, &e))
    }

    /// What is wrong with an option, by line and key.
    pub(super) fn wrong(&self, recipe: &Recipe, error: &OptionError) -> Error {
        let span = self.places.get(error.option).unwrap_or(&self.whole);
        let named = if self.places.contains_key(error.option) { "" } else { error.option };
        let message = if named.is_empty() { error.reason.clone() } else { format!("`{named}`: {}", error.reason) };
        recipe.error(span.clone(), message)
    }
}
