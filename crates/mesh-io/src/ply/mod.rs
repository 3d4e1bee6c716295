//! PLY, text and binary, with any elements and properties.

mod body;
mod header;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::encode;
