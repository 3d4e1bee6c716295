//! The JSON schema of all operations, and the rows that pages are made of.

use super::option_error::short;
use super::options::Options;
use super::{Blend, Boolean, Cluster, Compose, Cut, Detail, Pose, Primitive, Remesh, Repair, Sharpen};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value, json};

/// The JSON schema of every operation, by its name.
///
/// ```
/// let schema = fusion::operation::schema();
/// assert_eq!(schema["properties"]["blend"]["$ref"], "#/$defs/Blend");
/// assert_eq!(schema["$defs"]["Blend"]["properties"]["angle"]["default"], 40.0);
/// ```
pub fn schema() -> Value {
    let mut generator = SchemaGenerator::default();
    let mut properties = Map::new();
    let mut add = |name: &str, schema: Schema| properties.insert(name.into(), schema.to_value());
    add(Blend::NAME, generator.subschema_for::<Blend>());
    add(Boolean::NAME, generator.subschema_for::<Boolean>());
    add(Cluster::NAME, generator.subschema_for::<Cluster>());
    add(Compose::NAME, generator.subschema_for::<Compose>());
    add(Cut::NAME, generator.subschema_for::<Cut>());
    add(Detail::NAME, generator.subschema_for::<Detail>());
    add(Pose::NAME, generator.subschema_for::<Pose>());
    add(Remesh::NAME, generator.subschema_for::<Remesh>());
    add(Repair::NAME, generator.subschema_for::<Repair>());
    add(Sharpen::NAME, generator.subschema_for::<Sharpen>());
    generator.subschema_for::<Primitive>();
    let mut definitions = generator.take_definitions(true);
    for definition in definitions.values_mut() {
        // Examples are for readers of the library.
        let whole = definition["description"].as_str().map(first_paragraph);
        if let Some(whole) = whole {
            definition["description"] = whole.into();
        }
    }
    json!({
        "$schema": generator.settings().meta_schema.as_deref(),
        "title": "Operations",
        "type": "object",
        "properties": properties,
        "$defs": definitions,
    })
}

/// An option as a reader of a page needs it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OptionRow {
    /// Its name.
    pub name: String,
    /// What it takes.
    pub takes: String,
    /// What it is where left out; empty for what is not there then.
    pub default: String,
    /// Its first sentence.
    pub meaning: String,
}

/// Every option of an operation, in order of their names.
pub fn option_rows<O: JsonSchema>() -> Vec<OptionRow> {
    let mut generator = SchemaGenerator::default();
    let root = generator.root_schema_for::<O>().to_value();
    let properties = root["properties"].as_object().into_iter().flatten();
    let row = |(name, property): (&String, &Value)| OptionRow {
        name: name.clone(),
        takes: takes(&root, property),
        default: default(&property["default"]),
        meaning: first_paragraph(property["description"].as_str().unwrap_or_default()).replace('|', "\\|"),
    };
    properties.map(row).collect()
}

fn first_paragraph(text: &str) -> String {
    text.split("\n\n").next().unwrap_or_default().replace('\n', " ")
}

fn default(value: &Value) -> String {
    match value {
        Value::Null | Value::Bool(false) => String::new(),
        Value::Array(list) if list.is_empty() => String::new(),
        Value::String(word) => format!("`{word}`"),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), short),
        other => other.to_string(),
    }
}

/// What a schema takes, in words.
fn takes(root: &Value, schema: &Value) -> String {
    if let Some(name) = schema["$ref"].as_str().and_then(|r| r.strip_prefix("#/$defs/")) {
        return takes(root, &root["$defs"][name]);
    }
    if let Some(title) = schema["title"].as_str() {
        return title.into();
    }
    let words = |list: &Value, key: &str| {
        let words = list.as_array()?.iter().map(|w| Some(format!("`{}`", w[key].as_str()?)));
        words.collect::<Option<Vec<_>>>().map(|w| w.join(", "))
    };
    if let Some(words) = words(&schema["oneOf"], "const") {
        return words;
    }
    let any = schema["anyOf"].as_array().or(schema["allOf"].as_array());
    if let Some(some) = any.into_iter().flatten().find(|s| s["type"] != "null") {
        return takes(root, some);
    }
    let kind = match &schema["type"] {
        Value::Array(kinds) => kinds.iter().find(|k| *k != "null").unwrap_or(&Value::Null),
        kind => kind,
    };
    let ends = ["minimum", "maximum"].map(|end| schema[end].as_f64());
    match (kind.as_str(), ends) {
        (Some("number"), [Some(least), Some(most)]) => format!("{} to {}", short(least), short(most)),
        (Some("integer"), [Some(least), Some(most)]) if most < 1e9 => format!("{least} to {most}"),
        (Some("number"), _) => match (schema["exclusiveMinimum"].as_f64(), schema["exclusiveMaximum"].as_f64()) {
            (Some(least), Some(most)) => format!("between {} and {}", short(least), short(most)),
            (Some(0.0), None) => "number above 0".into(),
            _ => "number".into(),
        },
        (Some("integer"), _) => "whole number".into(),
        (Some("boolean"), _) => "`true`, `false`".into(),
        (Some("string"), _) => "text".into(),
        (Some("array"), _) if schema["items"]["type"] == "number" && schema["maxItems"] == 3 => "x, y, z".into(),
        (Some("array"), _) => {
            let item = takes(root, &schema["items"]);
            format!("list of {}", if item == "whole number" { "whole numbers".into() } else { item })
        }
        _ => {
            let keys = schema["properties"].as_object().into_iter().flatten();
            let keys: Vec<String> = keys.map(|(key, value)| format!("`{key}` ({})", takes(root, value))).collect();
            if keys.is_empty() { "table".into() } else { format!("tables of {}", keys.join(", ")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_tell_ranges_words_and_defaults() {
        let rows = option_rows::<Blend>();
        let row = |name: &str| {
            let row = rows.iter().find(|r| r.name == name).unwrap();
            (row.takes.clone(), row.default.clone())
        };
        for (name, takes, default) in [
            ("radius", "length, or two", ""),
            ("alpha", "1 to 16", "1.75"),
            ("tolerance", "1e-6 to 0.5", "0.005"),
            ("overlap", "`full`, `shrink`, `error`", "`full`"),
            ("angle", "between 0 and 180", "40"),
            ("ids", "list of whole numbers", ""),
            ("along", "list of x, y, z", ""),
            ("curves", "path", ""),
            ("chain", "`true`, `false`", ""),
            ("reach", "0.1 to 100", ""),
        ] {
            assert_eq!(row(name), (takes.into(), default.into()), "{name}");
        }
    }
}
