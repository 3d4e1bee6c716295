//! Pipelines that join and blend triangle meshes.
//!
//! An operation is a struct of options that runs on models: [`operation`] lists them. Two files joined, their seam filleted:
//!
//! ```no_run
//! use fusion::mesh_core::Watch;
//! use fusion::operation::{Boolean, Length, Precision};
//! let parts = [fusion::mesh_io::read("bunny.obj".as_ref())?, fusion::mesh_io::read("spot.obj".as_ref())?];
//! let union = Boolean::default().with_radius(Length::OfDiagonal(0.02));
//! let both = union.run(&parts, Precision::F32, &Watch::default())?;
//! fusion::mesh_io::write(&both.model, "both.glb".as_ref())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Every edge over 40 degrees of plain arrays rounded:
//!
//! ```
//! use fusion::mesh_core::{TriMesh, Watch};
//! use fusion::operation::{Blend, Precision};
//! let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
//! let mesh = TriMesh::from_arrays(positions.map(Into::into).into(), faces);
//! let blend = Blend::default().with_angle(40.0).with_radius(0.05);
//! let round = blend.run(&mesh.into(), Precision::F64, &Watch::default())?;
//! assert_eq!(round.report.curves.len(), 6);
//! # Ok::<(), fusion::Error>(())
//! ```
//!
//! Three open meshes composed:
//!
//! ```
//! use fusion::mesh_core::{Watch, shapes};
//! use fusion::operation::{Compose, Precision};
//! use glam::{DQuat, DVec3};
//! let tube = |at: f64| shapes::posed(shapes::open_cylinder(0.5, 1.0, 24, 4), DQuat::IDENTITY, DVec3::Z * at).into();
//! let parts = [tube(0.0), tube(1.5), tube(3.0)];
//! let whole = Compose::default().run(&parts, Precision::F64, &Watch::default())?;
//! assert_eq!(whole.report.validity.closed, Some(true));
//! # Ok::<(), fusion::Error>(())
//! ```
//!
//! One picked edge, with a radius that varies:
//!
//! ```
//! use fusion::mesh_core::{Watch, shapes};
//! use fusion::operation::{Blend, Precision, RadiusAt};
//! use glam::DVec3;
//! let near = vec![DVec3::new(0.0, 0.5, 0.5).into()];
//! let radius_at = vec![RadiusAt { at: DVec3::new(0.5, 0.5, 0.5), radius: 0.2.into() }];
//! let blend = Blend::default().with_radius(0.1).with_near(near).with_radius_at(radius_at);
//! let round = blend.run(&shapes::cuboid(DVec3::ONE).into(), Precision::F64, &Watch::default())?;
//! assert_eq!(round.report.figures["radius"], 0.2);
//! # Ok::<(), fusion::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `operation/` | operations as data: every option, written once |
//! | `join.rs` | union, difference and intersection, with blended seams |
//! | `round.rs` | blends along feature curves |
//! | `sharpen/` | fillets taken back to edges |
//! | `compose/` | openings joined by one smooth surface |
//! | `cut/` | cuts by planes and closed paths |
//! | `cluster/` | polyhedra rounded cluster by cluster |
//! | `detail.rs` | geometry detail from region to region |
//! | `document/` | whole models as TOML text, evaluated step by step |
//! | `pose/` | models moved |
//! | `extent.rs`, `outcome.rs`, `validity.rs`, `invalid.rs`, `error.rs` | how every pipeline begins and ends |
//! | `remeshing.rs`, `region.rs` | remeshing of a surface or a region of it; regions |
//! | `repair/`, `repair_refusal.rs` | any mesh made a solid, step by step; why none comes out |
//! | `inherited.rs` | where a result crosses itself because its inputs do |
//! | `info.rs` | counts, measures and defects of one mesh |
//! | `listing.rs` | feature curves as every door lists them |
//! | `choice.rs`, `choice_refusal.rs` | which curves are blended; why none can be chosen |
//! | `picks.rs` | curves through picked points |
//! | `attributes.rs`, `spread.rs` | attributes carried from inputs to the result, colours blended over new surfaces |
//! | `profile_file.rs` | cross-sections read from files |
//! | `palette.rs` | which colour shows what a face comes from |
//! | `diagnostic.rs`, `metrics.rs` | what a job has to tell; what a blend did
//! | `report.rs`, `origins_json.rs`, `drawings.rs` | the account of a job, as files |

mod attributes;
pub mod choice;
mod choice_refusal;
pub mod cluster;
pub mod compose;
pub mod cut;
pub mod detail;
mod diagnostic;
pub mod document;
mod drawings;
mod error;
mod extent;
mod info;
mod inherited;
mod invalid;
pub mod join;
mod listing;
mod metrics;
pub mod operation;
mod origins_json;
mod outcome;
mod palette;
mod picks;
mod pose;
mod profile_file;
mod region;
pub mod remeshing;
pub mod repair;
mod repair_refusal;
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
pub use document::Document;
pub use drawings::drawings_to_files;
pub use error::Error;
pub use info::{Defect, Info, Loop};
pub use inherited::Inherited;
pub use invalid::Invalid;
pub use join::join;
pub use listing::{ListedCurve, convexity_word, list_curves};
pub use mesh_core;
pub use mesh_io;
pub use origins_json::{origins_to_json, parts_of_faces};
pub use outcome::Outcome;
pub use palette::palette_index;
pub use picks::{Picked, picked_from_text};
pub use profile_file::{ProfileFileError, profile_from_text};
pub use profile_nurbs::Profile;
pub use region::Region;
pub use remeshing::remesh;
pub use render;
pub use report::{Counts, CurveReport, Quality, Report, Stage, Validity};
pub use rolling_blend as blend;
pub use rolling_blend::features;
pub use round::round;
pub use sharpen::sharpen;
pub use spine::{OffsetParams, Solver};
pub use tri_intersect::Operation;
pub use validity::look_everywhere;
