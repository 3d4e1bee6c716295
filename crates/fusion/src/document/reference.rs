//! What every table of a document takes, as it stands in docs/documents.md.

use crate::operation::{
    Blend, Boolean, Cluster, Compose, Cut, Detail, On, OptionRow, Options, Pose, Primitive, Remesh, Repair, Rotation,
    Sharpen, Snap, option_rows,
};
use schemars::JsonSchema;
use std::fmt::Write;

const TOP: &[[&str; 4]] = &[
    ["version", "`2`", "needed", "of the language"],
    ["parameters", "table", "", "values by names, which other tables refer to as `\"$name\"`"],
    ["part", "tables", "", "the parts"],
    ["primitive", "tables by name", "", "what shapes ride on"],
    ["step", "tables", "", "what is done, in order"],
    ["output", "tables", "", "what is written"],
];
const PART: &[[&str; 4]] = &[
    ["name", "text", "needed", "what steps call it; no colon"],
    ["mesh", "path", "needed", "its file, relative to the document"],
];
const STEP: &[[&str; 4]] = &[
    ["do", "verb", "needed", "what is done"],
    [
        "of",
        "name, or list of names",
        "the only shape that is left; for `union`, `difference`, `intersection` and `compose` all that are left",
        "the shapes, or for `compose` their loops, `\"name:loop\"`",
    ],
    ["as", "text", "the first shape's name", "what the result is called"],
    ["off", "`true`, `false`", "", "passes the step over: its result is its first shape"],
];
const OUTPUT: &[[&str; 4]] = &[
    ["of", "name", "the only shape that is left", "the shape"],
    ["file", "path", "needed", "where it goes, relative to the document; the extension tells the format"],
];

/// What every table takes.
pub fn reference() -> String {
    let mut text = String::new();
    table(&mut text, "Top of the file", TOP, vec![]);
    table(&mut text, "`[[part]]`, and all that `pose` takes", PART, vec![]);
    table(&mut text, "`[[step]]`, and all that its verb takes", STEP, vec![]);
    table(&mut text, "`[[output]]`", OUTPUT, vec![]);
    rows::<Primitive>(&mut text, "`[primitive.NAME]`", &[]);
    rows::<Rotation>(&mut text, "`rotate` of a part or pose", &[]);
    rows::<On>(&mut text, "`on` of a part, a pose or a primitive", &[]);
    rows::<Snap>(&mut text, "`snap` of a part or pose", &[]);
    operation::<Pose>(&mut text);
    operation::<Cut>(&mut text);
    rows::<Boolean>(&mut text, "`do = \"union\"`, `\"difference\"`, `\"intersection\"`", &["operation"]);
    rows::<Compose>(&mut text, "`do = \"compose\"`", &["loops"]);
    operation::<Blend>(&mut text);
    operation::<Sharpen>(&mut text);
    operation::<Detail>(&mut text);
    operation::<Cluster>(&mut text);
    operation::<Remesh>(&mut text);
    operation::<Repair>(&mut text);
    text.push('\n');
    text
}

fn operation<O: Options>(text: &mut String) {
    rows::<O>(text, &format!("`do = \"{}\"`", O::NAME), &[]);
}

fn rows<T: JsonSchema>(text: &mut String, heading: &str, hidden: &[&str]) {
    let rows = option_rows::<T>().into_iter().filter(|row| !hidden.contains(&row.name.as_str()));
    table(text, heading, &[], rows.collect());
}

fn table(text: &mut String, heading: &str, keys: &[[&str; 4]], rows: Vec<OptionRow>) {
    // Writing to a string does not fail.
    let _ = write!(text, "\n{heading}\n\n| key | takes | where left out | |\n|---|---|---|---|\n");
    for [name, takes, default, meaning] in keys {
        let _ = writeln!(text, "| `{name}` | {takes} | {default} | {meaning} |");
    }
    for OptionRow { name, takes, default, meaning } in rows {
        let _ = writeln!(text, "| `{name}` | {takes} | {default} | {meaning} |");
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse::TOP as KEYS;
    use super::*;

    #[test]
    fn the_page_lists_what_is_read() {
        let names = |rows: &[[&'static str; 4]]| rows.iter().map(|r| r[0]).collect::<Vec<_>>();
        assert_eq!(names(TOP), KEYS);
        assert_eq!(names(STEP), ["do", "of", "as", "off"]);
    }
}
