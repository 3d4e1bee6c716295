//! Reads OBJ: chunks in parallel, then references resolved against what came before each chunk.

use super::chunk::{Chunk, Mark, NO_REF, Ref, parse, resolve};
use super::mtl;
use crate::error::{Fault, Spot};
use crate::folder::Folder;
use crate::model::{Groups, Material, Materials, Model};
use crate::notes::Notes;
use crate::soup::Soup;
use crate::vary::Value;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};

const CHUNK_BYTES: usize = 1 << 19;

/// How many elements come before a chunk.
#[derive(Clone, Copy, Default)]
struct Before {
    positions: usize,
    uvs: usize,
    normals: usize,
    faces: usize,
}

/// Reads an OBJ file, and its material libraries where `folder` has them. Vertices keep their order and number,
/// referenced or not. O(n), in parallel, with about three times the file's size of memory.
pub(crate) fn read(bytes: &[u8], folder: &Folder, notes: &mut Notes) -> Result<Model, Fault> {
    let pieces = split(bytes);
    let chunks: Vec<Chunk> = pieces
        .par_iter()
        .map(|&(start, text)| parse(text, start))
        .collect::<Vec<_>>()
        .into_iter()
        .collect::<Result<_, _>>()?;
    let mut before = Vec::with_capacity(chunks.len());
    let mut count = Before::default();
    for chunk in &chunks {
        before.push(count);
        count.positions += chunk.positions.len();
        count.uvs += chunk.uvs.len();
        count.normals += chunk.normals.len();
        count.faces += chunk.face_offsets.len();
    }
    if count.positions == 0 && chunks.iter().any(|c| c.unknown_lines > 0) {
        return Err(Fault::whole("not an OBJ file: it has no vertices but lines of another kind"));
    }
    let offset = |chunk: usize, face: usize| pieces[chunk].0 + chunks[chunk].face_offsets[face] as usize;
    let corners = absolute(&chunks, &before, count, offset)?;

    let labels = Labels::of(&chunks, count.faces);
    let materials = labels.materials(&chunks, folder, notes);
    let has_uvs = chunks.iter().any(|c| !c.uv_refs.is_empty());
    let has_normals = chunks.iter().any(|c| !c.normal_refs.is_empty());
    let uv_of_corner = has_uvs.then(|| attribute(&chunks, &before, |c| (&c.uv_refs, &c.uvs), |b| b.uvs, notes));
    let normal_of_corner =
        has_normals.then(|| attribute(&chunks, &before, |c| (&c.normal_refs, &c.normals), |b| b.normals, notes));
    let colors = vertex_colors(&chunks, notes);
    for chunk in &chunks {
        notes.append(chunk.notes.clone());
    }

    let sizes = chunks.iter().any(|c| !c.sizes.is_empty()).then(|| {
        chunks
            .iter()
            .flat_map(|c| if c.sizes.is_empty() { vec![3; c.face_offsets.len()] } else { c.sizes.clone() })
            .collect()
    });
    let locate = |face: usize| {
        let chunk = before.partition_point(|b| b.faces <= face) - 1;
        Some(Spot::Text(offset(chunk, face - before[chunk].faces)))
    };
    let positions = chunks.iter().map(|c| c.positions.as_slice()).collect::<Vec<_>>().concat();
    let soup = Soup { positions, sizes, corners };
    let cut = soup.triangulate(notes, locate)?;
    Ok(Model {
        uvs: uv_of_corner.map(|uvs| cut.gather_corners(|i| uvs[i]).into()),
        normals: normal_of_corner.map(|normals| cut.gather_corners(|i| normals[i]).into()),
        colors: colors
            .map(|colors| cut.mesh.faces.iter().flatten().map(|v| colors[v.index()]).collect::<Vec<_>>().into()),
        groups: labels
            .group_names
            .iter()
            .any(|name| !name.is_empty())
            .then(|| Groups { of_face: cut.gather_faces(&labels.group_of).into(), names: labels.group_names }),
        materials: materials.map(|list| Materials { of_face: cut.gather_faces(&labels.material_of).into(), list }),
        polygons: cut.polygons,
        mesh: cut.mesh,
        unit: None,
        notes: vec![],
    })
}

/// Cuts the text at line ends that no backslash joins, with each piece's offset.
fn split(bytes: &[u8]) -> Vec<(usize, &[u8])> {
    let (mut pieces, mut start) = (vec![], 0);
    while start < bytes.len() {
        let mut end = (start + CHUNK_BYTES).min(bytes.len());
        while end < bytes.len() && !is_plain_line_end(bytes, end) {
            end += 1;
        }
        pieces.push((start, &bytes[start..end]));
        start = end;
    }
    pieces
}

/// Whether a line ends right before `end`.
fn is_plain_line_end(bytes: &[u8], end: usize) -> bool {
    let before = &bytes[..end];
    before.ends_with(b"\n") && !before.ends_with(b"\\\n") && !before.ends_with(b"\\\r\n")
}

