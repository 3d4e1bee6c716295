//! A document's text changed at one place. Comments and order stay.

use crate::value::to_toml;
use serde::Deserialize;
use serde_json::{Map, Value as Json};
use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

/// Why a text is not changed.
#[derive(Debug, thiserror::Error)]
pub enum EditError {
    /// The text is no TOML.
    #[error(transparent)]
    Toml(#[from] toml_edit::TomlError),
    /// There is no such table.
    #[error("there is no {0} {1}")]
    Missing(&'static str, String),
    /// A value that TOML cannot hold.
    #[error("`{0}` cannot have this value")]
    Value(String),
    /// A table that is not written as one.
    #[error("{0} is not written as tables; change it in the text")]
    Form(&'static str),
}

/// The tables that can be changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// `[[part]]`
    Part,
    /// `[[step]]`
    Step,
    /// `[[output]]`
    Output,
    /// `[primitive.NAME]`
    Primitive,
    /// `[parameters]`
    Parameters,
}

/// One of them.
#[derive(Clone, Debug, Deserialize)]
pub struct At {
    /// Its kind.
    pub table: Kind,
    /// Which, counting from 0.
    #[serde(default)]
    pub index: usize,
    /// Which, where they have names.
    #[serde(default)]
    pub name: String,
}

/// A key's new value; null takes it out.
#[derive(Clone, Debug, Deserialize)]
pub struct Set {
    /// The table.
    #[serde(flatten)]
    pub at: At,
    /// The key, or a path of keys: `plane.normal`.
    pub key: String,
    /// The value.
    #[serde(default)]
    pub value: Json,
}

impl Kind {
    fn word(self) -> &'static str {
        match self {
            Self::Part => "part",
            Self::Step => "step",
            Self::Output => "output",
            Self::Primitive => "primitive",
            Self::Parameters => "parameters",
        }
    }

    fn is_list(self) -> bool {
        matches!(self, Self::Part | Self::Step | Self::Output)
    }
}

/// Gives keys other values.
///
/// # Errors
/// [`EditError`].
pub fn set(text: &str, sets: &[Set]) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse()?;
    for Set { at, key, value } in sets {
        let value = match value {
            Json::Null => None,
            value => Some(to_toml(value).ok_or_else(|| EditError::Value(key.clone()))?),
        };
        put(table(&mut document, at)?, key, value);
    }
    Ok(document.to_string())
}

/// Adds a table with these keys in this order, before the one with index `before` or behind all.
///
/// # Errors
/// [`EditError`].
pub fn add(
    text: &str,
    kind: Kind,
    keys: &[(&str, Json)],
    options: &Map<String, Json>,
    before: Option<usize>,
) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse()?;
    let mut new = Table::new();
    let options = options.iter().map(|(key, value)| (key.as_str(), value));
    for (key, value) in keys.iter().map(|(key, value)| (*key, value)).chain(options).filter(|(_, v)| !v.is_null()) {
        new.insert(key, Item::Value(to_toml(value).ok_or_else(|| EditError::Value(key.into()))?));
    }
    let all = list_or_new(&mut document, kind)?;
    let at = before.map_or(all.len(), |i| i.min(all.len()));
    let mut tables: Vec<Table> = std::mem::take(all).into_iter().collect();
    if at < tables.len() {
        tables.iter_mut().chain([&mut new]).for_each(|table| set_position(table, None));
    }
    tables.insert(at, new);
    all.extend(tables);
    Ok(document.to_string())
}

/// Adds a table with a name.
///
/// # Errors
/// [`EditError`].
pub fn add_primitive(text: &str, name: &str, options: &Map<String, Json>) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse()?;
    let mut new = Table::new();
    for (key, value) in options.iter().filter(|(_, v)| !v.is_null()) {
        new.insert(key, Item::Value(to_toml(value).ok_or_else(|| EditError::Value(key.into()))?));
    }
    let all = document.entry("primitive").or_insert_with(|| {
        let mut all = Table::new();
        all.set_implicit(true);
        Item::Table(all)
    });
    let all = all.as_table_like_mut().ok_or(EditError::Form("primitive"))?;
    all.insert(name, Item::Table(new));
    Ok(document.to_string())
}

