//! From bytes to a model: picks the format's reader and puts names and places into its complaints.

use crate::error::Error;
use crate::folder::Folder;
use crate::format::Format;
use crate::model::Model;
use crate::notes::Notes;
use crate::text::normalized;
use crate::{gltf, obj, off, ply, stl, threemf};
use std::path::Path;

/// Reads a mesh file; its extension tells the format. Side files are looked for in its folder and below, nowhere else.
///
/// Vertices keep their order, number and bits, except that STL and glTF, which split vertices, are welded exactly.
/// A file with vertices but no faces, and an empty OBJ, are meshes without faces.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Unreadable`], or [`Error::Malformed`] with the line or byte.
pub fn read(path: &Path) -> Result<Model, Error> {
    let format = Format::from_path(path)?;
    read_as(path, format)
}

/// Reads a mesh file in a given format, whatever its extension.
///
/// # Errors
/// [`Error::Unreadable`], or [`Error::Malformed`] with the line or byte.
pub fn read_as(path: &Path, format: Format) -> Result<Model, Error> {
    let bytes = std::fs::read(path).map_err(|source| Error::Unreadable { path: path.to_owned(), source })?;
    decode(&bytes, format, &Folder::of(path), &path.display().to_string())
}

/// Reads a mesh from bytes. There are no side files: materials keep their names only, and a glTF must hold its
/// buffers inside.
///
/// ```
/// let model = mesh_io::read_stream(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", mesh_io::Format::Obj)?;
/// assert_eq!(model.mesh.faces.len(), 2);
/// assert_eq!(model.notes[0].to_string(), "polygons split into triangles: 1 (first at line 5)");
///
/// let error = mesh_io::read_stream(b"v 0 0 0\nv 1 nan 0\n", mesh_io::Format::Obj).unwrap_err();
/// assert_eq!(error.to_string(), "obj stream: line 2: \"nan\" is not a finite number");
/// # Ok::<(), mesh_io::Error>(())
/// ```
///
/// # Errors
/// [`Error::Malformed`] with the line or byte.
pub fn read_stream(bytes: &[u8], format: Format) -> Result<Model, Error> {
    decode(bytes, format, &Folder::default(), &format!("{format} stream"))
}

fn decode(bytes: &[u8], format: Format, folder: &Folder, file: &str) -> Result<Model, Error> {
    let text;
    let bytes = if matches!(format, Format::Obj | Format::Off) {
        text = normalized(bytes);
        &*text
    } else {
        bytes
    };
    let mut notes = Notes::default();
    let result = match format {
        Format::Obj => obj::read(bytes, folder, &mut notes),
        Format::Off => off::read(bytes, &mut notes),
        Format::Ply => ply::read(bytes, folder, &mut notes),
        Format::Stl => stl::read(bytes, &mut notes),
        Format::Glb | Format::Gltf => gltf::read(bytes, folder, &mut notes),
        Format::ThreeMf => threemf::read(bytes, &mut notes),
    };
    let mut model = result.map_err(|fault| fault.into_error(file.to_owned(), bytes))?;
    model.notes = notes.resolve(bytes);
    Ok(model)
}