/// Vertex of every corner, all checked to exist.
fn absolute(
    chunks: &[Chunk],
    before: &[Before],
    count: Before,
    offset: impl Fn(usize, usize) -> usize + Sync,
) -> Result<Vec<u32>, Fault> {
    let limit = count.positions.min(u32::MAX as usize);
    let mut corners = vec![0; chunks.iter().map(|c| c.vertex_refs.len()).sum()];
    let (mut rest, mut tasks) = (&mut corners[..], Vec::with_capacity(chunks.len()));
    for (c, chunk) in chunks.iter().enumerate() {
        let (part, behind) = std::mem::take(&mut rest).split_at_mut(chunk.vertex_refs.len());
        tasks.push((c, part));
        rest = behind;
    }
    let faults: Vec<Fault> = tasks
        .into_par_iter()
        .filter_map(|(c, part)| {
            let refs = &chunks[c].vertex_refs;
            let dangling = part.iter_mut().zip(refs).position(|(corner, &r)| {
                let found = resolve(r, before[c].positions).filter(|&i| i < limit);
                *corner = found.unwrap_or_default() as u32;
                found.is_none()
            })?;
            let reason = format!("a face names a vertex that is not among the file's {}", count.positions);
            Some(Fault::text(offset(c, face_of_corner(&chunks[c], dangling)), reason))
        })
        .collect();
    // The first in the file.
    faults.into_iter().next().map_or(Ok(corners), Err)
}

fn face_of_corner(chunk: &Chunk, corner: usize) -> usize {
    if chunk.sizes.is_empty() {
        return corner / 3;
    }
    let mut end = 0;
    chunk
        .sizes
        .iter()
        .position(|&size| {
            end += size as usize;
            corner < end
        })
        .unwrap_or(0)
}

/// An attribute's value at every corner of every polygon. References to nothing cost the value, not the file.
fn attribute<T: Value>(
    chunks: &[Chunk],
    before: &[Before],
    part: impl Fn(&Chunk) -> (&Vec<Ref>, &Vec<T>) + Sync,
    first: impl Fn(&Before) -> usize + Sync,
    notes: &mut Notes,
) -> Vec<T> {
    let values: Vec<T> = chunks.iter().flat_map(|c| part(c).1).copied().collect();
    let dangling = AtomicUsize::new(0);
    let pieces: Vec<Vec<T>> = chunks
        .par_iter()
        .zip(before)
        .map(|(chunk, before)| {
            let refs = part(chunk).0;
            let value = |&r: &Ref| {
                let found = resolve(r, first(before)).and_then(|i| values.get(i).copied());
                if found.is_none() && r != NO_REF {
                    dangling.fetch_add(1, Ordering::Relaxed);
                }
                found.unwrap_or(T::NONE)
            };
            if refs.is_empty() { vec![T::NONE; chunk.vertex_refs.len()] } else { refs.iter().map(value).collect() }
        })
        .collect();
    notes.add("references to missing texture coordinates or normals ignored", dangling.into_inner(), None);
    pieces.concat()
}

/// Colours written behind positions. Files use 0–1 or 0–255; both become 0–1.
fn vertex_colors(chunks: &[Chunk], notes: &mut Notes) -> Option<Vec<[f64; 4]>> {
    if chunks.iter().all(|c| c.colors.is_empty()) {
        return None;
    }
    let mut colors: Vec<[f64; 4]> = vec![];
    for chunk in chunks {
        let from = colors.len();
        colors.extend_from_slice(&chunk.colors);
        colors.resize(from + chunk.positions.len(), [f64::NAN; 4]);
    }
    if colors.iter().any(|c| c[..3].iter().any(|&x| x > 1.0)) {
        notes.add("vertex colours divided by 255", colors.len(), None);
        for color in &mut colors {
            for x in &mut color[..3] {
                *x /= 255.0;
            }
        }
    }
    Some(colors)
}

/// The group and material in force at every face.
struct Labels {
    group_of: Vec<u32>,
    group_names: Vec<String>,
    material_of: Vec<u32>,
    material_names: Vec<String>,
}

/// Names numbered by first use.
#[derive(Default)]
struct Names {
    list: Vec<String>,
    ids: HashMap<String, u32>,
}

impl Names {
    fn id(&mut self, name: &str) -> u32 {
        if let Some(&id) = self.ids.get(name) {
            return id;
        }
        let id = self.list.len() as u32;
        self.ids.insert(name.to_owned(), id);
        self.list.push(name.to_owned());
        id
    }
}

impl Labels {
    fn of(chunks: &[Chunk], faces: usize) -> Self {
        let (mut groups, mut materials) = (Names::default(), Names::default());
        let (mut group_of, mut material_of) = (Vec::with_capacity(faces), Vec::with_capacity(faces));
        let (mut group, mut material) = (String::new(), String::new());
        if chunks.iter().all(|c| c.marks.is_empty()) {
            return Self { group_of, group_names: vec![], material_of, material_names: vec![] };
        }
        let mut before = 0;
        for chunk in chunks {
            // Names get their number when a face uses them, so that empty groups leave none behind.
            let mut fill = |end: usize, group: &str, material: &str| {
                if end > group_of.len() {
                    group_of.resize(end, groups.id(group));
                    material_of.resize(end, materials.id(material));
                }
            };
            for (faces_before, mark) in &chunk.marks {
                fill(before + *faces_before as usize, &group, &material);
                match mark {
                    Mark::Group(name) => group.clone_from(name),
                    Mark::Material(name) => material.clone_from(name),
                }
            }
            before += chunk.face_offsets.len();
            fill(before, &group, &material);
        }
        Self { group_of, group_names: groups.list, material_of, material_names: materials.list }
    }

    /// Materials by name, with the looks that libraries give them.
    fn materials(&self, chunks: &[Chunk], folder: &Folder, notes: &mut Notes) -> Option<Vec<Material>> {
        if self.material_names.iter().all(String::is_empty) {
            return None;
        }
        let libraries = mtl::load(chunks.iter().flat_map(|c| &c.libraries), folder, notes);
        let look = |name: &String| {
            let plain = || Material { name: name.clone(), ..Material::default() };
            libraries.iter().find(|m| m.name == *name).cloned().unwrap_or_else(plain)
        };
        Some(self.material_names.iter().map(look).collect())
    }
}
