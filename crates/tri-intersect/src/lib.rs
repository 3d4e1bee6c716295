//! Exact-predicate triangle-mesh intersection, cutting and booleans

mod boolean;
mod error;

pub use boolean::{Boolean, Contact, Operation, Params, Report, Seam, Slivers, Warning, boolean};
pub use error::Error;
