//! A step's result as bytes, and back, bit for bit.

use crate::Report;
use glam::DVec3;
use mesh_core::{FaceId, FaceOrigin, Origins, TriMesh, VertexId, VertexOrigin};
use mesh_io::{Groups, Material, Materials, Model, Polygons, Texture, TextureSource, Unit};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// What a step made.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) model: Arc<Model>,
    /// With respect to the step's own shapes.
    pub(super) origins: Origins,
    pub(super) report: Report,
}

impl Entry {
    /// As bytes; `None` for a report that cannot be written.
    pub(super) fn to_bytes(&self) -> Option<Vec<u8>> {
        let mut out = vec![];
        put_model(&mut out, &self.model);
        put_origins(&mut out, &self.origins);
        put_bytes(&mut out, &postcard::to_stdvec(&self.report).ok()?);
        Some(out)
    }

    /// From bytes; `None` where they are not those of an entry.
    pub(super) fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut from = Reader(bytes);
        let entry = Self {
            model: Arc::new(model(&mut from)?),
            origins: origins(&mut from)?,
            report: postcard::from_bytes(from.bytes()?).ok()?,
        };
        from.0.is_empty().then_some(entry)
    }

    /// About how much memory it takes.
    pub(super) fn size(&self) -> usize {
        let (vertices, faces) = (self.model.mesh.positions.len(), self.model.mesh.faces.len());
        let corner = |has: bool, size: usize| if has { 3 * size } else { 0 };
        let of_face = 12
            + corner(self.model.uvs.is_some(), 16)
            + corner(self.model.normals.is_some(), 24)
            + corner(self.model.colors.is_some(), 32)
            + 8 * usize::from(self.model.groups.is_some())
            + size_of::<FaceOrigin>();
        4096 + vertices * (24 + size_of::<VertexOrigin>()) + faces * of_face
    }
}

fn put_count(out: &mut Vec<u8>, count: usize) {
    out.extend_from_slice(&(count as u64).to_le_bytes());
}

fn put_bytes(out: &mut Vec<u8>, bytes: &[u8]) {
    put_count(out, bytes.len());
    out.extend_from_slice(bytes);
}

fn put_floats(out: &mut Vec<u8>, numbers: &[f64]) {
    for x in numbers {
        out.extend_from_slice(&x.to_bits().to_le_bytes());
    }
}

fn put_ids(out: &mut Vec<u8>, ids: impl ExactSizeIterator<Item = u32>) {
    put_count(out, ids.len());
    ids.for_each(|id| out.extend_from_slice(&id.to_le_bytes()));
}

fn put_some<T>(out: &mut Vec<u8>, value: Option<&T>, put: impl FnOnce(&mut Vec<u8>, &T)) {
    out.push(u8::from(value.is_some()));
    if let Some(value) = value {
        put(out, value);
    }
}

/// A model, all of it but its reader's notes.
pub(super) fn put_model(out: &mut Vec<u8>, model: &Model) {
    put_count(out, model.mesh.positions.len());
    model.mesh.positions.iter().for_each(|p| put_floats(out, &p.to_array()));
    put_ids(out, model.mesh.faces.as_flattened().iter().map(|v| v.0));
    put_some(out, model.uvs.as_ref(), |out, uvs| {
        put_count(out, uvs.len());
        put_floats(out, uvs.as_slice().as_flattened());
    });
    put_some(out, model.normals.as_ref(), |out, normals| {
        put_count(out, normals.len());
        normals.as_slice().iter().for_each(|n| put_floats(out, &n.to_array()));
    });
    put_some(out, model.colors.as_ref(), |out, colors| {
        put_count(out, colors.len());
        put_floats(out, colors.as_slice().as_flattened());
    });
    put_some(out, model.groups.as_ref(), |out, groups| {
        put_ids(out, groups.of_face.as_slice().iter().copied());
        put_count(out, groups.names.len());
        groups.names.iter().for_each(|name| put_bytes(out, name.as_bytes()));
    });
    put_some(out, model.materials.as_ref(), |out, materials| {
        put_ids(out, materials.of_face.as_slice().iter().copied());
        put_count(out, materials.list.len());
        materials.list.iter().for_each(|material| put_material(out, material));
    });
    put_some(out, model.polygons.as_ref(), |out, polygons| {
        put_ids(out, polygons.starts.iter().copied());
        put_ids(out, polygons.corners.iter().map(|v| v.0));
        put_ids(out, polygons.of_face.as_slice().iter().copied());
    });
    put_some(out, model.unit.as_ref(), |out, unit| put_bytes(out, unit.name().as_bytes()));
}

