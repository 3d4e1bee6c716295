//! Rational B-spline curves and the profiles of rolling-ball blends.
//!
//! A ball that touches two surfaces at its *feet* gives a [`Section`]: the two feet and the apex where the tangents
//! there meet. A [`Profile`] draws a curve into the section, and a [`Sweep`] rules a surface between neighbouring
//! curves (\[Liu2005\] §4).
//!
//! ```
//! use glam::DVec3;
//! use profile_nurbs::{Profile, Section};
//! let center = DVec3::new(1.0, 1.0, 0.0);
//! let section = Section::from_ball(center, DVec3::X, DVec3::Y)?;
//! let mut points = vec![];
//! Profile::Arc.points(&section, 8, &mut points);
//! assert!(points.iter().all(|p| (p.distance(center) - 1.0).abs() < 1e-14));
//! assert_eq!((points.len(), points[0], points[8]), (9, DVec3::X, DVec3::Y));
//! # Ok::<(), profile_nurbs::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `nurbs.rs` | `Nurbs`: checked construction, evaluation, derivatives of any order |
//! | `refine.rs` | knot insertion, splitting, Bézier pieces |
//! | `section.rs` | `Section`: the feet of a ball and the apex between them |
//! | `profile.rs` | `Profile`: arc, chamfer, conic, sharp, Hermite, G2, custom, as a curve |
//! | `sample.rs` | evenly spaced points on a profile, without allocation |
//! | `sweep.rs` | `Sweep`: the ruled surface S(t, u) through a row of curves |
//! | `tensor.rs` | `TensorBezier`: tensor-product Bézier patches with derivatives |
//! | `error.rs` | what can be wrong with the numbers given |

mod error;
mod nurbs;
mod profile;
mod refine;
mod sample;
mod section;
mod sweep;
mod tensor;

pub use error::Error;
pub use nurbs::Nurbs;
pub use profile::Profile;
pub use section::Section;
pub use sweep::{Sweep, SweepPoint};
pub use tensor::{SurfaceJet, TensorBezier};
