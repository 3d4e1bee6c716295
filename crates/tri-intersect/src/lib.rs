//! Exact-predicate triangle-mesh intersection, cutting and booleans
//!
//! | file | holds |
//! |---|---|
//! | `embed.rs`, `embed/` | curves made part of a mesh, and the parts into which they divide it |

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
mod pinch;
mod predicate;
mod seam;
mod self_test;
mod tidy;
mod triangulate;

pub use boolean::{Boolean, Contact, Operation, Params, Report, Seam, Slivers, Warning, boolean};
pub use contact::triangles_intersect;
pub use curves::{Curve, CurvePoint, intersection_curves};
pub use embed::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};
pub use error::Error;
pub use fold::{boolean_all, union_all};
pub use self_test::{self_intersections, self_intersections_among};
