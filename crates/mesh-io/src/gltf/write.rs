//! Writes glTF: one mesh of f32 vertices, a primitive for every pair of group and material.

use super::buffers::{percent_encoded, to_base64};
use super::look::{is_jpeg, is_png};
use crate::encode::{Content, Encoded, Side, Target, in_pieces};
use crate::model::{Material, Materials, Model, TextureSource};
use crate::notes::Notes;
use crate::vary::{Value as _, distinct};
use glam::DVec3;
use mesh_core::IdMap;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Pictures larger than this are not embedded.
const MAX_PICTURE: u64 = 256 << 20;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// The binary buffer as it grows, with the views and accessors into it.
#[derive(Default)]
struct Store {
    pieces: Vec<Vec<u8>>,
    length: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Store {
    /// Adds bytes, padded to a multiple of four, and returns the view's index.
    fn view(&mut self, mut pieces: Vec<Vec<u8>>, target: Option<u32>) -> usize {
        let length: usize = pieces.iter().map(Vec::len).sum();
        let mut view = json!({ "buffer": 0, "byteOffset": self.length, "byteLength": length });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.views.push(view);
        pieces.push(vec![0; length.next_multiple_of(4) - length]);
        self.length += length.next_multiple_of(4);
        self.pieces.append(&mut pieces);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Adds one row of f32 per vertex.
    fn rows<const N: usize>(&mut self, count: usize, row: impl Fn(usize) -> [f32; N] + Sync) -> usize {
        let push = |i: usize, out: &mut Vec<u8>| row(i).iter().for_each(|x| out.extend(x.to_le_bytes()));
        let view = self.view(in_pieces(count, push), Some(ARRAY_BUFFER));
        let kind = format!("VEC{N}");
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind }))
    }
}

/// The bytes of a GLB file.
pub(crate) fn encode_glb(model: &Model) -> Encoded {
    let mut encoded = Encoded::default();
    let mut store = Store::default();
    let mut document = document(model, &mut store, None, &mut encoded);
    if store.length > 0 {
        document["buffers"] = json!([{ "byteLength": store.length }]);
    }
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let binary = if store.length > 0 { 8 + store.length } else { 0 };
    let mut head = b"glTF".to_vec();
    for word in [2, 12 + 8 + json.len() + binary, json.len()] {
        head.extend((word as u32).to_le_bytes());
    }
    head.extend(b"JSON");
    encoded.body = vec![head, json];
    if store.length > 0 {
        let mut head = (store.length as u32).to_le_bytes().to_vec();
        head.extend(b"BIN\0");
        encoded.body.push(head);
        encoded.body.append(&mut store.pieces);
    }
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
        document["buffers"] = json!([{ "byteLength": store.length, "uri": uri }]);
    }
    let mut text = serde_json::to_vec_pretty(&document).unwrap_or_default();
    text.push(b'\n');
    encoded.body = vec![text];
    encoded
}

/// Everything but the buffer.
fn document(model: &Model, store: &mut Store, target: Option<&Target>, encoded: &mut Encoded) -> Value {
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("mesh-io ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{}],
    });
    if model.mesh.faces.is_empty() {
        encoded.notes.add("vertices without faces dropped", model.mesh.positions.len(), None);
        return document;
    }
    let (attributes, entry_of_corner) = vertices(model, store, &mut encoded.notes);
    let primitives = primitives(model, store, &attributes, &entry_of_corner);
    document["scenes"] = json!([{ "nodes": [0] }]);
    document["nodes"] = json!([{ "mesh": 0 }]);
    document["meshes"] = json!([{ "primitives": primitives }]);
    if let Some(materials) = &model.materials {
        looks(materials, store, target, encoded, &mut document);
    }
    document["accessors"] = std::mem::take(&mut store.accessors).into();
    document["bufferViews"] = std::mem::take(&mut store.views).into();
    document
}

