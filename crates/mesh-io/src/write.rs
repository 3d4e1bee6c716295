//! From a model to bytes and files. A file appears whole or not at all.

use crate::atomic::AtomicFiles;
use crate::encode::{Content, Encoded, Target};
use crate::error::Error;
use crate::format::Format;
use crate::model::{Model, Note};
use crate::weld::same_places;
use crate::{gltf, obj, off, ply, stl, threemf};
use mesh_core::{TriMesh, VertexId};
use rayon::prelude::*;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What [`write()`] put on disk.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// Every file written, the named one last.
    pub files: Vec<PathBuf>,
    /// Their size in all.
    pub bytes: u64,
    /// What the format could not hold.
    pub notes: Vec<Note>,
}

/// Writes a mesh file and its side files; the extension tells the format.
///
/// Everything is first written to temporary files beside the targets, then renamed, side files first. On any failure
/// the existing files are as they were and no temporary file stays. A target that is no regular file (a pipe, a
/// device) is written directly.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Unrepresentable`], [`Error::Inconsistent`], [`Error::Unwritable`].
pub fn write(model: &Model, path: &Path) -> Result<Written, Error> {
    write_as(model, path, Format::from_path(path)?)
}

/// Writes a mesh file in a given format, whatever its extension. See [`write()`].
///
/// # Errors
/// As for [`write()`].
pub fn write_as(model: &Model, path: &Path, format: Format) -> Result<Written, Error> {
    let mut staged = AtomicFiles::default();
    let notes = stage_as(model, path, format, &mut staged)?;
    let (mut files, bytes) = staged.commit()?;
    if let Some(last) = files.last_mut() {
        path.clone_into(last);
    }
    Ok(Written { files, bytes, notes })
}

/// Adds a mesh file and its side files, which go first, to files that appear together. Gives what the format could not hold.
///
/// # Errors
/// As for [`write()`].
pub fn stage_as(model: &Model, path: &Path, format: Format, staged: &mut AtomicFiles) -> Result<Vec<Note>, Error> {
    // A link is written through, not replaced.
    let real = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let encoded = encode(model, format, Some(&Target::of(path)))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    for side in &encoded.sides {
        let target = folder.join(&side.name);
        match &side.content {
            Content::Bytes(bytes) => staged.add(&target, |f| f.write_all(bytes))?,
            Content::Shared(bytes) => staged.add(&target, |f| f.write_all(bytes))?,
            Content::CopyOf(from) => staged.add(&target, |f| io::copy(&mut fs::File::open(from)?, f).map(|_| ()))?,
        }
    }
    staged.add(&real, |f| encoded.body.iter().try_for_each(|piece| f.write_all(piece)))?;
    Ok(encoded.notes.resolve(&[]))
}

/// The file that [`write()`] would make, as bytes, without side files: OBJ names materials that no library describes,
/// glTF holds its buffer inside.
///
/// # Errors
/// [`Error::Unrepresentable`], [`Error::Inconsistent`].
pub fn to_bytes(model: &Model, format: Format) -> Result<Vec<u8>, Error> {
    Ok(encode(model, format, None)?.body.concat())
}

/// The mesh as `format` will hold it, or `None` where that is the mesh itself. glTF and STL round positions to f32;
/// STL also merges those that become equal, for it holds no indices. Faces keep their number and order, so those
/// that rounding folds can be found by validation. Coordinates beyond f32 become infinite.
pub fn as_written(model: &Model, format: Format) -> Option<TriMesh> {
    if format.is_lossless() {
        return None;
    }
    let round = |p: &glam::DVec3| p.as_vec3().as_dvec3();
    let mut mesh =
        TriMesh { positions: model.mesh.positions.par_iter().map(round).collect(), faces: model.mesh.faces.clone() };
    if format == Format::Stl {
        let first = same_places(&mesh.positions);
        let mut id = vec![VertexId(0); first.len()];
        let mut kept = 0;
        for (v, &f) in first.iter().enumerate() {
            if f as usize == v {
                id[v] = VertexId::from(kept);
                mesh.positions[kept] = mesh.positions[v];
                kept += 1;
            } else {
                id[v] = id[f as usize];
            }
        }
        mesh.positions.truncate(kept);
        mesh.faces.as_flattened_mut().iter_mut().for_each(|v| *v = id[v.index()]);
    }
    Some(mesh)
}

fn encode(model: &Model, format: Format, target: Option<&Target>) -> Result<Encoded, Error> {
    if !model.is_consistent() {
        return Err(Error::Inconsistent);
    }
    check_positions(&model.mesh, format)?;
    Ok(match format {
        Format::Obj => obj::encode(model, target),
        Format::Off => off::encode(model),
        Format::Ply => ply::encode(model, target),
        Format::Stl => stl::encode(model),
        Format::Glb => gltf::encode_glb(model),
        Format::Gltf => gltf::encode_json(model, target),
        Format::ThreeMf => threemf::encode(model),
    })
}

fn check_positions(mesh: &TriMesh, format: Format) -> Result<(), Error> {
    let lossless = format.is_lossless();
    let bad =
        mesh.positions.par_iter().position_first(|p| !if lossless { p.is_finite() } else { p.as_vec3().is_finite() });
    let Some(bad) = bad else { return Ok(()) };
    let place = mesh.positions[bad];
    let reason = if place.is_finite() { "it holds numbers up to 3.4e38" } else { "it holds finite numbers only" };
    Err(Error::Unrepresentable { vertex: VertexId::from(bad), place, format, reason })
}
