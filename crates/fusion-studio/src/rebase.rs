//! A document's paths when its folder changes.

use crate::root::{below, from_folder};
use std::path::Path;
use toml_edit::{DocumentMut, Item, Value};

/// The same document for another folder: meshes and outputs stay the same files. Both folders are relative to the root.
pub fn rebased(text: &str, from: &str, to: &str) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.into() };
    if from == to {
        return text.into();
    }
    for (table, key) in [("part", "mesh"), ("output", "file")] {
        let tables = document.get_mut(table).and_then(Item::as_array_of_tables_mut);
        for table in tables.into_iter().flat_map(|tables| tables.iter_mut()) {
            let Some(value) = table.get_mut(key).and_then(Item::as_value_mut) else { continue };
            let Some(Ok(file)) = value.as_str().map(|path| below(from, Path::new(path))) else { continue };
            let mut moved = Value::from(from_folder(to, &file));
            *moved.decor_mut() = value.decor().clone();
            *value = moved;
        }
    }
    document.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_stay_the_same() {
        let text = "version = 2\n[[part]]\nname = \"a\"\nmesh = \"in/a.obj\" # mine\n[[output]]\nfile = \"../b.obj\"\n";
        let moved = rebased(text, "x", "y/z");
        assert!(moved.contains("mesh = \"../../x/in/a.obj\" # mine"), "{moved}");
        assert!(moved.contains("file = \"../../b.obj\""), "{moved}");
        assert_eq!(rebased(&moved, "y/z", "x"), text);
    }
}