fn put_material(out: &mut Vec<u8>, material: &Material) {
    put_bytes(out, material.name.as_bytes());
    put_floats(out, &material.base_color);
    put_floats(out, &[material.metallic, material.roughness]);
    put_some(out, material.texture.as_ref(), |out, texture| {
        put_bytes(out, texture.name.as_bytes());
        match &texture.source {
            TextureSource::File(path) => {
                out.push(0);
                put_bytes(out, path.as_os_str().as_encoded_bytes());
            }
            TextureSource::Embedded(bytes) => {
                out.push(1);
                put_bytes(out, bytes);
            }
            TextureSource::Missing => out.push(2),
        }
    });
}

fn put_origins(out: &mut Vec<u8>, origins: &Origins) {
    put_count(out, origins.vertices.len());
    for origin in origins.vertices.as_slice() {
        match *origin {
            VertexOrigin::Input { part, vertex } => put_kind(out, 0, &[part, vertex.0]),
            VertexOrigin::Edge { part, ends, t } => {
                put_kind(out, 1, &[part, ends[0].0, ends[1].0]);
                put_floats(out, &[t]);
            }
            VertexOrigin::Face { part, face, barycentric } => {
                put_kind(out, 2, &[part, face.0]);
                put_floats(out, &barycentric);
            }
            VertexOrigin::New { stage } => {
                out.push(3);
                put_bytes(out, stage.as_bytes());
            }
        }
    }
    put_count(out, origins.faces.len());
    for origin in origins.faces.as_slice() {
        match *origin {
            FaceOrigin::Input { part, face } => put_kind(out, 0, &[part, face.0]),
            FaceOrigin::Piece { part, face } => put_kind(out, 1, &[part, face.0]),
            FaceOrigin::New { stage } => {
                out.push(2);
                put_bytes(out, stage.as_bytes());
            }
        }
    }
}

fn put_kind(out: &mut Vec<u8>, kind: u8, ids: &[u32]) {
    out.push(kind);
    for id in ids {
        out.extend_from_slice(&id.to_le_bytes());
    }
}

/// What is left to read. Everything is checked against it, so that no count asks for more memory than there are bytes.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn byte(&mut self) -> Option<u8> {
        self.array().map(|[byte]| byte)
    }

    fn id(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    fn float(&mut self) -> Option<f64> {
        self.array().map(|bytes| f64::from_bits(u64::from_le_bytes(bytes)))
    }

    fn floats<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut all = [0.0; N];
        for x in &mut all {
            *x = self.float()?;
        }
        Some(all)
    }

    /// A number of things of at least `size` bytes each, which must be there.
    fn count(&mut self, size: usize) -> Option<usize> {
        let count = usize::try_from(self.array().map(u64::from_le_bytes)?).ok()?;
        (count.checked_mul(size)? <= self.0.len()).then_some(count)
    }

    fn bytes(&mut self) -> Option<&'a [u8]> {
        let count = self.count(1)?;
        self.take(count)
    }

    fn text(&mut self) -> Option<String> {
        String::from_utf8(self.bytes()?.to_vec()).ok()
    }

    fn ids(&mut self) -> Option<Vec<u32>> {
        let count = self.count(4)?;
        (0..count).map(|_| self.id()).collect()
    }

    fn vectors<const N: usize>(&mut self) -> Option<Vec<[f64; N]>> {
        let count = self.count(8 * N)?;
        (0..count).map(|_| self.floats()).collect()
    }

    /// Something, or nothing, or `None` for what can be neither.
    #[expect(clippy::option_option, reason = "the outer one is the end of the bytes, as everywhere here")]
    fn some<T>(&mut self, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<Option<T>> {
        match self.byte()? {
            0 => Some(None),
            1 => read(self).map(Some),
            _ => None,
        }
    }
}

