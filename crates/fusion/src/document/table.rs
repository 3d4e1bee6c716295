//! Tables of a document, whose every key knows its place.

use super::Error;
use crate::operation::OptionError;
use serde::de::{DeserializeOwned, Error as _, Visitor, value};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer, ValueDeserializer};

/// Where the keys of a table stand in the text.
#[derive(Clone, Debug, Default)]
pub(super) struct Places {
    pub(super) whole: Range<usize>,
    of: BTreeMap<String, Range<usize>>,
}

impl Places {
    pub(super) fn of(whole: Range<usize>, table: &DeTable<'_>) -> Self {
        Self { whole, of: table.iter().map(|(key, value)| (key.get_ref().to_string(), value.span())).collect() }
    }

    /// The place of a key, or of the whole table.
    pub(super) fn span(&self, key: &str) -> Range<usize> {
        self.of.get(key).unwrap_or(&self.whole).clone()
    }

    /// What is wrong with an option.
    pub(super) fn wrong(&self, text: &str, error: &OptionError) -> Error {
        let message = if self.of.contains_key(error.option) {
            error.reason.clone()
        } else {
            format!("`{}`: {}", error.option, error.reason)
        };
        Error::at(text, self.span(error.option), message)
    }
}

/// Reads all that is left of a table as one thing, which must know every key.
pub(super) fn read<T: DeserializeOwned>(
    text: &str,
    whole: Range<usize>,
    table: DeTable<'_>,
    hidden: &[&str],
) -> Result<T, Error> {
    let known: Vec<&str> = fields::<T>().iter().copied().filter(|key| !hidden.contains(key)).collect();
    check_keys(text, &table, &known)?;
    T::deserialize(Deserializer::from(Spanned::new(whole, table))).map_err(|e| Error::of(text, &e))
}

/// Refuses keys that are not known.
pub(super) fn check_keys(text: &str, table: &DeTable<'_>, known: &[&str]) -> Result<(), Error> {
    match table.keys().find(|key| !known.contains(&key.get_ref().as_ref())) {
        None => Ok(()),
        Some(key) => {
            let word = key.get_ref().as_ref();
            let told = Error::at(text, key.span(), format!("unknown key `{word}`"));
            Err(Error { key: word.into(), ..told.instead_of(word, known.iter().copied()) })
        }
    }
}

/// Takes the value of a key, if there is one.
pub(super) fn take<T: DeserializeOwned>(text: &str, table: &mut DeTable<'_>, key: &str) -> Result<Option<T>, Error> {
    let Some(value) = table.remove(key) else { return Ok(None) };
    T::deserialize(ValueDeserializer::from(value)).map(Some).map_err(|e| Error::of(text, &e))
}

/// Takes the tables of a kind, `[[kind]]`.
pub(super) fn take_tables<'i>(
    text: &str,
    table: &mut DeTable<'i>,
    kind: &str,
) -> Result<Vec<(Range<usize>, DeTable<'i>)>, Error> {
    let Some(written) = table.remove(kind) else { return Ok(vec![]) };
    let wrong = |span| Error::at(text, span, format!("every {kind} is a table of its own, `[[{kind}]]`"));
    let span = written.span();
    let DeValue::Array(all) = written.into_inner() else { return Err(wrong(span)) };
    let one = |each: Spanned<DeValue<'i>>| {
        let span = each.span();
        match each.into_inner() {
            DeValue::Table(table) => Ok((span, table)),
            _ => Err(wrong(span)),
        }
    };
    all.into_iter().map(one).collect()
}

/// The keys that a struct reads, as its derive tells them.
pub(super) fn fields<T: DeserializeOwned>() -> Vec<&'static str> {
    let mut fields = vec![];
    // The answer is an error; only the question matters.
    let _ = T::deserialize(Asked(&mut fields));
    fields
}

/// Notes the keys a type asks for, and gives it none.
struct Asked<'a>(&'a mut Vec<&'static str>);

impl<'de> serde::Deserializer<'de> for Asked<'_> {
    type Error = value::Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Self::Error> {
        self.0.extend(fields);
        Err(Self::Error::custom("only asked"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
        Err(Self::Error::custom("no table"))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}
