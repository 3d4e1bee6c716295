//! The program from outside.

mod batch;
#[cfg(unix)]
mod batch_kills;
mod blends;
mod cluster;
mod composes;
mod corruption;
mod details;
mod documents;
mod drawings;
mod exit_codes;
mod memory;
mod picking;
mod repairs;
mod reports;
mod sharpens;
mod support;
mod verbs;
mod writing;
