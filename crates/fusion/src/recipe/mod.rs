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
//! | `tables.rs` | what may stand in a recipe |
//! | `values.rs` | vectors, lengths, poses, profiles |
//! | `check.rs` | what TOML cannot check: names, ranges |
//! | `run.rs` | the steps, in order |
//! | `rims.rs` | openings by the names of the parts they came with |
//! | `error.rs` | what is wrong with a recipe, by line and key |

mod check;
mod error;
mod rims;
mod run;
mod tables;
mod values;

pub use error::Error;
pub use tables::{Blend, Boolean, Cluster, Compose, Part, PartCut, Plane, Recipe, Step};
pub use values::{Length, Rotation};
