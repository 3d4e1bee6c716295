//! 3MF: XML models in a zip package.

mod document;
mod package;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::encode;
