//! Pipelines that join and blend triangle meshes.
//!
//! ```
//! use fusion::{Info, features};
//! use fusion::mesh_core::{Connected, Watch, shapes};
//!
//! let cube = shapes::cuboid(glam::DVec3::ONE);
//! assert_eq!(Info::of(&cube, &Watch::default())?.genus, Some(0));
//! let curves = features::feature_curves(&Connected::new(cube)?, &features::Params::default());
//! assert_eq!(curves.len(), 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `join.rs` | union, difference and intersection, with blended seams |
//! | `round.rs` | blends along feature curves |
//! | `sharpen/` | fillets taken back to edges |
//! | `compose/` | openings joined by one smooth surface |
//! | `cut/` | cuts by planes and closed paths |
//! | `cluster/` | polyhedra rounded cluster by cluster |
//! | `detail.rs` | geometry detail from region to region |
//! | `recipe/` | whole models as TOML files |
//! | `extent.rs`, `outcome.rs`, `validity.rs`, `error.rs` | how every pipeline begins and ends |
//! | `remeshing.rs`, `region.rs` | remeshing of a surface or a region of it; regions |
//! | `repair.rs` | welding, orientation, taking apart |
//! | `info.rs` | counts, measures and defects of one mesh |
//! | `choice.rs` | which curves are blended |
//! | `picks.rs` | curves through picked points |
//! | `attributes.rs`, `spread.rs` | attributes carried from inputs to the result, colours blended over new surfaces |
//! | `profile_file.rs` | cross-sections read from files |
//! | `palette.rs` | which colour shows what a face comes from |
//! | `diagnostic.rs`, `metrics.rs` | what a job has to tell; what a blend did
//! | `report.rs`, `origins_json.rs`, `drawings.rs` | the account of a job, as files |

mod attributes;
pub mod choice;
pub mod cluster;
pub mod compose;
pub mod cut;
pub mod detail;
mod diagnostic;
mod drawings;
mod error;
mod extent;
mod info;
pub mod join;
mod metrics;
mod origins_json;
mod outcome;
mod palette;
mod picks;
mod profile_file;
pub mod recipe;
mod region;
pub mod remeshing;
mod repair;
mod report;
pub mod round;
pub mod sharpen;
mod spread;
mod validity;

pub use attributes::carry;
pub use choice::Choice;
pub use cut::cut;
pub use detail_transfer;
pub use diagnostic::{Code, Diagnostic, Severity};
pub use drawings::drawings_to_files;
pub use error::Error;
pub use info::{Defect, Info, Loop};
pub use join::join;
pub use mesh_core;
pub use origins_json::{origins_to_json, parts_of_faces};
pub use outcome::Outcome;
pub use palette::palette_index;
pub use picks::{Picked, picked_from_text};
pub use profile_file::{ProfileFileError, profile_from_text};
pub use profile_nurbs::Profile;
pub use recipe::Recipe;
pub use region::Region;
pub use remeshing::remesh;
pub use render;
pub use repair::{Repair, repair};
pub use report::{Counts, CurveReport, Quality, Report, Stage, Validity};
pub use rolling_blend as blend;
pub use rolling_blend::features;
pub use round::round;
pub use sharpen::sharpen;
pub use spine::{OffsetParams, Solver};
pub use tri_intersect::Operation;
pub use validity::Invalid;