fn model(from: &mut Reader<'_>) -> Option<Model> {
    let positions = from.vectors()?.into_iter().map(DVec3::from_array).collect();
    let corners = from.ids()?;
    let (faces, rest) = corners.as_chunks::<3>();
    if !rest.is_empty() {
        return None;
    }
    let mesh = TriMesh { positions, faces: faces.iter().map(|f| f.map(VertexId)).collect() };
    Some(Model {
        mesh,
        uvs: from.some(|from| from.vectors().map(Into::into))?,
        normals: from
            .some(|from| Some(from.vectors()?.into_iter().map(DVec3::from_array).collect::<Vec<_>>().into()))?,
        colors: from.some(|from| from.vectors().map(Into::into))?,
        groups: from.some(|from| {
            let of_face = from.ids()?.into();
            let count = from.count(8)?;
            Some(Groups { of_face, names: (0..count).map(|_| from.text()).collect::<Option<_>>()? })
        })?,
        materials: from.some(|from| {
            let of_face = from.ids()?.into();
            let count = from.count(8)?;
            Some(Materials { of_face, list: (0..count).map(|_| material(from)).collect::<Option<_>>()? })
        })?,
        polygons: from.some(|from| {
            let (starts, corners) = (from.ids()?, from.ids()?.into_iter().map(VertexId).collect());
            Some(Polygons { starts, corners, of_face: from.ids()?.into() })
        })?,
        unit: from.some(|from| Unit::from_name(&from.text()?))?,
        notes: vec![],
    })
}

fn material(from: &mut Reader<'_>) -> Option<Material> {
    let (name, base_color, [metallic, roughness]) = (from.text()?, from.floats()?, from.floats()?);
    let texture = from.some(|from| {
        let name = from.text()?;
        let source = match from.byte()? {
            // A path that is no text is not kept: its step is done again.
            0 => TextureSource::File(PathBuf::from(from.text()?)),
            1 => TextureSource::Embedded(from.bytes()?.into()),
            2 => TextureSource::Missing,
            _ => return None,
        };
        Some(Texture { name, source })
    })?;
    Some(Material { name, base_color, metallic, roughness, texture })
}

fn origins(from: &mut Reader<'_>) -> Option<Origins> {
    let count = from.count(1)?;
    let vertex = |from: &mut Reader<'_>| {
        Some(match from.byte()? {
            0 => VertexOrigin::Input { part: from.id()?, vertex: VertexId(from.id()?) },
            1 => VertexOrigin::Edge {
                part: from.id()?,
                ends: [VertexId(from.id()?), VertexId(from.id()?)],
                t: from.float()?,
            },
            2 => VertexOrigin::Face { part: from.id()?, face: FaceId(from.id()?), barycentric: from.floats()? },
            3 => VertexOrigin::New { stage: stage(from.text()?)? },
            _ => return None,
        })
    };
    let vertices = (0..count).map(|_| vertex(from)).collect::<Option<Vec<_>>>()?;
    let count = from.count(1)?;
    let face = |from: &mut Reader<'_>| {
        Some(match from.byte()? {
            0 => FaceOrigin::Input { part: from.id()?, face: FaceId(from.id()?) },
            1 => FaceOrigin::Piece { part: from.id()?, face: FaceId(from.id()?) },
            2 => FaceOrigin::New { stage: stage(from.text()?)? },
            _ => return None,
        })
    };
    let faces = (0..count).map(|_| face(from)).collect::<Option<Vec<_>>>()?;
    Some(Origins { vertices: vertices.into(), faces: faces.into() })
}

/// A stage's name as stages have it: one text for the life of the program. There are a few dozen, so more are not believed.
fn stage(name: String) -> Option<&'static str> {
    const MOST: usize = 256;
    const LONGEST: usize = 64;
    static KNOWN: Mutex<Vec<&'static str>> = Mutex::new(vec![]);
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(found) = known.iter().find(|k| **k == name) {
        return Some(found);
    }
    if known.len() >= MOST || name.len() > LONGEST {
        return None;
    }
    let kept: &'static str = name.leak();
    known.push(kept);
    Some(kept)
}
