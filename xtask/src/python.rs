//! The Python functions of all operations: signatures, types and docstrings from the one definition.

use crate::Fault;
use crate::generated::Generated;
use crate::python_types::{default, hint};
use fusion::operation::{
    Blend, Boolean, Cluster, Compose, Cut, Detail, OptionRow, Options, Pose, Remesh, Repair, Sharpen, option_rows,
    schema,
};
use serde_json::Value;
use std::fmt::Write;

/// The generated file.
pub const FUNCTIONS: Generated =
    Generated { file: "crates/fusion-python/python/fusion_mesh/_operations.py", chore: "python", text };

/// What a function takes beside options.
#[derive(Clone, Copy, PartialEq)]
enum Inputs {
    One,
    OneAndEdges,
    Several,
}

/// A function of the package. A new operation is one line in [`functions`].
struct Function {
    name: &'static str,
    operation: &'static str,
    rows: fn() -> Vec<OptionRow>,
    inputs: Inputs,
    /// An option that the function's name decides.
    fixed: Option<(&'static str, &'static str)>,
    /// Its first sentence; that of the operation where empty.
    summary: &'static str,
    example: &'static str,
}

fn function<O: Options>(name: &'static str, inputs: Inputs, example: &'static str) -> Function {
    Function { name, operation: O::NAME, rows: option_rows::<O>, inputs, fixed: None, summary: "", example }
}

fn boolean(name: &'static str, summary: &'static str, example: &'static str) -> Function {
    let fixed = Some(("operation", name));
    Function { fixed, summary, ..function::<Boolean>(name, Inputs::Several, example) }
}

fn functions() -> Vec<Function> {
    use Inputs::{One, OneAndEdges, Several};
    vec![
        boolean("union", "Join solids, and fillet the seams with a rolling ball.", UNION),
        boolean("difference", "Take solids from the first, and fillet the seams with a rolling ball.", DIFFERENCE),
        boolean("intersection", "Keep what solids share, and fillet the seams with a rolling ball.", INTERSECTION),
        function::<Blend>("blend", OneAndEdges, BLEND),
        function::<Sharpen>("sharpen", One, SHARPEN),
        function::<Compose>("compose", Several, COMPOSE),
        function::<Cut>("cut", One, CUT),
        function::<Detail>("detail", One, DETAIL),
        function::<Cluster>("cluster", One, CLUSTER),
        function::<Remesh>("remesh", One, REMESH),
        function::<Repair>("repair", One, REPAIR),
        function::<Pose>("pose", One, POSE),
    ]
}

/// Options that name what stands in documents alone.
const IN_DOCUMENTS: [(&str, &str); 2] = [("pose", "on"), ("pose", "snap")];

const UNION: &str = r#"both = fm.union(fm.box((2, 2, 2)), fm.box((1, 1, 3)), radius="2%", profile="g2")
both.report["validity"]["closed"]
True"#;
const DIFFERENCE: &str = r#"drilled = fm.difference(fm.box((2, 2, 2)), fm.box((1, 1, 3)))
round(fm.info(drilled)["volume"], 9)
6.0"#;
const INTERSECTION: &str = r#"shared = fm.intersection(fm.box((2, 2, 2)), fm.box((1, 1, 3)))
round(fm.info(shared)["volume"], 9)
2.0"#;
const BLEND: &str = r#"round = fm.blend(fm.box((1, 1, 1)), radius=0.1)
round.report["figures"]["strips"]
12.0"#;
const SHARPEN: &str = r#"round = fm.blend(fm.box((1, 1, 1)), fm.edges().near((0.5, 0.5, 0)), radius=0.2)
sharp = fm.sharpen(round, near=(0.45, 0.45, 0))
bool(abs(fm.info(sharp)["volume"] - 1) < 1e-9)
True"#;
const COMPOSE: &str = r#"upper = fm.cut(fm.sphere(1, (0, 0, 2)), plane=((0, 0, 1.5), (0, 0, -1)))
lower = fm.cut(fm.sphere(1, (0, 0, 0)), plane=((0, 0, 0.5), (0, 0, 1)))
whole = fm.compose(lower, upper)
whole.report["validity"]["closed"]
True"#;
const CUT: &str = r#"half = fm.cut(fm.sphere(1.0), plane=((0, 0, 0.1), (0, 0, 1)))
len(fm.info(half)["boundary_loops"])
1"#;
const DETAIL: &str = r#"ball = fm.sphere(1.0, segments=64)
up, down = {"near": (0, 0, 1), "radius": 0.4}, {"near": (0, 0, -1), "radius": 0.6}
same = fm.detail(ball, target=up, source=down)
len(same.vertices) == len(ball.vertices)
True"#;
const CLUSTER: &str = r#"round = fm.cluster(fm.box((1, 1, 1)))
round.report["figures"]["patches"]
8.0"#;
const REMESH: &str = r#"even = fm.remesh(fm.sphere(1.0), edge_length=0.2)
even.report["validity"]["closed"]
True"#;
const REPAIR: &str = r#"box = fm.box((1, 1, 1))
soup = fm.Mesh(box.vertices[box.faces].reshape(-1, 3), [[3 * f, 3 * f + 1, 3 * f + 2] for f in range(12)])
round(fm.info(fm.repair(soup))["volume"], 9)
1.0"#;
const POSE: &str = r"moved = fm.pose(fm.box((1, 1, 1)), rotate=((0, 0, 1), 45), translate=(0, 0, 2))
round(float(moved.vertices[:, 0].max()), 9)
0.707106781";

