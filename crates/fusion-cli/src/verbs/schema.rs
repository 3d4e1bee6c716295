//! `schema`: documents, and every operation with its options, as JSON schema.

use crate::failure::Failure;
use crate::output::print;

/// Prints the schema.
pub fn run() -> Result<(), Failure> {
    print(&format!("{:#}\n", schema()))
}

/// That of operations, with documents among its definitions.
fn schema() -> serde_json::Value {
    let mut all = fusion::operation::schema();
    let mut document = fusion::document::schema();
    if let (Some(all), Some(more)) = (all["$defs"].as_object_mut(), document["$defs"].as_object_mut()) {
        all.append(more);
    }
    if let Some(document) = document.as_object_mut() {
        document.retain(|key, _| !key.starts_with('$'));
    }
    all["$defs"]["Document"] = document;
    all
}
