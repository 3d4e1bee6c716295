//! Keys that are in no table are refused, and docs/recipes.md is written, by one list.

use super::Error;
use super::vocabulary::{PIECES_OF_BLEND, PIECES_OF_BOOLEAN, PIECES_OF_COMPOSE, TABLES};
use crate::operation::{Blend, Boolean, Cluster, Compose, Cut, Detail, OptionRow, Options, option_rows};
use std::fmt::Write;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A kind of table.
pub(super) struct Table {
    pub(super) name: &'static str,
    /// Where such tables stand.
    pub(super) heading: &'static str,
    /// In pieces, of which tables may share some.
    pub(super) keys: &'static [&'static [Key]],
}

/// A key of a table.
pub(super) struct Key {
    name: &'static str,
    takes: &'static str,
    /// Empty for a key that may be left out without anything in its place.
    default: &'static str,
    meaning: &'static str,
    holds: Holds,
}

/// What stands below a key.
#[derive(Clone, Copy)]
pub(super) enum Holds {
    /// A value, or names that the recipe chooses.
    Value,
    /// A table of this kind, or several.
    Tables(&'static str),
    /// Tables of this kind by names that the recipe chooses.
    Named(&'static str),
}

pub(super) const fn key(name: &'static str, takes: &'static str, default: &'static str, meaning: &'static str) -> Key {
    Key { name, takes, default, meaning, holds: Holds::Value }
}

impl Key {
    pub(super) const fn of(self, holds: Holds) -> Self {
        Self { holds, ..self }
    }
}

impl Table {
    fn keys(&self) -> impl Iterator<Item = &'static Key> {
        self.keys.iter().copied().flatten()
    }
}

/// What every table takes, as it stands in docs/recipes.md.
pub fn reference() -> String {
    let mut text = String::new();
    for table in TABLES {
        // Writing to a string does not fail.
        let _ = write!(text, "\n{}\n\n| key | takes | where left out | |\n|---|---|---|---|\n", table.heading);
        for key in table.keys() {
            let _ = writeln!(text, "| `{}` | {} | {} | {} |", key.name, key.takes, key.default, key.meaning);
        }
    }
    operation::<Boolean>(&mut text, "boolean", PIECES_OF_BOOLEAN);
    operation::<Compose>(&mut text, "compose", PIECES_OF_COMPOSE);
    operation::<Blend>(&mut text, "blend", PIECES_OF_BLEND);
    operation::<Cluster>(&mut text, "cluster", PIECES_OF_BLEND);
    operation::<Detail>(&mut text, "detail", &[]);
    operation::<Cut>(&mut text, "part.cut", &[]);
    text.push('\n');
    text
}

/// The rows of an operation: where it works, and its options.
fn operation<O: Options>(text: &mut String, table: &str, pieces: &[[&str; 4]]) {
    let _ = write!(text, "\n`[[{table}]]`\n\n| key | takes | where left out | |\n|---|---|---|---|\n");
    for [name, takes, default, meaning] in pieces {
        let _ = writeln!(text, "| `{name}` | {takes} | {default} | {meaning} |");
    }
    for OptionRow { name, takes, default, meaning } in option_rows::<O>() {
        let _ = writeln!(text, "| `{name}` | {takes} | {default} | {meaning} |");
    }
}

/// Refuses keys that a recipe's tables do not take.
pub(super) fn check_keys(text: &str, recipe: &DeTable<'_>) -> Result<(), Error> {
    walk(text, recipe, "recipe")
}

fn walk(text: &str, table: &DeTable<'_>, kind: &str) -> Result<(), Error> {
    let Some(known) = TABLES.iter().find(|t| t.name == kind) else { return Ok(()) };
    for (name, value) in table {
        let Some(key) = known.keys().find(|k| k.name == name.get_ref().as_ref()) else {
            let keys = known.keys().map(|k| k.name).collect::<Vec<_>>().join(", ");
            let message = format!("unknown key `{}`; here may stand {keys}", name.get_ref());
            return Err(Error::at(text, name.span(), message));
        };
        match key.holds {
            Holds::Value => {}
            Holds::Tables(kind) => below(text, value, kind)?,
            Holds::Named(kind) => {
                let named = value.get_ref().as_table().into_iter().flatten();
                named.into_iter().try_for_each(|(_, each)| below(text, each, kind))?;
            }
        }
    }
    Ok(())
}

/// What is no table is left to the types of `tables.rs`.
fn below(text: &str, value: &Spanned<DeValue<'_>>, kind: &str) -> Result<(), Error> {
    match value.get_ref() {
        DeValue::Table(table) => walk(text, table, kind),
        DeValue::Array(several) => several.iter().try_for_each(|each| below(text, each, kind)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{self as t, Recipe, Rotation};
    use super::*;
    use serde::de::{Deserialize, Deserializer, Error as _, Visitor, value};

    /// Notes the keys a type asks for, and gives it none.
    struct Asked<'a>(&'a mut Vec<&'static str>);

    impl<'de> Deserializer<'de> for Asked<'_> {
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
            Err(Self::Error::custom("not a table"))
        }

        serde::forward_to_deserialize_any! {
            bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
            newtype_struct seq tuple tuple_struct map enum identifier ignored_any
        }
    }

    fn fields<T: for<'de> Deserialize<'de>>() -> Vec<&'static str> {
        let mut fields = vec![];
        assert!(T::deserialize(Asked(&mut fields)).is_err());
        fields.sort_unstable();
        fields
    }

