//! Documents: whole models as TOML text, evaluated step by step, and again only where something changed.
//!
//! [`Document::evaluate`] shows one. The same from a program:
//!
//! ```
//! use fusion::document::{Cache, Document, Given, Precisions};
//! use fusion::mesh_core::{Watch, shapes};
//! use fusion::operation::{Blend, Pose};
//! use std::path::Path;
//! let mut document = Document::new();
//! document.push_part("cube", Path::new("cube"), &Pose::default().with_scale(2.0))?;
//! document.push_step(&["cube"], Blend::default().with_radius(0.2), Some("round"))?;
//! let mut meshes = Given::default();
//! meshes.0.insert("cube".into(), std::sync::Arc::new(shapes::cuboid(glam::DVec3::ONE).into()));
//! let made = document.evaluate_from(&mut meshes, &Cache::default(), Precisions::ByFile, &Watch::default())?;
//! assert_eq!(made.steps[0].report.figures["strips"], 12.0);
//! assert_eq!(Document::parse(&document.to_toml())?.to_toml(), document.to_toml());
//! # Ok::<(), fusion::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `parse.rs` | a document from its text |
//! | `parts.rs`, `action.rs` | what may stand in one: parts, primitives, steps, outputs; what a step does |
//! | `parameters.rs` | values that options refer to |
//! | `names.rs` | which shape every name means |
//! | `table.rs`, `error.rs` | tables whose keys know their place; what is wrong, by line, column and key |
//! | `edit.rs` | values set; parts, steps and outputs added |
//! | `evaluate.rs` | the steps taken in order |
//! | `shapes.rs` | every shape on the way, for those who look at it |
//! | `task.rs`, `place.rs` | one step made ready; where a pose takes a shape |
//! | `shape.rs` | a named shape on its way |
//! | `sources.rs` | where meshes and files come from |
//! | `cache.rs`, `store.rs` | results kept in memory and in a folder |
//! | `key.rs`, `entry.rs` | what a result depends on; a result as bytes |
//! | `reference.rs`, `schema.rs` | what every table takes, for a page and as JSON schema |

mod action;
mod cache;
mod edit;
mod entry;
mod error;
mod evaluate;
mod key;
mod names;
mod parameters;
mod parse;
mod parts;
mod place;
mod reference;
mod schema;
mod shape;
mod shapes;
mod sources;
mod store;
mod table;
mod task;

pub use action::Action;
pub use cache::Cache;
pub use error::Error;
pub use evaluate::{Evaluated, Evaluation, Precisions, Taken};
pub use parts::{Output, Part, Step};
pub use reference::reference;
pub use schema::schema;
pub use shapes::{Shapes, Shown, Stopped};
pub use sources::{Folder, Given, Sources};

use parts::Named;
use std::collections::BTreeMap;

/// A whole model: parts, what is done with them, and what comes out.
#[derive(Clone, Debug, Default)]
pub struct Document {
    text: String,
    parameters: BTreeMap<String, toml::Value>,
    unused: Vec<String>,
    parts: Vec<Part>,
    /// The parts in an order in which each stands on what stands already.
    order: Vec<usize>,
    primitives: BTreeMap<String, Named>,
    steps: Vec<Step>,
    outputs: Vec<Output>,
    left: Vec<String>,
}

impl Document {
    /// The parameters by their names.
    pub fn parameters(&self) -> &BTreeMap<String, toml::Value> {
        &self.parameters
    }

    /// The parameters that nothing refers to.
    pub fn unused_parameters(&self) -> &[String] {
        &self.unused
    }

    /// The parts in order.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The steps in order.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The outputs in order.
    pub fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// The shapes that no step has taken up, in order.
    pub fn left_over(&self) -> &[String] {
        &self.left
    }
}
