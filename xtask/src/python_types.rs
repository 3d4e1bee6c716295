//! Types and defaults of options, as Python writes them.

use serde_json::Value;

/// What an option takes, as a type of `fusion_mesh._types`.
pub fn hint(root: &Value, name: &str, schema: &Value) -> String {
    match name {
        // What the engine takes as arrays may be a mesh or a result here.
        "within" | "drop" => "Optional[MeshLike]".into(),
        "rotate" => "Optional[Union[Table, Tuple[Point, float]]]".into(),
        "seams" => "Optional[Union[Path, Result, Sequence[Optional[int]]]]".into(),
        "plane" => "Optional[Union[Table, Tuple[Point, Point]]]".into(),
        "source" => "Union[Region, Sequence[Region]]".into(),
        _ => of(root, schema),
    }
}

/// Types that have a name on the Python side.
const NAMED: [(&str, &str); 8] = [
    ("Length", "Length"),
    ("Radius", "Radius"),
    ("Curve", "Points"),
    ("LoopName", "LoopName"),
    ("RegionArg", "Region"),
    ("RegionOf", "Region"),
    ("Near", "Union[Point, Table]"),
    ("Edge", "Tuple[int, int]"),
];

fn of(root: &Value, schema: &Value) -> String {
    if let Some(name) = schema["$ref"].as_str().and_then(|r| r.strip_prefix("#/$defs/")) {
        let named = NAMED.iter().find(|(rust, _)| *rust == name);
        return named.map_or_else(|| of(root, &root["$defs"][name]), |(_, python)| (*python).into());
    }
    if let Some(words) = schema["oneOf"].as_array() {
        let words: Vec<String> = words.iter().filter_map(|w| Some(format!("\"{}\"", w["const"].as_str()?))).collect();
        return format!("Literal[{}]", words.join(", "));
    }
    if let Some(any) = schema["anyOf"].as_array() {
        return either(any.iter().map(|s| of(root, s)));
    }
    match &schema["type"] {
        Value::Array(kinds) => either(kinds.iter().map(|kind| {
            let mut one = schema.clone();
            one["type"] = kind.clone();
            of(root, &one)
        })),
        kind => match kind.as_str().unwrap_or_default() {
            "number" => "float".into(),
            "integer" => "int".into(),
            "boolean" => "bool".into(),
            // Text that is no word or number is mostly a file.
            "string" if schema["description"] == "In this file." => "Path".into(),
            "string" => "str".into(),
            "null" => "None".into(),
            "array" => list(root, schema),
            _ => "Table".into(),
        },
    }
}

fn list(root: &Value, schema: &Value) -> String {
    let item = of(root, &schema["items"]);
    match (item.as_str(), schema["maxItems"].as_u64()) {
        ("float", Some(3)) => "Point".into(),
        ("Point", None) => "Union[Point, Points]".into(),
        ("Union[Point, Table]", None) => "Union[Point, Table, Sequence[Union[Point, Table]], FloatArray]".into(),
        // A pair of numbers is one item, and not told from a list of numbers.
        ("Tuple[int, int]", _) | (_, Some(_)) => format!("Sequence[{item}]"),
        _ => format!("Union[{item}, Sequence[{item}]]"),
    }
}

fn either(kinds: impl Iterator<Item = String>) -> String {
    let mut kinds: Vec<String> = kinds.collect();
    let optional = kinds.iter().any(|kind| kind == "None");
    kinds.retain(|kind| kind != "None");
    kinds.dedup();
    let all = if kinds.len() == 1 { kinds.concat() } else { format!("Union[{}]", kinds.join(", ")) };
    if optional { format!("Optional[{all}]") } else { all }
}

/// A default as Python writes it.
pub fn default(value: &Value) -> String {
    match value {
        Value::Null => "None".into(),
        Value::Bool(true) => "True".into(),
        Value::Bool(false) => "False".into(),
        Value::Array(list) if list.is_empty() => "()".into(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fusion::operation::schema;

    #[test]
    fn options_have_python_types_and_defaults() {
        let root = schema();
        for (operation, option, takes, otherwise) in [
            ("Blend", "radius", "Optional[Radius]", "None"),
            ("Blend", "near", "Union[Point, Table, Sequence[Union[Point, Table]], FloatArray]", "()"),
            ("Blend", "overlap", "Literal[\"full\", \"shrink\", \"error\"]", "\"full\""),
            ("Blend", "chain", "bool", "False"),
            ("Blend", "tolerance", "float", "0.005"),
            ("Blend", "curves", "Optional[Union[Path, Union[Table, Sequence[Table]]]]", "None"),
            ("Cut", "seed", "Optional[Point]", "None"),
            ("Remesh", "iterations", "int", "5"),
            ("Compose", "loops", "Union[LoopName, Sequence[LoopName]]", "()"),
        ] {
            let property = &root["$defs"][operation]["properties"][option];
            assert_eq!(hint(&root, option, property), takes, "{operation}.{option}");
            assert_eq!(default(&property["default"]), otherwise, "{operation}.{option}");
        }
    }
}
