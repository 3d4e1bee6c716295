//! Reads binary OFF: words of four bytes behind the header line.
//!
//! Geomview writes them big-endian, with a count of colour components behind every face; others write them
//! little-endian or without that count, and no header tells which. Only one layout uses up the file exactly.

use super::read::Dialect;
use crate::error::Fault;
use crate::model::Model;
use crate::notes::Notes;
use crate::soup::Soup;
use glam::DVec3;

/// How the words are to be read.
#[derive(Clone, Copy)]
struct Layout {
    big_endian: bool,
    face_colors: bool,
}

/// Reads the words from `start` on. Attributes other than positions are passed over with a note.
pub(super) fn read(bytes: &[u8], start: usize, dialect: Dialect, notes: &mut Notes) -> Result<Model, Fault> {
    let layouts = [(true, true), (false, false), (false, true), (true, false)];
    let soup = layouts
        .into_iter()
        .find_map(|(big_endian, face_colors)| words(&bytes[start..], dialect, Layout { big_endian, face_colors }))
        .ok_or_else(|| {
            Fault::binary(start, "the numbers of this binary OFF fit neither byte order; it may be cut off")
        })?;
    if let Some(bad) = soup.positions.iter().position(|p| !p.is_finite()) {
        return Err(Fault::binary(start, format!("a coordinate of vertex {bad} is not finite")));
    }
    if dialect.uvs || dialect.colors || dialect.normals {
        notes.add("attributes of binary OFF not kept", 1, None);
    }
    let cut = soup.triangulate(notes, |_| None)?;
    Ok(Model { polygons: cut.polygons, mesh: cut.mesh, ..Model::default() })
}

/// The whole file in one layout, or `None` if it does not fit.
fn words(bytes: &[u8], dialect: Dialect, layout: Layout) -> Option<Soup> {
    let mut rest = bytes;
    let mut word = || {
        let (raw, tail) = rest.split_first_chunk::<4>()?;
        rest = tail;
        Some(if layout.big_endian { u32::from_be_bytes(*raw) } else { u32::from_le_bytes(*raw) })
    };
    let (vertices, faces, _edges) = (word()? as usize, word()? as usize, word()?);
    if vertices.max(faces) > bytes.len() / 4 {
        return None;
    }
    let surplus =
        if dialect.normals { 3 } else { 0 } + if dialect.colors { 4 } else { 0 } + if dialect.uvs { 2 } else { 0 };
    let mut soup = Soup::default();
    for _ in 0..vertices {
        let mut float = || word().map(|w| f64::from(f32::from_bits(w)));
        let p = DVec3::new(float()?, float()?, float()?);
        soup.positions.push(if dialect.homogeneous { p / float()? } else { p });
        for _ in 0..surplus {
            word()?;
        }
    }
    let mut sizes = vec![];
    for _ in 0..faces {
        let size = word()?;
        for _ in 0..size {
            soup.corners.push(word().filter(|&v| (v as usize) < vertices)?);
        }
        sizes.push(size);
        if layout.face_colors {
            for _ in 0..word()? {
                word()?;
            }
        }
    }
    soup.sizes = Some(sizes);
    rest.is_empty().then_some(soup)
}
