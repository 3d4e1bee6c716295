//! Recipes: whole models as TOML files, replayed step by step.
//!
//! ```
//! use fusion::Recipe;
//! use fusion::mesh_core::{Watch, shapes, volume};
//! let recipe = Recipe::parse(r#"
//!     version = 1
//!     output = "both.off"
//!     [[part]]
//!     name = "still"
//!     mesh = "cube.off"
//!     [[part]]
//!     name = "moved"
//!     mesh = "cube.off"
//!     translate = [0.5, 0.25, 0.125]
//!     [[boolean]]
//!     operation = "union"
//! "#)?;
//! let cube = shapes::cuboid(glam::DVec3::ONE);
//! let outcome = recipe.run(&[cube.clone().into(), cube.into()], "off".parse()?, &Watch::default())?;
//! assert!((volume(&outcome.model.mesh) - (2.0 - 0.5 * 0.75 * 0.875)).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `tables.rs`, `part_tables.rs` | what may stand in a recipe |
//! | `vocabulary.rs`, `keys.rs` | what each table takes: the list; unknown keys refused and the reference written by it |
//! | `values.rs` | vectors, lengths, poses, profiles |
//! | `check.rs` | what TOML cannot check: names, ranges |
//! | `step_table.rs` | a step: pieces and operation |
//! | `run.rs` | the steps, in order |
//! | `pose.rs`, `placement.rs`, `snap.rs` | where parts stand: their own poses, primitives, openings that face each other |
//! | `joins.rs`, `details.rs` | the joins of openings, and the steps of geometry detail |
//! | `error.rs` | what is wrong with a recipe, by line and key |

mod check;
mod details;
mod error;
mod joins;
mod keys;
mod part_tables;
mod placement;
mod pose;
mod run;
mod snap;
mod step_table;
mod tables;
mod values;
mod vocabulary;

pub use error::Error;
pub use keys::reference;
pub use part_tables::{On, Part, Primitive, Radius, Snap};
pub use step_table::{Pieces, StepTable};
pub use tables::{Recipe, Step};
pub use values::Rotation;
