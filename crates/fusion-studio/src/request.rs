//! What a client may ask; PROTOCOL.md says it in words.

use crate::edit::{At, Kind, Set};
use serde::Deserialize;
use serde_json::{Map, Value as Json};

/// One request.
#[derive(Debug)]
pub enum Request {
    /// Whatever changes the document.
    Edit(Edit),
    /// Whatever does not.
    Ask(Question),
}

impl Request {
    /// Reads a request.
    ///
    /// # Errors
    /// A sentence.
    pub fn read(json: Json) -> Result<Self, String> {
        match Edit::deserialize(&json) {
            Ok(edit) => Ok(Self::Edit(edit)),
            Err(e) if e.to_string().starts_with("unknown variant") => {
                Question::deserialize(json).map(Self::Ask).map_err(|e| format!("this is no request: {e}"))
            }
            Err(e) => Err(format!("this is no request: {e}")),
        }
    }
}

/// What changes the document.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub enum Edit {
    /// An empty document.
    New,
    /// One from a file.
    Open {
        /// Relative to the root.
        path: String,
    },
    /// Writes it to its file.
    Save {
        /// Relative to the root.
        path: Option<String>,
    },
    /// The whole text.
    Text {
        /// TOML.
        text: String,
    },
    /// A part.
    AddPart {
        /// Relative to the root.
        mesh: String,
        /// Its name.
        name: Option<String>,
        /// Its pose.
        #[serde(default)]
        options: Map<String, Json>,
    },
    /// A primitive.
    AddPrimitive {
        /// Its name.
        name: String,
        /// Its keys.
        #[serde(default)]
        options: Map<String, Json>,
    },
    /// A step.
    AddStep {
        /// Its operation.
        verb: String,
        /// Its shapes.
        of: Option<Vec<String>>,
        /// What its result is called.
        #[serde(rename = "as")]
        name: Option<String>,
        /// Its options.
        #[serde(default)]
        options: Map<String, Json>,
        /// Its index.
        at: Option<usize>,
    },
    /// An output.
    AddOutput {
        /// The shape.
        of: String,
        /// Relative to the root.
        file: String,
    },
    /// One value.
    Set {
        /// Which.
        #[serde(flatten)]
        set: Set,
        /// Edits of one drag are one point of undo.
        drag: Option<u64>,
    },
    /// Several values.
    SetAll {
        /// Which.
        edits: Vec<Set>,
        /// As above.
        drag: Option<u64>,
    },
    /// Another name for a shape.
    Rename {
        /// Part or step.
        table: Kind,
        /// Its index.
        index: usize,
        /// The name.
        to: String,
    },
    /// Takes a table out.
    Remove(At),
    /// Moves a table.
    Move {
        /// Which.
        #[serde(flatten)]
        at: At,
        /// Its new index.
        to: usize,
    },
    /// One state back.
    Undo,
    /// One state forward.
    Redo,
}

/// What changes nothing.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub enum Question {
    /// Everything again.
    State,
    /// Shapes to be sent besides the results.
    Show {
        /// Shapes.
        names: Vec<String>,
    },
    /// Stops the evaluation.
    Cancel,
    /// A shape as a file.
    Export {
        /// The shape.
        of: String,
        /// Relative to the root.
        file: String,
    },
    /// Feature curves of a shape, or those that a step could blend.
    Curves {
        /// Which step; else of a shape.
        step: Option<usize>,
        /// Which shape.
        #[serde(default)]
        shape: String,
        /// What the client sees of it.
        revision: Option<String>,
        /// Least dihedral angle, in degrees.
        angle: Option<f64>,
    },
    /// Boundary loops.
    Loops(Of),
    /// Counts, measures, defects.
    Info(Of),
    /// The largest radius that works.
    MaxRadius {
        /// Of which step; else of curves of a shape.
        step: Option<usize>,
        /// Which shape.
        #[serde(default)]
        shape: String,
        /// Which curves.
        #[serde(default)]
        curves: Vec<usize>,
        /// The angle at which they were listed.
        angle: Option<f64>,
    },
    /// An exact point.
    Pick {
        /// Of which shape.
        #[serde(flatten)]
        of: Of,
        /// The face.
        face: u32,
        /// Barycentrics.
        bary: [f64; 3],
    },
    /// A distance and an angle.
    Measure(Measure),
    /// Triangle quality at vertices.
    Quality(Of),
    /// Mean curvature at vertices.
    Curvature(Of),
    /// Files below the root.
    Files,
}

/// A shape that the client sees.
#[derive(Clone, Debug, Deserialize)]
pub struct Of {
    /// Its name.
    pub shape: String,
    /// What the client sees of it; another one is refused.
    pub revision: Option<String>,
}

/// Two picks.
#[derive(Debug, Deserialize)]
pub struct Measure {
    /// The first shape, face and barycentrics.
    pub shape_a: String,
    /// See above.
    pub face_a: u32,
    /// See above.
    pub bary_a: [f64; 3],
    /// The second shape, face and barycentrics.
    pub shape_b: String,
    /// See above.
    pub face_b: u32,
    /// See above.
    pub bary_b: [f64; 3],
}
