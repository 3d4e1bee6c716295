//! A document changed: values set, parts, steps and outputs added. Comments and order stay.

use super::action::Action;
use super::{Document, Error};
use crate::operation::{Pose, Primitive};
use serde::Serialize;
use std::path::Path;
use toml::{Table, Value};
use toml_edit::{DocumentMut, Item};

impl Document {
    /// A document without parts.
    pub fn new() -> Self {
        Self { text: "version = 2\n".into(), ..Self::default() }
    }

    /// The document as text.
    pub fn to_toml(&self) -> String {
        self.text.clone()
    }

    /// Gives a parameter, or `N.option` with N the number of a step from 1, another value: TOML such as `3`, `"2%"` or `[0, 0, 1]`,
    /// or else text.
    ///
    /// # Errors
    /// [`Error`]: no such parameter or step, or a value that the option cannot have. The document is as before then.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), Error> {
        let mut edited: DocumentMut =
            self.text.parse().map_err(|e: toml_edit::TomlError| Error::about(name, e.message()))?;
        let value: toml_edit::Value = value.parse().unwrap_or_else(|_| value.into());
        let numbered = name.split_once('.').and_then(|(n, option)| Some((n.parse::<usize>().ok()?, option)));
        if let Some((number, option)) = numbered {
            let steps = edited.get_mut("step").and_then(Item::as_array_of_tables_mut);
            let count = steps.as_ref().map_or(0, |s| s.len());
            let step = steps.zip(number.checked_sub(1)).and_then(|(steps, i)| steps.get_mut(i));
            let step = step.ok_or_else(|| {
                Error::about(name, format!("there is no step {number}")).remedy(format!("steps are 1 to {count}"))
            })?;
            put(step, option, value);
        } else {
            let known = edited.get_mut("parameters").and_then(Item::as_table_like_mut);
            let place = known.filter(|table| table.contains_key(name)).ok_or_else(|| {
                let told = Error::about(name, format!("there is no parameter `{name}`"));
                told.instead_of(name, self.parameters.keys().map(String::as_str))
            })?;
            replace(place, name, value);
        }
        self.replace(&edited.to_string())
    }

    /// Adds a part.
    ///
    /// # Errors
    /// [`Error`]: a name that is taken, a pose that cannot be. The document is as before then.
    pub fn push_part(&mut self, name: &str, mesh: &Path, pose: &Pose) -> Result<(), Error> {
        let mut table = Action::from(pose.clone()).written().map_err(|e| Error::about(name, e.to_string()))?;
        table.insert("name".into(), Value::String(name.into()));
        table.insert("mesh".into(), Value::String(mesh.display().to_string()));
        self.push(&One { part: Some([table]), ..One::default() })
    }

    /// Adds a primitive.
    ///
    /// # Errors
    /// As [`Self::push_part`].
    pub fn push_primitive(&mut self, name: &str, primitive: &Primitive) -> Result<(), Error> {
        let table = Table::try_from(primitive).map_err(|e| Error::about(name, e.to_string()))?;
        let named = Table::from_iter([(name.to_string(), Value::Table(table))]);
        self.push(&One { primitive: Some(named), ..One::default() })
    }

    /// Adds a step: an operation on shapes or, for `compose`, their loops, `"name:loop"`; `None` calls the result as the first of them.
    ///
    /// # Errors
    /// [`Error`]: unknown names, options out of range. The document is as before then.
    pub fn push_step(&mut self, of: &[&str], action: impl Into<Action>, name: Option<&str>) -> Result<(), Error> {
        let action = action.into();
        let mut table = action.written().map_err(|e| Error::about(action.verb(), e.to_string()))?;
        table.remove("loops");
        table.insert("do".into(), Value::String(action.verb().into()));
        match of {
            [] => {}
            [one] => drop(table.insert("of".into(), Value::String((*one).into()))),
            several => drop(
                table
                    .insert("of".into(), several.iter().map(|s| Value::String((*s).into())).collect::<Vec<_>>().into()),
            ),
        }
        name.map(|name| table.insert("as".into(), Value::String(name.into())));
        self.push(&One { step: Some([table]), ..One::default() })
    }

    /// Adds an output: a shape, or `None` for the only one that is left, and its file.
    ///
    /// # Errors
    /// [`Error`]: unknown names. The document is as before then.
    pub fn push_output(&mut self, of: Option<&str>, file: &Path) -> Result<(), Error> {
        let mut table = Table::from_iter([("file".to_string(), Value::String(file.display().to_string()))]);
        of.map(|of| table.insert("of".into(), Value::String(of.into())));
        self.push(&One { output: Some([table]), ..One::default() })
    }

    fn push(&mut self, one: &One) -> Result<(), Error> {
        let text = toml::to_string(one).map_err(|e| Error::about("", e.to_string()))?;
        self.replace(&format!("{}\n{text}", self.text))
    }

    fn replace(&mut self, text: &str) -> Result<(), Error> {
        *self = Self::parse(text)?;
        Ok(())
    }
}

/// What is added.
#[derive(Default, Serialize)]
struct One {
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<[Table; 1]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    primitive: Option<Table>,
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<[Table; 1]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    output: Option<[Table; 1]>,
}

/// Puts a value at a path of keys, `plane.point`. A list of tables in the way gives way to it.
fn put(step: &mut toml_edit::Table, path: &str, value: toml_edit::Value) {
    let mut table: &mut dyn toml_edit::TableLike = step;
    let mut rest = path;
    while let Some((key, below)) = rest.split_once('.') {
        let item = table.entry(key).or_insert_with(|| Item::Value(toml_edit::InlineTable::new().into()));
        if item.as_table_like().is_none() {
            *item = Item::Value(toml_edit::InlineTable::new().into());
        }
        match item.as_table_like_mut() {
            Some(next) => (table, rest) = (next, below),
            None => return,
        }
    }
    replace(table, rest, value);
}

/// Puts a value in the place of another, with the comment behind it.
fn replace(table: &mut dyn toml_edit::TableLike, key: &str, mut value: toml_edit::Value) {
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(key, Item::Value(value));
}
