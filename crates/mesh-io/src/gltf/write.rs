//! Writes glTF: one mesh of f32 vertices, a primitive for every pair of group and material.

use super::buffers::{percent_encoded, to_base64};
use super::look::{is_jpeg, is_png};
use crate::encode::{Content, Encoded, Side, Target, in_pieces};
use crate::model::{Material, Materials, Model, TextureSource};
use crate::notes::Notes;
use crate::vary::{Value as _, distinct};
use glam::DVec3;
use gltf::binary::{Glb, Header};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{self, Target as Use};
use gltf::json::material::{AlphaMode, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked::Valid;
use gltf::json::{self, Accessor, Buffer, Image, Index, Root, Texture, texture};
use mesh_core::IdMap;
use serde_json::value::to_raw_value;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Pictures larger than this are not embedded.
const MAX_PICTURE: u64 = 256 << 20;

/// The binary buffer as it grows, with the views and accessors into it.
#[derive(Default)]
struct Store {
    pieces: Vec<Vec<u8>>,
    length: usize,
    views: Vec<buffer::View>,
    accessors: Vec<Accessor>,
}

impl Store {
    /// Adds bytes, padded to a multiple of four.
    fn view(&mut self, mut pieces: Vec<Vec<u8>>, target: Option<Use>) -> Index<buffer::View> {
        let length: usize = pieces.iter().map(Vec::len).sum();
        let view = buffer::View {
            buffer: Index::new(0),
            byte_length: length.into(),
            byte_offset: Some(self.length.into()),
            byte_stride: None,
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: None,
        };
        pieces.push(vec![0; length.next_multiple_of(4) - length]);
        self.length += length.next_multiple_of(4);
        self.pieces.append(&mut pieces);
        Index::push(&mut self.views, view)
    }

    /// Adds `count` elements that begin at a byte of a view.
    fn accessor(
        &mut self,
        view: Index<buffer::View>,
        start: usize,
        count: usize,
        component: ComponentType,
        of: Type,
    ) -> Index<Accessor> {
        let accessor = Accessor {
            buffer_view: Some(view),
            byte_offset: Some(start.into()),
            count: count.into(),
            component_type: Valid(GenericComponentType(component)),
            type_: Valid(of),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: None,
        };
        Index::push(&mut self.accessors, accessor)
    }

    /// Adds one row of f32 per vertex.
    fn rows<const N: usize>(&mut self, count: usize, row: impl Fn(usize) -> [f32; N] + Sync) -> Index<Accessor> {
        let push = |i: usize, out: &mut Vec<u8>| row(i).iter().for_each(|x| out.extend(x.to_le_bytes()));
        let view = self.view(in_pieces(count, push), Some(Use::ArrayBuffer));
        let of = match N {
            2 => Type::Vec2,
            3 => Type::Vec3,
            _ => Type::Vec4,
        };
        self.accessor(view, 0, count, ComponentType::F32, of)
    }

    /// The one buffer, if there is anything in it.
    fn buffers(&self, uri: Option<String>) -> Vec<Buffer> {
        let buffer = Buffer { byte_length: self.length.into(), name: None, uri, extensions: None, extras: None };
        if self.length > 0 { vec![buffer] } else { vec![] }
    }
}

/// The bytes of a GLB file.
pub(crate) fn encode_glb(model: &Model) -> Encoded {
    let mut encoded = Encoded::default();
    let mut store = Store::default();
    let mut document = document(model, &mut store, None, &mut encoded);
    document.buffers = store.buffers(None);
    let glb = Glb {
        // Filled in by the writer.
        header: Header { magic: *b"glTF", version: 2, length: 0 },
        json: Cow::Owned(document.to_vec().unwrap_or_default()),
        bin: (store.length > 0).then(|| Cow::Owned(store.pieces.concat())),
    };
    encoded.body = vec![glb.to_vec().unwrap_or_default()];
    encoded
}

/// The bytes of a glTF file in JSON. The buffer is a side file, or without a target a data URI.
pub(crate) fn encode_json(model: &Model, target: Option<&Target>) -> Encoded {
    let mut encoded = Encoded::default();
    let mut store = Store::default();
    let mut document = document(model, &mut store, target, &mut encoded);
    if store.length > 0 {
        let bytes = store.pieces.concat();
        let uri = match target {
            Some(target) => {
                let name = format!("{}.bin", target.stem);
                let uri = percent_encoded(&name);
                encoded.sides.push(Side { name, content: Content::Bytes(bytes) });
                uri
            }
            None => format!("data:application/octet-stream;base64,{}", to_base64(&bytes)),
        };
        document.buffers = store.buffers(Some(uri));
    }
    let mut text = document.to_vec_pretty().unwrap_or_default();
    text.push(b'\n');
    encoded.body = vec![text];
    encoded
}

/// Everything but the buffer.
fn document(model: &Model, store: &mut Store, target: Option<&Target>, encoded: &mut Encoded) -> Root {
    let asset = json::Asset {
        version: "2.0".into(),
        generator: Some(concat!("mesh-io ", env!("CARGO_PKG_VERSION")).into()),
        ..json::Asset::default()
    };
    let mut document = Root { asset, scene: Some(Index::new(0)), ..Root::default() };
    let mut scene = json::Scene { name: None, nodes: vec![], extensions: None, extras: None };
    if model.mesh.faces.is_empty() {
        encoded.notes.add("vertices without faces dropped", model.mesh.positions.len(), None);
        document.scenes = vec![scene];
        return document;
    }
    let (attributes, entry_of_corner) = vertices(model, store, &mut encoded.notes);
    let primitives = primitives(model, store, &attributes, &entry_of_corner);
    let mesh = json::Mesh { primitives, name: None, weights: None, extensions: None, extras: None };
    let node = json::Node { mesh: Some(Index::push(&mut document.meshes, mesh)), ..json::Node::default() };
    scene.nodes.push(Index::push(&mut document.nodes, node));
    document.scenes = vec![scene];
    if let Some(materials) = &model.materials {
        looks(materials, store, target, encoded, &mut document);
    }
    document.accessors = std::mem::take(&mut store.accessors);
    document.buffer_views = std::mem::take(&mut store.views);
    document
}

/// What a vertex has, by name.
type Attributes = BTreeMap<json::validation::Checked<Semantic>, Index<Accessor>>;

/// Stores the vertices, split where corners at one vertex differ, in vertex order so that welding restores it.
/// Returns the attributes' accessors and the stored vertex of each corner.
fn vertices(model: &Model, store: &mut Store, notes: &mut Notes) -> (Attributes, Vec<u32>) {
    let mesh = &model.mesh;
    let uvs = model.uvs.as_ref().map(IdMap::as_slice);
    let colors = model.colors.as_ref().map(IdMap::as_slice);
    let usable = |n: &&DVec3| n.try_normalize().is_some();
    let normals = model.normals.as_ref().map(IdMap::as_slice);
    let normals = normals.filter(|all| {
        let missing = all.len() - all.iter().filter(usable).count();
        notes.add("normals dropped, since glTF needs one at every corner and some have none", missing, None);
        missing == 0
    });

    // Each stored vertex: its vertex and, where corners matter, one of its corners.
    let (entries, entry_of_corner): (Vec<(u32, Option<u32>)>, Vec<u32>) =
        if uvs.is_none() && colors.is_none() && normals.is_none() {
            let vertices = (0..mesh.positions.len() as u32).map(|v| (v, None)).collect();
            (vertices, mesh.faces.as_flattened().iter().map(|v| v.0).collect())
        } else {
            let bits = |c: usize| (uvs.map(|m| m[c].bits()), colors.map(|m| m[c].bits()), normals.map(|m| m[c].bits()));
            let gathered = distinct(mesh, bits);
            let corner_vertices = mesh.faces.as_flattened();
            let mut split: Vec<(u32, Option<u32>)> = vec![];
            let mut number = vec![0; gathered.example.len()];
            let mut next_vertex = 0;
            for (example, &corner) in gathered.example.iter().enumerate() {
                let v = corner_vertices[corner as usize].0;
                split.extend((next_vertex..v).map(|unused| (unused, None)));
                next_vertex = v + 1;
                number[example] = split.len() as u32;
                split.push((v, Some(corner)));
            }
            split.extend((next_vertex..mesh.positions.len() as u32).map(|unused| (unused, None)));
            (split, gathered.of_corner.iter().map(|&e| number[e as usize]).collect())
        };

    let place = |i: usize| mesh.positions[entries[i].0 as usize].as_vec3().to_array();
    let position = store.rows(entries.len(), place);
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for i in 0..entries.len() {
        for (k, x) in place(i).into_iter().enumerate() {
            (low[k], high[k]) = (low[k].min(x), high[k].max(x));
        }
    }
    let range = &mut store.accessors[position.value()];
    (range.min, range.max) = (Some(low.to_vec().into()), Some(high.to_vec().into()));
    let mut attributes = Attributes::from([(Valid(Semantic::Positions), position)]);
    if let Some(normals) = normals {
        let unit = |i: usize| entries[i].1.map_or(DVec3::Z, |c| normals[c as usize].normalize());
        let accessor = store.rows(entries.len(), |i| unit(i).as_vec3().to_array());
        attributes.insert(Valid(Semantic::Normals), accessor);
    }
    if let Some(uvs) = uvs {
        // glTF counts v from the top, and has no way to leave a value out.
        let value = |i: usize| entries[i].1.map(|c| uvs[c as usize]).filter(|uv| !uv.is_none()).unwrap_or([0.0, 1.0]);
        let row = |i: usize| [value(i)[0] as f32, (1.0 - value(i)[1]) as f32];
        attributes.insert(Valid(Semantic::TexCoords(0)), store.rows(entries.len(), row));
    }
    if let Some(colors) = colors {
        let value = |i: usize| entries[i].1.map(|c| colors[c as usize]).filter(|c| !c.is_none()).unwrap_or([1.0; 4]);
        let accessor = store.rows(entries.len(), |i| value(i).map(|x| x as f32));
        attributes.insert(Valid(Semantic::Colors(0)), accessor);
    }
    (attributes, entry_of_corner)
}

/// One primitive for each pair of group and material, in order of first appearance.
fn primitives(model: &Model, store: &mut Store, attributes: &Attributes, entry_of_corner: &[u32]) -> Vec<Primitive> {
    let label = |map: Option<&[u32]>, f: usize| map.map(|m| m[f]);
    let groups = model.groups.as_ref().map(|g| g.of_face.as_slice());
    let materials = model.materials.as_ref().map(|m| m.of_face.as_slice());
    let mut slot_of: BTreeMap<(Option<u32>, Option<u32>), usize> = BTreeMap::new();
    let mut slots = vec![];
    for f in 0..model.mesh.faces.len() {
        let key = (label(groups, f), label(materials, f));
        let slot = *slot_of.entry(key).or_insert_with(|| {
            slots.push((key, vec![]));
            slots.len() - 1
        });
        slots[slot].1.push(f as u32);
    }
    let mut start = 0;
    let mut all = vec![];
    let primitives = slots.iter().map(|((group, material), faces)| {
        let push = |i: usize, out: &mut Vec<u8>| {
            let corners = 3 * faces[i] as usize..3 * faces[i] as usize + 3;
            corners.for_each(|c| out.extend(entry_of_corner[c].to_le_bytes()));
        };
        all.extend(in_pieces(faces.len(), push));
        let view = Index::new(store.views.len() as u32);
        let count = 3 * faces.len();
        let indices = store.accessor(view, start, count, ComponentType::U32, Type::Scalar);
        start += 4 * count;
        let group = group.zip(model.groups.as_ref()).map(|(group, groups)| &groups.names[group as usize]);
        Primitive {
            attributes: attributes.clone(),
            indices: Some(indices),
            material: material.map(Index::new),
            mode: Valid(Mode::Triangles),
            targets: None,
            extensions: None,
            extras: group.and_then(|name| to_raw_value(&BTreeMap::from([("group", name)])).ok()),
        }
    });
    let primitives = primitives.collect();
    store.view(all, Some(Use::ElementArrayBuffer));
    primitives
}

/// Materials, textures and images.
fn looks(
    materials: &Materials,
    store: &mut Store,
    target: Option<&Target>,
    encoded: &mut Encoded,
    document: &mut Root,
) {
    let beside = target.map(|target| target.pictures(&materials.list, &mut encoded.sides));
    for (i, material) in materials.list.iter().enumerate() {
        let image = match &beside {
            Some(names) => names[i].as_ref().map(|name| Image { uri: Some(percent_encoded(name)), ..no_image() }),
            None => embedded(material, store, &mut encoded.notes),
        };
        let picture = image.map(|image| {
            let source = Index::push(&mut document.images, image);
            let texture = Texture { name: None, sampler: None, source, extensions: None, extras: None };
            let index = Index::push(&mut document.textures, texture);
            texture::Info { index, tex_coord: 0, extensions: None, extras: None }
        });
        let pbr = PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor(material.base_color.map(|x| x.clamp(0.0, 1.0) as f32)),
            base_color_texture: picture,
            metallic_factor: StrengthFactor(material.metallic.clamp(0.0, 1.0) as f32),
            roughness_factor: StrengthFactor(material.roughness.clamp(0.0, 1.0) as f32),
            ..PbrMetallicRoughness::default()
        };
        let opaque = material.base_color[3] >= 1.0;
        document.materials.push(json::Material {
            name: Some(material.name.clone()).filter(|name| !name.is_empty()),
            pbr_metallic_roughness: pbr,
            alpha_mode: Valid(if opaque { AlphaMode::Opaque } else { AlphaMode::Blend }),
            ..json::Material::default()
        });
    }
}

fn no_image() -> Image {
    Image { buffer_view: None, mime_type: None, name: None, uri: None, extensions: None, extras: None }
}

/// A material's picture as an image in the buffer. glTF takes PNG and JPEG only.
fn embedded(material: &Material, store: &mut Store, notes: &mut Notes) -> Option<Image> {
    let texture = material.texture.as_ref()?;
    let bytes = match &texture.source {
        TextureSource::Embedded(bytes) => Some(bytes.to_vec()),
        TextureSource::File(path) => {
            let small = path.metadata().is_ok_and(|m| m.len() <= MAX_PICTURE);
            small.then(|| std::fs::read(path).ok()).flatten()
        }
        TextureSource::Missing => None,
    };
    let Some(bytes) = bytes.filter(|b| is_png(b) || is_jpeg(b)) else {
        notes.add("pictures dropped, since they are missing or neither PNG nor JPEG", 1, None);
        return None;
    };
    let kind = if is_png(&bytes) { "image/png" } else { "image/jpeg" };
    let view = store.view(vec![bytes], None);
    let mime_type = Some(json::image::MimeType(kind.into()));
    Some(Image { buffer_view: Some(view), mime_type, name: Some(texture.name.clone()), ..no_image() })
}
