//! Wavefront OBJ and its material library MTL.

mod chunk;
mod mtl;
mod read;
mod write;

pub(crate) use read::read;
pub(crate) use write::encode;
