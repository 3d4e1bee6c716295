//! One file per verb. Each turns arguments into one library call and its result into output.

pub mod batch;
pub mod blend;
pub mod boolean;
pub mod cluster;
pub mod completions;
pub mod compose;
pub mod convert;
pub mod cut;
pub mod demo;
pub mod detail;
pub mod features;
pub mod grid;
pub mod info;
pub mod man;
pub mod pose;
pub mod remesh;
pub mod render;
pub mod repair;
pub mod run;
pub mod schema;
pub mod sharpen;
pub mod summary;
pub mod worker;
