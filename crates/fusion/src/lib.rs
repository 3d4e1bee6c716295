//! Pipelines that join and blend triangle meshes.
//!
//! | file | holds |
//! |---|---|
//! | `blend/` | rolling-ball blends of closed curves |
//! | `report.rs` | the machine-readable account of a job |

pub mod blend;
mod report;

pub use report::{Counts, Quality, Report, Stage, Validity};
