//! Wavefront OBJ and its material library MTL.

mod chunk;
mod lines;
mod mtl;
mod read;
mod write;

pub use lines::lines_to_obj;
pub(crate) use read::read;
pub(crate) use write::encode;