/// Options that a reader looks for first, in this order; the others follow in order of their names.
const FIRST: [&str; 11] =
    ["radius", "edge_length", "near", "plane", "path", "target", "source", "profile", "scale", "rotate", "translate"];

fn text() -> Result<String, Fault> {
    let schema = schema();
    let functions = functions();
    let mut text = String::from(HEAD);
    text.push_str("__all__ = [\n");
    let mut names: Vec<&str> = functions.iter().map(|f| f.name).collect();
    names.sort_unstable();
    names.iter().try_for_each(|name| writeln!(text, "    \"{name}\","))?;
    text.push_str("]\n");
    functions.iter().try_for_each(|function| function.write(&schema, &mut text))?;
    Ok(text)
}

const HEAD: &str = r#""""The operations. Written by ``cargo xtask python`` from their definitions; do not edit."""

from __future__ import annotations

from typing import Any, Dict, Literal, Optional, Sequence, Tuple, Union

from ._edges import Edges
from ._result import Result
from ._run import chosen, run
from ._types import FloatArray, Length, LoopName, MeshLike, Path, Point, Points, Progress, Radius, Region, Table

"#;

impl Function {
    fn write(&self, root: &Value, text: &mut String) -> std::fmt::Result {
        let name = root["properties"][self.operation]["$ref"].as_str().unwrap_or_default();
        let definition = &root["$defs"][name.trim_start_matches("#/$defs/")];
        let mut rows = (self.rows)();
        rows.retain(|row| self.fixed.is_none_or(|(fixed, _)| row.name != fixed));
        rows.retain(|row| !IN_DOCUMENTS.contains(&(self.name, row.name.as_str())));
        rows.sort_by_key(|row| FIRST.iter().position(|f| *f == row.name).unwrap_or(FIRST.len()));
        let property = |row: &OptionRow| &definition["properties"][&row.name];
        writeln!(text, "\n\ndef {}(", self.name)?;
        text.push_str(match self.inputs {
            Inputs::One => "    mesh: MeshLike,\n    *,\n",
            Inputs::OneAndEdges => "    mesh: MeshLike,\n    edges: Optional[Edges] = None,\n    *,\n",
            Inputs::Several => "    *meshes: MeshLike,\n",
        });
        for row in &rows {
            let property = property(row);
            writeln!(
                text,
                "    {}: {} = {},",
                row.name,
                hint(root, &row.name, property),
                default(&property["default"])
            )?;
        }
        if self.is_checked() {
            text.push_str("    precision: Literal[\"f64\", \"f32\"] = \"f64\",\n");
        }
        text.push_str("    threads: Optional[int] = None,\n    progress: Progress = None,\n) -> Result:\n");
        let operation = definition["description"].as_str().unwrap_or_default();
        let summary = if self.summary.is_empty() { format!("{operation}.") } else { self.summary.into() };
        self.document(&summary, &rows, text)?;
        text.push_str("    options: Dict[str, Any] = {\n");
        if let Some((option, value)) = self.fixed {
            writeln!(text, "        \"{option}\": \"{value}\",")?;
        }
        rows.iter().try_for_each(|row| writeln!(text, "        \"{0}\": {0},", row.name))?;
        text.push_str("    }\n");
        if self.inputs == Inputs::OneAndEdges {
            text.push_str("    options = chosen(edges, options)\n");
        }
        let (meshes, names) = match self.inputs {
            Inputs::Several => ("meshes", "[f\"meshes[{i}]\" for i in range(len(meshes))]"),
            _ => ("[mesh]", "[\"mesh\"]"),
        };
        let precision = if self.is_checked() { "precision" } else { "\"f64\"" };
        writeln!(
            text,
            "    return run(\"{}\", {meshes}, {names}, options, {precision}, threads, progress)",
            self.operation
        )
    }

