//! The options of all operations that a Blender property can hold, from the one definition.

use crate::Fault;
use crate::generated::Generated;
use fusion::operation::schema;
use serde_json::{Map, Value, json};

/// The generated file.
pub const OPTIONS: Generated = Generated { file: "crates/fusion-python/blender/options.json", chore: "blender", text };

/// The operations that the extension offers.
const OPERATIONS: [&str; 8] = ["blend", "boolean", "cluster", "compose", "cut", "detail", "remesh", "sharpen"];

/// Options that a reader looks for first, in this order; the others follow in order of their names.
const FIRST: [&str; 6] = ["radius", "edge_length", "profile", "angle", "overlap", "surface"];

/// How far inside an open end of a range the least and the largest value lie.
const INSIDE: f64 = 1e-4;

fn text() -> Result<String, Fault> {
    let schema = schema();
    let operations: Map<_, _> = OPERATIONS.iter().map(|name| ((*name).into(), operation(&schema, name))).collect();
    Ok(format!("{}\n", serde_json::to_string_pretty(&Value::Object(operations))?))
}

fn operation(schema: &Value, name: &str) -> Value {
    let definition = resolved(schema, &schema["properties"][name]);
    let properties = definition["properties"].as_object();
    let mut options: Vec<Value> =
        properties.into_iter().flatten().filter_map(|(name, property)| option(schema, name, property)).collect();
    options.sort_by_key(|o| FIRST.iter().position(|first| o["name"] == *first).unwrap_or(FIRST.len()));
    json!({ "summary": sentence(&definition["description"]), "options": options })
}

/// An option as the extension reads it; `None` for one that no property holds, such as a list of points.
fn option(schema: &Value, name: &str, property: &Value) -> Option<Value> {
    let mut option = kind(schema, property)?;
    let entries = option.as_object_mut()?;
    entries.insert("name".into(), name.into());
    entries.insert("meaning".into(), sentence(&property["description"]).into());
    entries.insert("default".into(), property["default"].clone());
    entries.insert("optional".into(), property["default"].is_null().into());
    Some(option)
}

fn kind(schema: &Value, property: &Value) -> Option<Value> {
    let property = resolved(schema, property);
    if let Some(title) = property["title"].as_str() {
        if title.starts_with("length") && !title.contains('`') {
            return Some(json!({ "kind": "length" }));
        }
        // Of words that take a value, such as `conic=W`, a list holds none.
        let words: Vec<_> =
            title.split('`').skip(1).step_by(2).filter(|word| !word.contains(['=', '"', ':'])).collect();
        if words.len() > 1 && !title.contains("length") {
            return Some(json!({ "kind": "word", "words": words.iter().map(|word| [word, ""]).collect::<Vec<_>>() }));
        }
    }
    if let Some(words) = property["oneOf"].as_array() {
        let words = words.iter().map(|word| Some(json!([word["const"].as_str()?, sentence(&word["description"])])));
        return Some(json!({ "kind": "word", "words": words.collect::<Option<Vec<_>>>()? }));
    }
    if let Some(some) = property["anyOf"].as_array() {
        return some.iter().filter(|one| one["type"] != "null").find_map(|one| kind(schema, one));
    }
    let kind = match &property["type"] {
        Value::Array(kinds) if kinds.iter().any(|kind| kind == "string") => return None,
        Value::Array(kinds) => kinds.iter().find(|kind| *kind != "null")?,
        kind => kind,
    };
    let mut number = json!({ "kind": match kind.as_str()? {
        "number" => "number",
        "integer" => "integer",
        "boolean" => "bool",
        _ => return None,
    }});
    let ends = [("minimum", "exclusiveMinimum", INSIDE), ("maximum", "exclusiveMaximum", -INSIDE)];
    for (end, open, inside) in ends {
        if let Some(value) = property[end].as_f64().or(property[open].as_f64().map(|value| value + inside)) {
            number[end] = value.into();
        }
    }
    Some(number)
}

fn resolved<'a>(schema: &'a Value, property: &'a Value) -> &'a Value {
    match property["$ref"].as_str().and_then(|reference| reference.strip_prefix("#/$defs/")) {
        Some(name) => resolved(schema, &schema["$defs"][name]),
        None => property,
    }
}

/// The first paragraph, without a full stop, which Blender adds.
fn sentence(description: &Value) -> String {
    let text = description.as_str().unwrap_or_default();
    text.split("\n\n").next().unwrap_or_default().replace('\n', " ").trim_end_matches('.').replace('`', "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_have_the_property_that_holds_them() {
        let schema = schema();
        for (operation, name, expected) in [
            ("Blend", "radius", Some("length")),
            ("Blend", "profile", Some("word")),
            ("Blend", "overlap", Some("word")),
            ("Blend", "chain", Some("bool")),
            ("Blend", "tolerance", Some("number")),
            ("Blend", "near", None),
            ("Blend", "curves", None),
            ("Cut", "plane", None),
            ("Detail", "fan", None),
            ("Compose", "crease", Some("number")),
            ("Remesh", "iterations", Some("integer")),
        ] {
            let made = option(&schema, name, &schema["$defs"][operation]["properties"][name]);
            let kind = made.as_ref().map(|option| option["kind"].as_str().unwrap_or_default());
            assert_eq!(kind, expected, "{operation}.{name}");
        }
    }

    #[test]
    fn open_ends_are_not_reached() {
        let schema = schema();
        let angle = option(&schema, "angle", &schema["$defs"]["Blend"]["properties"]["angle"]);
        let angle = angle.unwrap_or_default();
        assert!(angle["minimum"].as_f64() > Some(0.0) && angle["maximum"].as_f64() < Some(180.0));
    }
}
