//! A shape's name replaced wherever it stands.

use crate::edit::EditError;
use toml_edit::{DocumentMut, Item, Key, TableLike, Value};

/// Keys whose values name shapes, or their loops: `name:loop`.
const KEYS: [&str; 7] = ["of", "as", "name", "part", "to", "loop", "drop"];

/// The text with another name for all shapes of one name.
///
/// # Errors
/// [`EditError`].
pub fn renamed(text: &str, old: &str, new: &str) -> Result<String, EditError> {
    let mut document: DocumentMut = text.parse()?;
    for table in ["part", "step", "output", "primitive"] {
        if let Some(item) = document.get_mut(table) {
            in_item(item, old, new);
        }
    }
    Ok(document.to_string())
}

fn in_item(item: &mut Item, old: &str, new: &str) {
    if let Some(all) = item.as_array_of_tables_mut() {
        all.iter_mut().for_each(|table| in_table(table, old, new));
    } else if let Some(table) = item.as_table_like_mut() {
        in_table(table, old, new);
    } else if let Some(all) = item.as_array_mut() {
        all.iter_mut().filter_map(Value::as_inline_table_mut).for_each(|table| in_table(table, old, new));
    }
}

fn in_table(table: &mut dyn TableLike, old: &str, new: &str) {
    for (key, item) in table.iter_mut() {
        if KEYS.contains(&key.get()) {
            match item {
                Item::Value(Value::Array(all)) => all.iter_mut().for_each(|value| in_value(value, old, new)),
                Item::Value(value) => in_value(value, old, new),
                _ => {}
            }
        }
        in_item(item, old, new);
    }
    // `crease` has loops for keys.
    let loops: Vec<String> =
        table.iter().map(|(key, _)| key.to_string()).filter(|key| loop_of(key, old).is_some()).collect();
    for key in loops {
        let (Some(item), Some(index)) = (table.remove(&key), loop_of(&key, old)) else { continue };
        table.insert(Key::new(format!("{new}:{index}")).get(), item);
    }
}

fn in_value(value: &mut Value, old: &str, new: &str) {
    let Some(text) = value.as_str() else { return };
    let text = match loop_of(text, old) {
        Some(index) => format!("{new}:{index}"),
        None if text == old => new.to_string(),
        None => return,
    };
    let mut renamed = Value::from(text);
    *renamed.decor_mut() = value.decor().clone();
    *value = renamed;
}

/// The number of a loop of a shape.
fn loop_of<'a>(text: &'a str, shape: &str) -> Option<&'a str> {
    text.strip_prefix(shape)?.strip_prefix(':').filter(|index| index.bytes().all(|b| b.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_refers_to_a_shape_follows() {
        let text = "version = 2\n[[part]]\nname = \"a\" # one\nmesh = \"a\"\n[[part]]\nname = \"ab\"\nmesh = \"b\"\n\
            [primitive.p]\nshape = \"cone\"\nloop = \"a:1\"\n[[step]]\ndo = \"compose\"\nof = [\"a:0\", \"ab\"]\ncrease = { \"a:0\" = 30 }\n\
            [[step]]\ndo = \"pose\"\nof = \"a\"\nsnap = { loop = 0, to = \"a:2\" }\n[[output]]\nof = \"a\"\nfile = \"a.obj\"\n";
        let new = renamed(text, "a", "head").unwrap();
        let expected = text
            .replace("name = \"a\" #", "name = \"head\" #")
            .replace("\"a:", "\"head:")
            .replace("of = \"a\"", "of = \"head\"");
        assert_eq!(new, expected);
        assert_eq!(renamed(&new, "head", "a").unwrap(), text);
    }
}
