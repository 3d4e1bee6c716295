//! Pipelines that join and blend triangle meshes.
//!
//! | file | holds |
//! |---|---|
//! | `report.rs` | the machine-readable account of a job |

mod report;

pub use report::{Counts, Quality, Report, Stage, Validity};
