//! The pipelines from outside. One program for all, since linking one takes seconds and a hundred megabytes.

mod analytic;
mod any_input;
mod cancelled;
mod compose;
mod corners;
mod details;
mod documents;
mod hidden;
mod invariants;
mod keep;
mod placement;
mod primitives;
mod radii;
mod scissors;
mod self_crossing;
mod sharpen;
mod silhouettes;
