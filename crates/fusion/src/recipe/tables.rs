//! What may stand in a recipe, and in the tables of its steps. Keys that are in no table are refused by `keys.rs`.

use super::part_tables::{Part, Primitive};
use super::step_table::StepTable;
use crate::operation::{Blend, Boolean, Cluster, Compose, Detail};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::Spanned;

/// A whole model: parts, and what is done with them.
#[derive(Clone, Debug, Deserialize)]
pub struct Recipe {
    /// Version of the language of recipes: 1.
    pub version: Spanned<u32>,
    /// Where the result goes, relative to the recipe.
    pub output: PathBuf,
    /// The kinds of steps in another order than cut, pose, boolean, compose, blend, cluster, detail. Kinds left out are not taken.
    pub steps: Option<Vec<Spanned<Step>>>,
    /// The parts.
    #[serde(default, rename = "part")]
    pub parts: Vec<Part>,
    /// What parts ride on, by name.
    #[serde(default, rename = "primitive")]
    pub primitives: BTreeMap<String, Primitive>,
    /// Booleans.
    #[serde(skip)]
    pub boolean: Vec<StepTable<Boolean>>,
    /// Joins of openings.
    #[serde(skip)]
    pub compose: Vec<StepTable<Compose>>,
    /// Blends along feature curves.
    #[serde(skip)]
    pub blend: Vec<StepTable<Blend>>,
    /// Polyhedra rounded by clusters.
    #[serde(skip)]
    pub cluster: Vec<StepTable<Cluster>>,
    /// Geometry detail for smooth regions.
    #[serde(skip)]
    pub detail: Vec<StepTable<Detail>>,
    /// The recipe as written, for messages.
    #[serde(skip)]
    pub(super) text: String,
}

/// A kind of step.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Step {
    /// The parts' cuts, each in its own file's coordinates.
    Cut,
    /// The parts' poses.
    Pose,
    /// Booleans between parts.
    Boolean,
    /// Joins of openings by smooth surfaces.
    Compose,
    /// Blends along feature curves.
    Blend,
    /// Polyhedra rounded by clusters.
    Cluster,
    /// Geometry detail for smooth regions.
    Detail,
    /// Writing. Always the last.
    Output,
}

impl Step {
    /// The order of steps where a recipe names none.
    pub const ORDER: [Self; 7] =
        [Self::Cut, Self::Pose, Self::Boolean, Self::Compose, Self::Blend, Self::Cluster, Self::Detail];
}