/// Takes a table out, with the comments that stand before it.
///
/// # Errors
/// [`EditError`].
pub fn remove(text: &str, at: &At) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse()?;
    table(&mut document, at)?;
    if at.table.is_list() {
        list(&mut document, at.table)?.remove(at.index);
        if list(&mut document, at.table)?.is_empty() {
            document.remove(at.table.word());
        }
    } else if let Some(all) = document.get_mut(at.table.word()).and_then(Item::as_table_like_mut) {
        all.remove(&at.name);
    }
    Ok(document.to_string())
}

/// Moves a table to another index.
///
/// # Errors
/// [`EditError`].
pub fn move_to(text: &str, at: &At, to: usize) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse()?;
    table(&mut document, at)?;
    if !at.table.is_list() {
        return Ok(text.into());
    }
    let all = list(&mut document, at.table)?;
    let mut tables: Vec<Table> = std::mem::take(all).into_iter().collect();
    // Equal places keep their order.
    let first = tables.iter().filter_map(Table::position).min();
    for table in &mut tables {
        set_position(table, first);
    }
    let table = tables.remove(at.index);
    tables.insert(to.min(tables.len()), table);
    all.extend(tables);
    Ok(document.to_string())
}

/// Where a table and those within it stand in the text.
fn set_position(table: &mut Table, position: Option<isize>) {
    table.set_position(position);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(inner) => set_position(inner, position),
            Item::ArrayOfTables(all) => all.iter_mut().for_each(|inner| set_position(inner, position)),
            _ => {}
        }
    }
}

fn list(document: &mut DocumentMut, kind: Kind) -> Result<&mut ArrayOfTables, EditError> {
    let item = document.get_mut(kind.word()).ok_or_else(|| EditError::Missing(kind.word(), "0".into()))?;
    as_list(item, kind)
}

fn list_or_new(document: &mut DocumentMut, kind: Kind) -> Result<&mut ArrayOfTables, EditError> {
    as_list(document.entry(kind.word()).or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new())), kind)
}

/// `step = [{ … }]` becomes `[[step]]`.
fn as_list(item: &mut Item, kind: Kind) -> Result<&mut ArrayOfTables, EditError> {
    if item.is_array() {
        let tables = std::mem::take(item).into_array_of_tables();
        *item = tables.map_or_else(|same| same, Item::ArrayOfTables);
    }
    item.as_array_of_tables_mut().ok_or(EditError::Form(kind.word()))
}

fn table<'a>(document: &'a mut DocumentMut, at: &At) -> Result<&'a mut dyn TableLike, EditError> {
    let missing = |which: String| EditError::Missing(at.table.word(), which);
    match at.table {
        Kind::Parameters => {
            let all = document.entry("parameters").or_insert_with(|| Item::Table(Table::new()));
            all.as_table_like_mut().ok_or(EditError::Form("parameters"))
        }
        Kind::Primitive => {
            let all = document.get_mut("primitive").and_then(Item::as_table_like_mut);
            let one = all.and_then(|all| all.get_mut(&at.name)).and_then(Item::as_table_like_mut);
            one.ok_or_else(|| missing(at.name.clone()))
        }
        kind => {
            let one = list(document, kind).map_err(|e| match e {
                EditError::Missing(..) => missing(at.index.to_string()),
                e => e,
            })?;
            Ok(one.get_mut(at.index).ok_or_else(|| missing(at.index.to_string()))?)
        }
    }
}

