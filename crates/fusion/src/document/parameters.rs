//! Parameters: values that options refer to as `"$name"`.

use super::Error;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// The parameters of a document while it is read.
pub(super) struct Parameters<'i> {
    text: &'i str,
    values: BTreeMap<String, DeValue<'i>>,
    used: BTreeSet<String>,
}

impl<'i> Parameters<'i> {
    /// Takes the table of parameters out of a document.
    pub(super) fn take(text: &'i str, root: &mut DeTable<'i>) -> Result<Self, Error> {
        let mut all = Self { text, values: BTreeMap::new(), used: BTreeSet::new() };
        let Some(written) = root.remove("parameters") else { return Ok(all) };
        let span = written.span();
        let DeValue::Table(table) = written.into_inner() else {
            return Err(Error::at(text, span, "parameters are a table, `[parameters]`"));
        };
        all.values =
            table.into_iter().map(|(name, value)| (name.into_inner().into_owned(), value.into_inner())).collect();
        Ok(all)
    }

    /// Puts values in the place of their names, in a table and all below it. `"$$x"` is the text `$x`.
    pub(super) fn fill(&mut self, table: &mut DeTable<'i>) -> Result<(), Error> {
        table.iter_mut().try_for_each(|(_, value)| self.fill_value(value))
    }

    fn fill_value(&mut self, value: &mut Spanned<DeValue<'i>>) -> Result<(), Error> {
        let span = value.span();
        match value.get_mut() {
            DeValue::String(word) => {
                let Some(name) = word.strip_prefix('$') else { return Ok(()) };
                if name.starts_with('$') {
                    *word = Cow::Owned(name.to_string());
                    return Ok(());
                }
                let Some(known) = self.values.get(name) else {
                    let told = Error::at(self.text, span, format!("there is no parameter `{name}`"));
                    let known: Vec<&str> = self.values.keys().map(String::as_str).collect();
                    return Err(if known.is_empty() {
                        told.remedy("give it in [parameters]")
                    } else {
                        told.instead_of(name, known)
                    });
                };
                self.used.insert(name.to_string());
                *value.get_mut() = known.clone();
                Ok(())
            }
            DeValue::Array(all) => all.iter_mut().try_for_each(|each| self.fill_value(each)),
            DeValue::Table(table) => self.fill(table),
            _ => Ok(()),
        }
    }

    /// The parameters as values, and the names of those that nothing refers to.
    pub(super) fn finish(self) -> (BTreeMap<String, toml::Value>, Vec<String>) {
        let unused = self.values.keys().filter(|name| !self.used.contains(*name)).cloned().collect();
        let plain = |(name, value)| {
            let value = ValueDeserializer::from(Spanned::new(0..0, value));
            <toml::Value as serde::Deserialize>::deserialize(value).ok().map(|value| (name, value))
        };
        (self.values.into_iter().filter_map(plain).collect(), unused)
    }
}
