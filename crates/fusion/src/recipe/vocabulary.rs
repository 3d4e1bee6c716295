//! What every table of a recipe takes: the list behind `keys.rs`.

use super::keys::{Holds, Key, Table, key};

const NEEDED: &str = "needed";
const LENGTH: &str = "length";
const NUMBER: &str = "number";
const POINT: &str = "x, y, z";
const POINTS: &str = "list of x, y, z";
const TABLE: &str = "table";
const TABLES_OF: &str = "tables";
const TEXT: &str = "text";

/// How a ball is rolled.
const ROLLING: &[Key] = &[
    key("radius_at", TABLES_OF, "", "radii at places, between which it changes smoothly")
        .of(Holds::Tables("radius_at")),
    key("profile", "`arc`, `g2`, `chamfer`, `sharp`, `hermite`, `conic=W`", "`arc`", "the cross-section"),
    key("profile_at", TABLES_OF, "", "cross-sections at places, between which one changes into the next")
        .of(Holds::Tables("profile_at")),
    key("reach", "0.1 to 100", "", "distance of the section's apex from the ball's centre, in radii"),
    key("overlap", "`full`, `shrink`, `error`", "`full`", "where the ball does not fit"),
    key("surface", "`auto`, `stitch`, `field`, `keep`", "`auto`", "what carries the blend"),
    key("spine", "`contact`, `offset`", "`contact`", "how the path of the ball's centre is found"),
    key("alpha", "1 to 16", "1.75", "reach of the base patches, in radii"),
    key("tolerance", "1e-6 to 0.5", "0.005", "chord tolerance, as a share of the radius"),
];

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
            key("boolean", TABLES_OF, "", "booleans").of(Holds::Tables("boolean")),
            key("compose", TABLES_OF, "", "joins of openings").of(Holds::Tables("compose")),
            key("blend", TABLES_OF, "", "blends along feature curves").of(Holds::Tables("blend")),
            key("cluster", TABLES_OF, "", "polyhedra rounded by clusters").of(Holds::Tables("cluster")),
            key("detail", TABLES_OF, "", "geometry detail for smooth regions").of(Holds::Tables("detail")),
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
            key("cut", TABLES_OF, "", "cuts, in the file's own coordinates").of(Holds::Tables("cut")),
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
        name: "cut",
        heading: "`[[part.cut]]`",
        keys: &[&[
            key("plane", TABLE, "this or `path`", "what its normal points to is removed").of(Holds::Tables("plane")),
            key("path", POINTS, "this or `plane`", "picks of a closed path over the surface"),
            key(
                "seed",
                POINT,
                "",
                "of a plane: cuts only the contour nearest to it; of a path: the side nearest to it stays",
            ),
            key("keep", "`larger`, `smaller`", "`larger`", "of a path without a seed: the side that stays"),
            key("crease", "0 to 1000", "4", "of a path: how strongly creases attract it"),
            key(
                "snap",
                "0 to 0.25",
                "1e-6; 0.05 of a path",
                "crossings this near to a vertex move onto it, as a share of the edge",
            ),
            key("smooth", "whole number", "0", "rounds of smoothing of the rim"),
        ]],
    },
    Table {
        name: "plane",
        heading: "`plane` of a cut",
        keys: &[&[key("point", POINT, NEEDED, "in the plane"), key("normal", POINT, NEEDED, "of any length")]],
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
    Table {
        name: "boolean",
        heading: "`[[boolean]]`",
        keys: &[
            &[
                key("operation", "`union`, `difference`, `intersection`", "`union`", ""),
                key("parts", "list of names", "all there are", "in order"),
                key("name", TEXT, "the first part's", "what the result is called"),
                key(
                    "radius",
                    "length, or two",
                    "",
                    "blends the seam with a ball of this radius; of two, the first is kept from the first part",
                ),
            ],
            ROLLING,
        ],
    },
    Table {
        name: "compose",
        heading: "`[[compose]]`",
        keys: &[&[
            key("loops", "list of `\"part:loop\"` or `\"part\"`", "all open boundaries", "the openings"),
            key("method", "`implicit`, `montage`", "`implicit`", "how the field is held at the openings"),
            key("kernel", "`triharmonic`, `biharmonic`, `hermite`", "`triharmonic`", "of the field"),
            key(
                "rings",
                "0 to 16",
                "3; 1 for `hermite`, 0 for `montage`",
                "of vertices around each opening that the field interpolates",
            ),
            key("cell", "number above 0", "1", "of the tessellation, in mean edges of the openings"),
            key("edge_length", LENGTH, "that of the nearest openings", "of the surface away from them"),
            key(
                "space",
                "number above 0",
                "1",
                "how far from the openings the surface may go, in diagonals of their box",
            ),
            key(
                "crease",
                "degrees, or a table by names of openings",
                "0",
                "by how much the surface turns inward there; −90 to 90",
            ),
            key("adjust", LENGTH, "", "trims openings nearer than this to those of other parts"),
            key("name", TEXT, "the first part's", "what the result is called"),
            key("silhouette", TABLES_OF, "", "that the surface shall have").of(Holds::Tables("silhouette")),
        ]],
    },
    Table {
        name: "silhouette",
        heading: "`[[compose.silhouette]]`",
        keys: &[&[
            key("view", POINT, NEEDED, "direction of the view"),
            key("stroke", POINTS, "this or `strokes`", "one stroke"),
            key("strokes", "list of strokes", "this or `stroke`", "several that are chained"),
            key("hole", "`true`, `false`", "told by the strokes", "whether they outline a hole"),
            key("control", "two x, y, z", "", "other places for the two middle control points"),
            key("depth", "number, or two", "0", "moves of the two along the view; a hole takes one"),
        ]],
    },
    Table {
        name: "blend",
        heading: "`[[blend]]`",
        keys: &[
            &[
                key("part", "name", "the only one", ""),
                key(
                    "radius",
                    "length, or two",
                    NEEDED,
                    "of the ball; of two, from the left side of a curve and from the right one",
                ),
                key("angle", "0.1 to 179.9", "40", "least angle of a feature curve, in degrees"),
                key("near", POINTS, "", "only the feature curves nearest to these points"),
                key("curves", "path", "", "only the curves in this file, as `features -o` writes it"),
            ],
            ROLLING,
        ],
    },
    Table {
        name: "radius_at",
        heading: "`radius_at` of a blend or boolean",
        keys: &[&[key("at", POINT, NEEDED, "a point near the curve"), key("radius", LENGTH, NEEDED, "there")]],
    },
    Table {
        name: "profile_at",
        heading: "`profile_at` of a blend or boolean",
        keys: &[&[key("at", POINT, NEEDED, "a point near the curve"), key("profile", "as `profile`", NEEDED, "there")]],
    },
    Table {
        name: "cluster",
        heading: "`[[cluster]]`",
        keys: &[&[
            key("part", "name", "the only one", ""),
            key("continuity", "1 to 8", "1", "order of contact with the faces"),
            key("degree", "whole number, or two", "the least", "of the patches; two for clusters of four sides"),
            key("extent", "0.001 to 1", "0.7", "reach along open edges, as a share of the edge"),
            key("bulge", "0 to 0.99", "0", "0 for the fairest patches, towards 1 sharper ones"),
            key("sharp", "list of pairs of vertices", "", "edges that stay sharp"),
            key("all_sharp", "`true`, `false`", "`false`", "whether all edges between clusters stay sharp"),
            key("mu", "0.001 to 0.999", "0.5", "balance of the strips"),
            key("order", "0 to 8", "`continuity`", "order of contact of strips with patches"),
            key("tolerance", "1e-7 to 0.1", "0.0002", "chord tolerance, as a share of the diagonal"),
            key("clusters", TABLES_OF, "chosen", "the clusters").of(Holds::Tables("entry")),
        ]],
    },
    Table {
        name: "entry",
        heading: "`clusters` of a cluster",
        keys: &[&[
            key("vertices", "list of vertices", NEEDED, "the cluster's"),
            key("degree", "whole number, or two", "that of all", ""),
            key("extent", NUMBER, "that of all", ""),
            key("bulge", NUMBER, "that of all", ""),
            key("move", TABLES_OF, "", "control points moved by hand").of(Holds::Tables("move")),
        ]],
    },
    Table {
        name: "move",
        heading: "`move` of an entry of `clusters`",
        keys: &[&[
            key("point", "list of whole numbers", NEEDED, "its index"),
            key("by", POINT, NEEDED, "in model units"),
        ]],
    },
    Table {
        name: "detail",
        heading: "`[[detail]]`",
        keys: &[&[
            key(
                "source",
                "table, or several",
                NEEDED,
                "where detail is taken from; a part named here is that part as posed",
            )
            .of(Holds::Tables("region")),
            key(
                "target",
                TABLE,
                "what joins have made",
                "what gets detail; a part named here is what goes by that name by then",
            )
            .of(Holds::Tables("region")),
            key("mode", "`unstructured`, `structured`", "by `along`", "whether detail is continued along a curve"),
            key("along", POINTS, "", "a curve from detail into the target"),
            key("source_along", POINTS, "`along`", "the curve on a source elsewhere"),
            key("width", LENGTH, "the whole target", "of the band along the curve"),
            key("spacing", LENGTH, "a quarter of `width`", "of patches along the curve"),
            key("wavelength", LENGTH, "twelve mean edges", "what is shorter counts as detail"),
            key("fan", "length, `diagonal`, `edges`", "`diagonal`", "how far around a vertex similarity is judged"),
            key("search", "`indexed`, `exhaustive`", "`indexed`", ""),
            key("intensity", "−100 to 100", "1", "factor of the detail"),
        ]],
    },
    Table {
        name: "region",
        heading: "`source` or `target` of a detail",
        keys: &[&[
            key("part", "name", "the target's", ""),
            key("near", POINT, "this, `group` or `origin`", "the faces around the nearest surface point"),
            key("radius", LENGTH, "", "as far as this; `near` needs it"),
            key("group", "name", "", "the faces of a group of the part's file"),
            key("origin", "`transition`, `blend`", "", "what a stage has made"),
        ]],
    },
];
