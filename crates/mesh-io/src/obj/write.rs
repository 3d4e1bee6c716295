//! Writes OBJ with its material library.

use super::mtl;
use crate::encode::{Content, Encoded, Side, Target, UNNAMED, clean_name, distinct_names, in_pieces};
use crate::model::{Material, Materials, Model};
use crate::number::{push_f64, push_u64};
use crate::outline::Outline;
use crate::vary::{Value, distinct, mean_per_vertex};
use mesh_core::CornerMap;

/// Values that corners refer to by number, from 1; 0 for none.
struct Pool<T> {
    values: Vec<T>,
    of_corner: Vec<u32>,
}

/// The bytes of an OBJ file. Positions print as the shortest decimals that read back bit for bit. Without a target
/// there is no material library and materials go by name only.
pub(crate) fn encode(model: &Model, target: Option<&Target>) -> Encoded {
    let mut encoded = Encoded::default();
    let named = model.materials.as_ref().map(named);
    let material_names = distinct_names(named.iter().flatten());
    if let (Some(materials), Some(target)) = (&model.materials, target) {
        let pictures = target.pictures(&materials.list, &mut encoded.sides);
        let name = format!("{}.mtl", target.stem);
        encoded.body.push(format!("mtllib {name}\n").into_bytes());
        let bytes = mtl::encode(&materials.list, &material_names, &pictures);
        encoded.sides.push(Side { name, content: Content::Bytes(bytes) });
    }

    let colors = model.colors.as_ref().map(|colors| mean_per_vertex(&model.mesh, colors));
    let colors = colors.map(|(colors, mixed)| {
        encoded.notes.add("vertices with the mean of several colours, since OBJ holds one per vertex", mixed, None);
        colors
    });
    encoded.body.extend(in_pieces(model.mesh.positions.len(), |i, out| {
        push_row(out, b"v", &model.mesh.positions[i].to_array());
        if let Some(color) = colors.as_ref().map(|c| c[i]).filter(|c| !c.is_none()) {
            out.pop();
            push_row(out, b"", if color[3] == 1.0 { &color[..3] } else { &color });
        }
    }));
    let uvs = model.uvs.as_ref().map(|m| pool(model, m));
    let normals = model.normals.as_ref().map(|m| pool(model, m));
    if let Some(uvs) = &uvs {
        encoded.body.extend(in_pieces(uvs.values.len(), |i, out| push_row(out, b"vt", &uvs.values[i])));
    }
    if let Some(normals) = &normals {
        let row = |i: usize, out: &mut Vec<u8>| push_row(out, b"vn", &normals.values[i].to_array());
        encoded.body.extend(in_pieces(normals.values.len(), row));
    }

    let outline = Outline::of(model);
    let group_names = distinct_names(model.groups.iter().flat_map(|g| &g.names));
    let (no_group, no_material) = (unnamed(&group_names), unnamed(&material_names));
    let first_face = |polygon: usize| outline.corners(polygon).next().map(|c| c / 3);
    let vertices = model.mesh.faces.as_flattened();
    encoded.body.extend(in_pieces(outline.len(), |i, out| {
        let (face, last) = (first_face(i), i.checked_sub(1).and_then(first_face));
        let mut switch = |keyword: &[u8], of_face: &[u32], names: &[String], unset: u32| {
            let label = |f: Option<usize>| f.map_or(unset, |f| of_face[f]);
            if label(face) != label(last) {
                out.extend_from_slice(keyword);
                out.extend_from_slice(names[label(face) as usize].as_bytes());
                out.push(b'\n');
            }
        };
        if let Some(groups) = &model.groups {
            switch(b"g ", groups.of_face.as_slice(), &group_names, no_group);
        }
        if let Some(materials) = &model.materials {
            switch(b"usemtl ", materials.of_face.as_slice(), &material_names, no_material);
        }
        out.push(b'f');
        for corner in outline.corners(i) {
            out.push(b' ');
            push_u64(out, u64::from(vertices[corner].0) + 1);
            let uv = uvs.as_ref().map_or(0, |p| p.of_corner[corner]);
            let normal = normals.as_ref().map_or(0, |p| p.of_corner[corner]);
            if uv != 0 || normal != 0 {
                out.push(b'/');
            }
            if uv != 0 {
                push_u64(out, u64::from(uv));
            }
            if normal != 0 {
                out.push(b'/');
                push_u64(out, u64::from(normal));
            }
        }
        out.push(b'\n');
    }));
    encoded
}

/// The names of materials. The nameless one stays so only where no statement has to name it: at the start of the file.
fn named(materials: &Materials) -> Vec<String> {
    let first = materials.of_face.as_slice().first().map_or(0, |&m| m as usize);
    let starts = materials.of_face.as_slice().chunk_by(|a, b| a == b).filter(|run| run[0] as usize == first).count();
    let name = |(i, material): (usize, &Material)| {
        if clean_name(&material.name).is_empty() && (i != first || starts > 1) {
            UNNAMED.to_string()
        } else {
            material.name.clone()
        }
    };
    materials.list.iter().enumerate().map(name).collect()
}

/// The label that needs no statement at the start of a file: the empty name, if there is one.
fn unnamed(names: &[String]) -> u32 {
    names.iter().position(String::is_empty).map_or(u32::MAX, |i| i as u32)
}

fn push_row(out: &mut Vec<u8>, keyword: &[u8], values: &[f64]) {
    out.extend_from_slice(keyword);
    for &x in values {
        out.push(b' ');
        push_f64(out, x);
    }
    out.push(b'\n');
}

fn pool<T: Value>(model: &Model, map: &CornerMap<T>) -> Pool<T> {
    let values = map.as_slice();
    let gathered = distinct(&model.mesh, |c| values[c].bits());
    let mut pool = Pool { values: vec![], of_corner: vec![] };
    let number: Vec<u32> = gathered
        .example
        .iter()
        .map(|&c| {
            if values[c as usize].is_none() {
                return 0;
            }
            pool.values.push(values[c as usize]);
            pool.values.len() as u32
        })
        .collect();
    pool.of_corner = gathered.of_corner.iter().map(|&e| number[e as usize]).collect();
    pool
}