    /// Whether its result is checked in the coordinates that are asked for; moving checks nothing.
    fn is_checked(&self) -> bool {
        self.operation != Pose::NAME
    }

    /// The docstring, in the manner of NumPy.
    fn document(&self, summary: &str, rows: &[OptionRow], text: &mut String) -> std::fmt::Result {
        writeln!(text, "    \"\"\"{summary}\n\n    Parameters\n    ----------")?;
        text.push_str(match self.inputs {
            Inputs::Several => {
                "    *meshes : mesh-like\n        Two or more, each anything that `as_mesh` takes; how they are posed is how they are.\n"
            }
            _ => "    mesh : mesh-like\n        Anything that `as_mesh` takes.\n",
        });
        if self.inputs == Inputs::OneAndEdges {
            text.push_str(
                "    edges : Edges, optional\n        Which edges; all over 40 degrees where not given. See `edges`.\n",
            );
        }
        for row in rows {
            let (takes, default) = (row.takes.replace('`', ""), row.default.replace('`', ""));
            let (takes, default) = match takes.as_str() {
                "true, false" if default.is_empty() => ("bool".into(), "False".into()),
                _ => (takes, default),
            };
            let ending = if default.is_empty() { "optional".into() } else { format!("default {default}") };
            writeln!(text, "    {} : {takes}, {ending}", row.name)?;
            wrap(&row.meaning.replace("\\|", "|"), text)?;
        }
        if self.is_checked() {
            text.push_str(PRECISION);
        }
        text.push_str(COMMON);
        for (k, line) in self.example.lines().enumerate() {
            let is_answer = k + 1 == self.example.lines().count();
            writeln!(text, "    {}{line}", if is_answer { "" } else { ">>> " })?;
        }
        text.push_str("    \"\"\"\n");
        Ok(())
    }
}

const PRECISION: &str = r#"    precision : f64 or f32, default f64
        The coordinates in which the result must be sound: ``"f32"`` for one that goes into STL or glTF.
"#;

const COMMON: &str = r"    threads : int, optional
        Number of threads; all processors where not given. The result has the same bits for any number.
    progress : callable or bool, optional
        Called with a stage's name and the share of it that is done; ends the job by an exception or by returning ``False``.
        ``True`` shows a bar.

    Returns
    -------
    Result
        The mesh, the report, and where every vertex and face came from.

    Raises
    ------
    UsageError
        An option has a value that it cannot have.
    InputError
        A mesh is not one, or a file cannot be read.
    InfeasibleError
        It is impossible on this input; says where and why.
    InvalidResultError
        The result failed its own validation.

    Examples
    --------
    >>> import fusion_mesh as fm
";

/// A sentence in lines, indented as a parameter's meaning.
fn wrap(sentence: &str, text: &mut String) -> std::fmt::Result {
    let mut line = String::from("       ");
    for word in sentence.split_whitespace() {
        if line.len() + word.len() >= 118 {
            writeln!(text, "{line}")?;
            line = String::from("       ");
        }
        line.push(' ');
        line.push_str(word);
    }
    let end = if sentence.ends_with('.') { "" } else { "." };
    writeln!(text, "{line}{end}")
}
