//! Values between JSON and TOML.

use serde_json::{Map, Number, Value as Json};
use toml_edit::{Array, InlineTable, Item, Table, TableLike, Value};

/// A JSON value as TOML; `None` where it is null or a number that TOML cannot hold. Null entries of objects are left out.
pub fn to_toml(json: &Json) -> Option<Value> {
    match json {
        Json::Null => None,
        Json::Bool(is) => Some((*is).into()),
        Json::Number(n) => n.as_i64().map(Value::from).or_else(|| n.as_f64().map(Value::from)),
        Json::String(text) => Some(text.as_str().into()),
        Json::Array(all) => Some(Value::Array(all.iter().map(to_toml).collect::<Option<Array>>()?)),
        Json::Object(entries) => {
            let mut table = InlineTable::new();
            for (key, value) in entries.iter().filter(|(_, value)| !value.is_null()) {
                table.insert(key, to_toml(value)?);
            }
            Some(table.into())
        }
    }
}

/// What stands in a document as JSON; dates are texts, numbers that JSON cannot hold null.
pub fn to_json(item: &Item) -> Json {
    match item {
        Item::None => Json::Null,
        Item::Value(value) => value_to_json(value),
        Item::Table(table) => table_to_json(table),
        Item::ArrayOfTables(all) => all.iter().map(|table: &Table| table_to_json(table)).collect(),
    }
}

/// The same for a table.
pub fn table_to_json(table: &dyn TableLike) -> Json {
    Json::Object(table.iter().map(|(key, item)| (key.to_string(), to_json(item))).collect::<Map<_, _>>())
}

fn value_to_json(value: &Value) -> Json {
    match value {
        Value::String(text) => text.value().as_str().into(),
        Value::Integer(n) => (*n.value()).into(),
        Value::Float(x) => Number::from_f64(*x.value()).map_or(Json::Null, Json::Number),
        Value::Boolean(is) => (*is.value()).into(),
        Value::Datetime(date) => date.value().to_string().into(),
        Value::Array(all) => all.iter().map(value_to_json).collect(),
        Value::InlineTable(table) => table_to_json(table),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_goes_in_comes_out() {
        let json = json!({ "a": [1, 2.5, "x"], "b": { "c": true, "d": [[0.1, -0.0, 1e300]] } });
        let toml = to_toml(&json).unwrap();
        let text = format!("x = {toml}");
        let document: toml_edit::DocumentMut = text.parse().unwrap();
        assert_eq!(to_json(&document["x"]), json);
        assert!(to_toml(&json!([null])).is_none());
    }
}
