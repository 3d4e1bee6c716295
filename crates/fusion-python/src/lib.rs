//! The native core of the Python package `fusion-mesh`: arrays in, arrays out, one engine.
//!
//! The package around it is in `python/fusion_mesh`; this is what it looks like from there:
//!
//! ```python
//! import fusion_mesh as fm
//! both = fm.union("bunny.obj", "spot.obj", radius="2%")
//! both.save("both.ply")
//! ```
//!
//! Without the feature `extension` this crate is empty, so that the workspace builds on machines without Python.
//!
//! | file | holds |
//! |---|---|
//! | `module.rs` | the functions that Python sees |
//! | `operations.rs` | operations by name |
//! | `document_module.rs`, `documents.rs` | documents, as Python sees them, and what is done for it |
//! | `job.rs` | one job: its threads, progress, Ctrl-C |
//! | `arrays.rs`, `attributes.rs` | meshes from arrays and back, with their attributes |
//! | `columns.rs` | arrays of one kind of value |
//! | `origins.rs` | origins as columns |
//! | `listing.rs` | measures and feature curves |
//! | `picture.rs` | still pictures |
//! | `value.rs` | options and reports as plain Python values |
//! | `failure.rs` | Python exceptions |

#[cfg(feature = "extension")]
mod arrays;
#[cfg(feature = "extension")]
mod attributes;
#[cfg(feature = "extension")]
mod columns;
#[cfg(feature = "extension")]
mod document_module;
#[cfg(feature = "extension")]
mod documents;
#[cfg(feature = "extension")]
mod failure;
#[cfg(feature = "extension")]
mod job;
#[cfg(feature = "extension")]
mod listing;
#[cfg(feature = "extension")]
mod module;
#[cfg(feature = "extension")]
mod operations;
#[cfg(feature = "extension")]
mod origins;
#[cfg(feature = "extension")]
mod picture;
#[cfg(feature = "extension")]
mod value;

/// As in the program: the system's allocator gives pages back and asks for them again, which costs a third of a large blend.
#[cfg(feature = "extension")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;