    #[test]
    fn the_list_is_what_is_read() {
        let read = [
            ("recipe", fields::<Recipe>()),
            ("part", fields::<t::Part>()),
            ("rotate", fields::<Rotation>()),
            ("on", fields::<t::On>()),
            ("snap", fields::<t::Snap>()),
            ("primitive", fields::<t::Primitive>()),
        ];
        assert_eq!(TABLES.iter().map(|t| t.name).collect::<Vec<_>>(), read.each_ref().map(|r| r.0));
        for (table, (name, read)) in TABLES.iter().zip(read) {
            let mut listed: Vec<_> = table.keys().map(|k| k.name).collect();
            // Steps are taken out before the rest is read.
            listed
                .retain(|key| name != "recipe" || !["blend", "boolean", "cluster", "compose", "detail"].contains(key));
            listed.sort_unstable();
            assert_eq!(listed, read, "{name}");
            // What keys hold must be in the list, or it would never be looked into.
            for key in table.keys() {
                if let Holds::Tables(kind) | Holds::Named(kind) = key.holds {
                    assert!(TABLES.iter().any(|t| t.name == kind), "{name}.{}", key.name);
                }
            }
        }
    }

    #[test]
    fn keys_of_no_table_are_refused_wherever_they_stand() {
        let head = "version = 1\noutput = \"a.off\"\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n";
        for (rest, line) in [
            ("radius = 2", 6),
            ("rotate = { axis = [0, 0, 1], angle = 3, degrees = 3 }", 6),
            ("[[part.cut]]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nsmoth = 1", 8),
            ("[primitive.ball]\nshape = \"sphere\"\nradius = 1\ncentre = [0, 0, 0]", 9),
            ("[[detail]]\nsource = [{ group = \"a\" },\n { grup = \"b\" }]", 8),
            ("[[blend]]\nradius = 1\nradius_at = [{ at = [0, 0, 0], radius = 1, r = 2 }]", 8),
        ] {
            let error = Recipe::parse(&format!("{head}{rest}")).unwrap_err();
            assert!(error.line == line && error.message.starts_with("unknown"), "{error}");
        }
        // Names that a recipe chooses are no keys.
        let named = "[[compose]]\ncrease = { \"a:0\" = 3 }\n[primitive.any]\nshape = \"sphere\"\nradius = 1";
        Recipe::parse(&format!("{head}{named}")).unwrap();
    }
}
