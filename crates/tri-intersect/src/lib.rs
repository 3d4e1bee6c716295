//! Exact-predicate triangle-mesh intersection, cutting and booleans
//!
//! | file | holds |
//! |---|---|
//! | `embed.rs`, `embed/` | curves made part of a mesh, and the parts into which they divide it |

mod boolean;
pub mod embed;
mod error;

pub use boolean::{Boolean, Contact, Operation, Params, Report, Seam, Slivers, Warning, boolean};
pub use embed::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};
pub use error::Error;
