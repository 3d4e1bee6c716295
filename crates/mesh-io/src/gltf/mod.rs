//! glTF 2.0: one binary file (GLB), or JSON with buffers beside it.

mod accessor;
mod buffers;
mod json;
mod look;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::{encode_glb, encode_json};
