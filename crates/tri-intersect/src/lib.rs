//! Where triangle meshes meet: exact intersection tests, curves, cuts and booleans.
//!
//! Two surfaces are laid over each other and cut where they cross; pieces are kept or dropped to give the union,
//! difference or intersection of the solids they bound. Only triangles that are crossed change, all others keep their
//! bits, and every vertex and face of the result knows where it came from. The parts serve alone too: curves of
//! intersection, curves embedded into a mesh, and the report of where a mesh meets itself.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use mesh_core::{Connected, Watch, shapes, volume};
//! use tri_intersect::{Operation, Params, boolean};
//!
//! let still = Connected::new(shapes::cuboid(DVec3::ONE))?;
//! let moved = shapes::posed(shapes::cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::new(0.5, 0.25, 0.125));
//! let both = boolean(&still, &Connected::new(moved)?, Operation::Union, &Params::default(), &Watch::default())?;
//! let shared = 0.5 * 0.75 * 0.875;
//! assert!((volume(&both.mesh) - (2.0 - shared)).abs() < 1e-14);
//! assert_eq!(both.seams.len(), 1); // one closed curve around both
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Whether and how two triangles cross is decided by signs of exact predicates \[Shewchuk1997\] on the input points, with
//! explicit cases for zeros. A point of intersection is *named* by what carries it (an edge of one mesh and a face of the
//! other, or two edges, or a vertex and a face …), so neighbouring triangles agree on it without comparing coordinates.
//! Its place is computed in 106 bits and rounded once; its order along an edge is compared exactly. Crossed triangles are
//! retriangulated with exact predicates on the rounded places, so none can fold; where rounding has put two points or a
//! point and an edge in each other's way, they are snapped together, by no more than 2⁻⁴⁴ of the largest coordinate.
//! Inside and outside are decided exactly at the seam and flooded from there. Every result is checked before it is
//! returned.
//!
//! **Zeros.** Coplanar, touching and coinciding parts give the regularised result: faces that coincide are kept once if
//! they look the same way, and vanish if they look opposite ways. Where the result would pinch to an edge or a vertex,
//! [`Contact`] says what happens. Planes that *almost* coincide, say to one part in 10¹⁵ after a rotation, cross
//! in ways that doubles cannot always write down; that is refused with [`Error::Rounding`], [`Error::Tangled`] or
//! [`Error::SelfIntersecting`] and the place.
//!
//! | file | holds |
//! |---|---|
//! | `options.rs` | which boolean, and how it treats its seam |
//! | `boolean.rs` | union, difference, intersection: the stages in order |
//! | `fold.rs` | one operation over many parts |
//! | `curves.rs` | intersection curves of two surfaces, open or closed |
//! | `self_test.rs`, `plain.rs`, `contact.rs` | the self-intersection report; flat patches that need no test; whether two triangles meet |
//! | `embed.rs`, `embed/` | curves made part of a mesh, and the parts into which they divide it |
//! | `predicate.rs`, `exact.rs` | signs of orientation; numbers beyond 64 bits |
//! | `near.rs` | the faces that can meet at all |
//! | `crossing.rs` | how one triangle meets another, in names |
//! | `arrange.rs`, `arrange/` | all crossings of two meshes: named points, placed and in order |
//! | `triangulate.rs`, `triangulate/` | one cut face |
//! | `cut.rs` | all of them, and the snapping |
//! | `classify.rs`, `inside.rs` | sides of the seam, the flood, and components that no seam passes |
//! | `assemble.rs`, `check.rs` | the result with its origins, and its exact check |
//! | `tidy.rs`, `pinch.rs`, `seam.rs` | short edges, contacts, seam curves |
//! | `error.rs` | why a boolean is refused, and where |

mod arrange;
mod assemble;
mod boolean;
mod check;
mod classify;
mod contact;
mod crossing;
mod curves;
mod cut;
pub mod embed;
mod error;
mod exact;
mod fold;
mod inside;
mod near;
mod options;
mod pinch;
mod plain;
mod predicate;
mod seam;
mod self_test;
mod tidy;
mod triangulate;

pub use boolean::{Boolean, Report, Warning, boolean};
pub use contact::triangles_intersect;
pub use curves::{Curve, CurvePoint, intersection_curves};
pub use embed::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};
pub use error::Error;
pub use fold::{boolean_all, union_all};
pub use options::{Contact, Operation, Params, Slivers};
pub use seam::Seam;
pub use self_test::{self_intersections, self_intersections_among};