/// Puts a value at a path of keys, or takes it out. What stands in the way gives way.
fn put(start: &mut dyn TableLike, path: &str, value: Option<Value>) {
    let mut table = start;
    let mut rest = path;
    while let Some((key, below)) = rest.split_once('.') {
        if value.is_none() && table.get(key).is_none_or(|item| item.as_table_like().is_none()) {
            return;
        }
        let item = table.entry(key).or_insert_with(|| Item::Value(InlineTable::new().into()));
        if item.as_table_like().is_none() {
            *item = Item::Value(InlineTable::new().into());
        }
        let Some(next) = item.as_table_like_mut() else { return };
        (table, rest) = (next, below);
    }
    let Some(mut value) = value else {
        table.remove(rest);
        return;
    };
    if let Some(old) = table.get(rest).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(rest, Item::Value(value));
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const TEXT: &str = "# mine\nversion = 2\n\n[[part]]\nname = \"a\" # first\nmesh = \"a.obj\"\n\n[[step]]\n# why\ndo = \"blend\"\nradius = 1 # mm\n[[step.radius_at]]\nat = [0, 0, 0]\nradius = 2\n\n[[step]]\ndo = \"cut\"\n";

    fn at(table: Kind, index: usize) -> At {
        At { table, index, name: String::new() }
    }

    fn one(table: Kind, index: usize, key: &str, value: Json) -> String {
        set(TEXT, &[Set { at: at(table, index), key: key.into(), value }]).unwrap()
    }

    #[test]
    fn one_value_changes_and_nothing_else() {
        assert_eq!(one(Kind::Step, 0, "radius", json!(3.5)), TEXT.replace("radius = 1 #", "radius = 3.5 #"));
        assert_eq!(one(Kind::Step, 0, "radius", json!("2%")), TEXT.replace("radius = 1 #", "radius = \"2%\" #"));
        assert_eq!(one(Kind::Step, 0, "nothing", Json::Null), TEXT);
        assert_eq!(one(Kind::Step, 1, "plane.normal", Json::Null), TEXT);
        let cut = one(Kind::Step, 1, "plane.normal", json!([0, 0, 1]));
        assert_eq!(cut, format!("{TEXT}plane = {{ normal = [0, 0, 1] }}\n"));
        assert!(set(TEXT, &[Set { at: at(Kind::Step, 2), key: "x".into(), value: json!(1) }]).is_err());
    }

    #[test]
    fn tables_come_and_go() {
        let options = json!({ "angle": 30 }).as_object().cloned().unwrap();
        let more = add(TEXT, Kind::Step, &[("do", json!("blend")), ("as", Json::Null)], &options, None).unwrap();
        assert_eq!(more, format!("{TEXT}\n[[step]]\ndo = \"blend\"\nangle = 30\n"));
        assert_eq!(remove(&more, &at(Kind::Step, 2)).unwrap(), TEXT);
        let first = add(TEXT, Kind::Output, &[("file", json!("x.obj"))], &Map::new(), None).unwrap();
        assert_eq!(remove(&first, &at(Kind::Output, 0)).unwrap(), TEXT);
        let swapped = move_to(TEXT, &at(Kind::Step, 1), 0).unwrap();
        let (cut, blend) = (swapped.find("cut").unwrap(), swapped.find("blend").unwrap());
        assert!(cut < blend && blend < swapped.find("radius_at").unwrap(), "{swapped}");
        assert!(swapped.contains("# why") && swapped.starts_with("# mine"));
        let before = add(TEXT, Kind::Step, &[("do", json!("pose"))], &Map::new(), Some(0)).unwrap();
        assert!(before.find("pose").unwrap() < before.find("blend").unwrap(), "{before}");
    }

    #[test]
    fn primitives_have_names() {
        let options = json!({ "shape": "box" }).as_object().cloned().unwrap();
        let text = add_primitive(TEXT, "neck", &options).unwrap();
        assert!(text.contains("[primitive.neck]\nshape = \"box\"\n"), "{text}");
        let neck = At { table: Kind::Primitive, index: 0, name: "neck".into() };
        let set = set(&text, &[Set { at: neck, key: "shape".into(), value: json!("cone") }]).unwrap();
        assert!(set.contains("[primitive.neck]\nshape = \"cone\"\n"), "{set}");
    }
}
