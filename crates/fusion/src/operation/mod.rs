//! Operations as data: every option of every operation, written once.
//!
//! An operation is one struct. The command line, documents and the JSON schema are derived from it: names, types, defaults,
//! ranges and sentences stand there alone.
//!
//! ```
//! use fusion::operation::{Blend, Length};
//! let blend: Blend = serde_json::from_str(r#"{ "radius": "2%", "near": [[0, 1, 0]] }"#)?;
//! assert_eq!(blend.radius, Some(Length::OfDiagonal(0.02).into()));
//! assert_eq!(blend.angle, Blend::default().angle);
//! # Ok::<(), serde_json::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `blend.rs`, `boolean.rs`, `cluster.rs`, `compose.rs`, `cut.rs`, `detail.rs`, `pose.rs`, `remesh.rs`, `repair.rs`, `sharpen.rs` | the operations |
//! | `rolling.rs` | options that the two share |
//! | `length.rs`, `place.rs`, `primitive.rs`, `section.rs`, `region.rs`, `region_of.rs`, `silhouette.rs`, `smoothing.rs`, `linked.rs`, `words.rs`, `precision.rs` | what options take |
//! | `option_error.rs` | what is wrong with an option |
//! | `options.rs`, `schema.rs` | what operations have in common; their JSON schema |
//! | `define.rs` | the macros behind the structs |

mod blend;
mod boolean;
mod cluster;
mod compose;
mod cut;
mod define;
mod detail;
mod length;
mod linked;
mod option_error;
mod options;
mod place;
mod pose;
mod precision;
mod primitive;
mod region;
mod region_of;
mod remesh;
mod repair;
mod rolling;
mod schema;
mod section;
mod sharpen;
mod silhouette;
mod smoothing;
mod words;

pub use blend::Blend;
pub use boolean::{Boolean, SetOperation};
pub use cluster::{Cluster, Edge};
pub use compose::{Compose, Creases, Kernel, LoopName, Method};
pub use cut::{Cut, Plane, Side};
pub use detail::{Detail, DetailMode, Fan, Search};
pub use length::{Length, Radius};
pub use linked::{Files, Linked, Solid};
pub use option_error::OptionError;
pub use options::Options;
pub use place::{Near, RadiusAt, direction, point};
pub use pose::Pose;
pub use precision::Precision;
pub use primitive::{On, Primitive, PrimitiveShape, Radii, Rotation, Snap};
pub use region::RegionArg;
pub use region_of::{Curve, RegionOf};
pub use remesh::Remesh;
pub use repair::{Holes, Repair, RepairStep};
pub use rolling::{Overlap, Spine, Surface};
pub use schema::{OptionRow, option_rows, schema};
pub use section::{ProfileAt, Section, SectionCurve};
pub use sharpen::Sharpen;
pub use silhouette::{Depth, SilhouetteArg};
pub use smoothing::SmoothMethod;
pub use words::Words;

/// The heading of options that only reproduce a paper's variant.
#[cfg(feature = "clap")]
pub(crate) const VARIANTS: &str = "Variants of the papers";
