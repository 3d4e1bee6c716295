//! What every table of a recipe takes: the list behind `keys.rs`.

use super::keys::{Holds, Table, key};

const NEEDED: &str = "needed";
const NUMBER: &str = "number";
const POINT: &str = "x, y, z";
const TABLE: &str = "table";
const TABLES_OF: &str = "tables";
const TEXT: &str = "text";

/// The keys of a boolean that are no options of it.
pub(super) const PIECES_OF_BOOLEAN: &[[&str; 4]] = &[
    ["parts", "list of names", "all there are", "in order"],
    ["name", TEXT, "the first part's", "what the result is called"],
];
/// The same of a join of openings.
pub(super) const PIECES_OF_COMPOSE: &[[&str; 4]] = &[["name", TEXT, "the first part's", "what the result is called"]];
/// The same of a blend.
pub(super) const PIECES_OF_BLEND: &[[&str; 4]] = &[["part", "name", "the only one", ""]];

/// The top of the file comes first.
pub(super) const TABLES: &[Table] = &[
    Table {
        name: "recipe",
        heading: "Top of the file",
        keys: &[&[
            key("version", "`1`", NEEDED, "of the language"),
            key("output", "path", NEEDED, "where the result goes, relative to the recipe"),
            key(
                "steps",
                "list of steps",
                "cut, pose, boolean, compose, blend, cluster, detail",
                "the steps taken, in this order",
            ),
            key("part", TABLES_OF, NEEDED, "the parts, one or more").of(Holds::Tables("part")),
            key("primitive", "tables by name", "", "what parts ride on").of(Holds::Named("primitive")),
            key("boolean", TABLES_OF, "", "booleans"),
            key("compose", TABLES_OF, "", "joins of openings"),
            key("blend", TABLES_OF, "", "blends along feature curves"),
            key("cluster", TABLES_OF, "", "polyhedra rounded by clusters"),
            key("detail", TABLES_OF, "", "geometry detail for smooth regions"),
        ]],
    },
    Table {
        name: "part",
        heading: "`[[part]]`",
        keys: &[&[
            key("name", TEXT, NEEDED, "what other tables call it"),
            key("mesh", "path", NEEDED, "its file, relative to the recipe"),
            key("scale", "number above 0", "1", "about the origin, first"),
            key("rotate", TABLE, "", "about an axis through the origin, second").of(Holds::Tables("rotate")),
            key("translate", POINT, "0, 0, 0", "third"),
            key("on", TABLE, "", "sets it on a primitive, after its own pose").of(Holds::Tables("on")),
            key("snap", TABLE, "", "makes an opening face another or a primitive, last of all")
                .of(Holds::Tables("snap")),
            key("cut", TABLES_OF, "", "cuts, in the file's own coordinates"),
        ]],
    },
    Table {
        name: "rotate",
        heading: "`rotate` of a part",
        keys: &[&[
            key("axis", POINT, NEEDED, "of any length"),
            key("angle", "degrees", NEEDED, "counter-clockwise seen against the axis"),
        ]],
    },
    Table {
        name: "on",
        heading: "`on` of a part or primitive",
        keys: &[&[
            key("primitive", "name", NEEDED, "what it rides on"),
            key("at", "u, v", NEEDED, "the place, see below"),
            key("spin", "degrees", "0", "about the surface's normal"),
            key("offset", NUMBER, "0", "out of the surface"),
            key("loop", "whole number", "", "of a part: the opening whose middle comes to the place, facing it"),
        ]],
    },
    Table {
        name: "snap",
        heading: "`snap` of a part",
        keys: &[&[
            key("to", "`\"part:loop\"` or a primitive", NEEDED, "what it faces"),
            key("loop", "whole number", "0", "its own opening"),
            key("gap", NUMBER, "two edges of the other loop; 0 on a primitive", "how far apart they are left"),
        ]],
    },
    Table {
        name: "primitive",
        heading: "`[primitive.NAME]`",
        keys: &[&[
            key("shape", "`box`, `cylinder`, `sphere`, `cone`", NEEDED, ""),
            key("base", POINT, "0, 0, 0", "the middle of its base, or of a sphere"),
            key("axis", POINT, "0, 0, 1", "from base to top, of any length"),
            key(
                "radius",
                "number, or two of a cone",
                "that of `loop`",
                "at the base and at the top; all shapes but a box need it",
            ),
            key("height", NUMBER, "", "of a cylinder or cone, which need it"),
            key("size", POINT, "", "extents of a box, which needs them; the last is along the axis"),
            key("loop", "`\"part:loop\"`", "", "the opening it stands on"),
            key("on", TABLE, "", "the primitive it stands on").of(Holds::Tables("on")),
        ]],
    },
];