/// Stores the vertices, split where corners at one vertex differ, in vertex order so that welding restores it.
/// Returns the attributes' accessors and the stored vertex of each corner.
fn vertices(model: &Model, store: &mut Store, notes: &mut Notes) -> (Value, Vec<u32>) {
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
    store.accessors[position]["min"] = json!(low.map(f64::from));
    store.accessors[position]["max"] = json!(high.map(f64::from));
    let mut attributes = json!({ "POSITION": position });
    if let Some(normals) = normals {
        let unit = |i: usize| entries[i].1.map_or(DVec3::Z, |c| normals[c as usize].normalize());
        attributes["NORMAL"] = store.rows(entries.len(), |i| unit(i).as_vec3().to_array()).into();
    }
    if let Some(uvs) = uvs {
        // glTF counts v from the top, and has no way to leave a value out.
        let value = |i: usize| entries[i].1.map(|c| uvs[c as usize]).filter(|uv| !uv.is_none()).unwrap_or([0.0, 1.0]);
        let row = |i: usize| [value(i)[0] as f32, (1.0 - value(i)[1]) as f32];
        attributes["TEXCOORD_0"] = store.rows(entries.len(), row).into();
    }
    if let Some(colors) = colors {
        let value = |i: usize| entries[i].1.map(|c| colors[c as usize]).filter(|c| !c.is_none()).unwrap_or([1.0; 4]);
        attributes["COLOR_0"] = store.rows(entries.len(), |i| value(i).map(|x| x as f32)).into();
    }
    (attributes, entry_of_corner)
}

/// One primitive for each pair of group and material, in order of first appearance.
fn primitives(model: &Model, store: &mut Store, attributes: &Value, entry_of_corner: &[u32]) -> Vec<Value> {
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
        let view = store.views.len();
        let count = 3 * faces.len();
        let indices = store.accessor(json!({
            "bufferView": view, "byteOffset": start, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR",
        }));
        start += 4 * count;
        let mut primitive = json!({ "attributes": attributes, "indices": indices });
        if let Some(material) = material {
            primitive["material"] = (*material).into();
        }
        if let (Some(group), Some(groups)) = (group, &model.groups) {
            primitive["extras"] = json!({ "group": groups.names[*group as usize] });
        }
        primitive
    });
    let primitives = primitives.collect();
    store.view(all, Some(ELEMENT_ARRAY_BUFFER));
    primitives
}

/// Materials, textures and images.
fn looks(
    materials: &Materials,
    store: &mut Store,
    target: Option<&Target>,
    encoded: &mut Encoded,
    document: &mut Value,
) {
    let beside = target.map(|target| target.pictures(&materials.list, &mut encoded.sides));
    let (mut list, mut images) = (vec![], vec![]);
    for (i, material) in materials.list.iter().enumerate() {
        let mut pbr = json!({
            "baseColorFactor": material.base_color.map(|x| x.clamp(0.0, 1.0)),
            "metallicFactor": material.metallic.clamp(0.0, 1.0),
            "roughnessFactor": material.roughness.clamp(0.0, 1.0),
        });
        let image = match &beside {
            Some(names) => names[i].as_ref().map(|name| json!({ "uri": percent_encoded(name) })),
            None => embedded(material, store, &mut encoded.notes),
        };
        if let Some(image) = image {
            pbr["baseColorTexture"] = json!({ "index": images.len() });
            images.push(image);
        }
        let mut entry = json!({ "name": material.name, "pbrMetallicRoughness": pbr });
        if material.base_color[3] < 1.0 {
            entry["alphaMode"] = "BLEND".into();
        }
        list.push(entry);
    }
    document["materials"] = list.into();
    if !images.is_empty() {
        document["textures"] = (0..images.len()).map(|i| json!({ "source": i })).collect();
        document["images"] = images.into();
    }
}

/// A material's picture as an image in the buffer. glTF takes PNG and JPEG only.
fn embedded(material: &Material, store: &mut Store, notes: &mut Notes) -> Option<Value> {
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
    Some(json!({ "bufferView": view, "mimeType": kind, "name": texture.name }))
}
