//! OFF, the Object File Format of Geomview.

mod binary;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::encode;
