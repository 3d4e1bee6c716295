//! Reads and writes OBJ, STL, PLY, OFF, glTF and 3MF triangle meshes.
//!
//! ```
//! use mesh_io::{Format, Model, read_stream, to_bytes};
//! let obj = b"v 0 0 0\nv 0.1 0 0\nv 0 0.30000000000000004 0\nf 1 2 3\n";
//! let model: Model = read_stream(obj, Format::Obj)?;
//! let back = read_stream(&to_bytes(&model, Format::Ply)?, Format::Ply)?;
//! assert_eq!(back.mesh, model.mesh); // every bit of every position
//! # Ok::<(), mesh_io::Error>(())
//! ```
//!
//! A malformed file is an [`Error`] that names the line or byte and the reason; sizes in headers are never trusted with
//! an allocation, and references never leave the file's folder.
//!
//! | file | holds |
//! |---|---|
//! | `model.rs` | [`Model`]: triangles with corner attributes, groups, materials, polygons, notes |
//! | `format.rs`, `named.rs`, `error.rs`, `notes.rs` | formats and their names; what went wrong, or was changed, and where |
//! | `read.rs`, `write.rs` | from files to models and back |
//! | `atomic.rs` | files that appear together or not at all |
//! | `folder.rs` | references to side files that are safe to follow |
//! | `obj/`, `ply/`, `off/`, `stl.rs`, `gltf/`, `threemf/` | one format each, reader and writer; curves as OBJ lines |
//! | `text.rs`, `number.rs` | tokens of text files; numbers as text, bit for bit |
//! | `soup.rs`, `triangulate.rs`, `polygons.rs` | polygons to triangles |
//! | `weld.rs` | merging vertices at the same place |
//! | `encode.rs`, `outline.rs`, `vary.rs` | what writers share: pieces and side files, polygons, how finely attributes vary |

mod atomic;
mod encode;
mod error;
mod folder;
mod format;
mod gltf;
mod model;
mod named;
mod notes;
mod number;
mod obj;
mod off;
mod outline;
mod ply;
mod polygons;
mod read;
mod soup;
mod stl;
mod text;
mod threemf;
mod triangulate;
mod unit;
mod vary;
mod weld;
mod write;

pub use atomic::AtomicFiles;
pub use error::{At, Error};
pub use format::Format;
pub use model::{Groups, Material, Materials, Model, Note, Polygons, Texture, TextureSource};
pub use obj::lines_to_obj;
pub use read::{read, read_as, read_stream};
pub use unit::Unit;
pub use weld::{Welded, weld_exact, weld_within};
pub use write::{Written, as_written, stage_as, to_bytes, write, write_as};
