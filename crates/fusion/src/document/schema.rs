//! The JSON schema of documents.

use super::action::VERBS;
use crate::operation::{SetOperation, Words, schema as operations};
use serde_json::{Map, Value, json};

/// The JSON schema of documents, with the operations among its definitions.
///
/// ```
/// let schema = fusion::document::schema();
/// assert_eq!(schema["properties"]["version"]["const"], 2);
/// assert!(schema["$defs"]["Step"]["oneOf"].as_array().is_some_and(|verbs| verbs.len() == 12));
/// ```
pub fn schema() -> Value {
    let all = operations();
    let mut definitions = all["$defs"].as_object().cloned().unwrap_or_default();
    let steps: Vec<Value> = VERBS.iter().map(|verb| step(verb, &all, &definitions)).collect();
    definitions.insert("Step".into(), json!({ "oneOf": steps }));
    definitions.insert("Part".into(), part(&definitions));
    json!({
        "$schema": all["$schema"],
        "title": "Document",
        "type": "object",
        "required": ["version"],
        "additionalProperties": false,
        "properties": {
            "version": { "const": 2 },
            "parameters": { "type": "object" },
            "part": { "type": "array", "items": { "$ref": "#/$defs/Part" } },
            "primitive": { "type": "object", "additionalProperties": { "$ref": "#/$defs/Primitive" } },
            "step": { "type": "array", "items": { "$ref": "#/$defs/Step" } },
            "output": { "type": "array", "items": {
                "type": "object",
                "required": ["file"],
                "additionalProperties": false,
                "properties": { "of": { "type": "string" }, "file": { "type": "string" } },
            } },
        },
        "$defs": definitions,
    })
}

/// The options of a definition, and other keys before them. A parameter may stand for any option.
fn with_options(definition: &Value, hidden: &str, keys: Value, required: &[&str]) -> Value {
    let mut properties = match keys {
        Value::Object(keys) => keys,
        _ => Map::new(),
    };
    let parameter = json!({ "type": "string", "pattern": "^\\$" });
    for (name, option) in definition["properties"].as_object().into_iter().flatten().filter(|(name, _)| *name != hidden)
    {
        properties.insert(name.clone(), json!({ "anyOf": [option, parameter] }));
    }
    json!({ "type": "object", "required": required, "additionalProperties": false, "properties": properties })
}

fn step(verb: &str, all: &Value, definitions: &Map<String, Value>) -> Value {
    let boolean = SetOperation::WORDS.iter().any(|word| word.0 == verb);
    let operation = if boolean { "boolean" } else { verb };
    let reference = all["properties"][operation]["$ref"].as_str().unwrap_or_default();
    let name = reference.rsplit('/').next().unwrap_or_default();
    let keys = json!({
        "do": { "const": verb },
        "of": { "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }] },
        "as": { "type": "string" },
        "off": { "type": "boolean" },
    });
    let hidden = if boolean { "operation" } else { "loops" };
    with_options(definitions.get(name).unwrap_or(&Value::Null), hidden, keys, &["do"])
}

fn part(definitions: &Map<String, Value>) -> Value {
    let keys = json!({ "name": { "type": "string" }, "mesh": { "type": "string" } });
    with_options(definitions.get("Pose").unwrap_or(&Value::Null), "", keys, &["name", "mesh"])
}
