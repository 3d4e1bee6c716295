//! Writes PLY: binary, little-endian, `double` wherever the model holds f64.

use crate::encode::{Encoded, Target, in_pieces};
use crate::model::Model;
use crate::outline::Outline;
use crate::vary::{Value, mean_per_vertex, per_face, per_vertex};
use std::fmt::Write;

const RGBA: [&str; 4] = ["red", "green", "blue", "alpha"];

/// The bytes of a PLY file. Positions keep every bit.
pub(crate) fn encode(model: &Model, target: Option<&Target>) -> Encoded {
    let mesh = &model.mesh;
    let mut encoded = Encoded::default();
    let uvs = model.uvs.as_ref().and_then(|m| per_vertex(mesh, m));
    let corner_uvs = model.uvs.as_ref().filter(|_| uvs.is_none());
    let normals = model.normals.as_ref().and_then(|m| per_vertex(mesh, m));
    let means = model.colors.as_ref().map(|m| mean_per_vertex(mesh, m));
    let face_colors = means.as_ref().filter(|m| m.1 > 0).and_then(|_| per_face(mesh, model.colors.as_ref()?));
    let colors = means.filter(|_| face_colors.is_none());
    let mixed = colors.as_ref().map_or(0, |m| m.1);
    let colors = colors.map(|m| m.0);
    encoded.notes.add("vertices with the mean of several colours, since PLY holds one per vertex or face", mixed, None);
    let texture = model.materials.as_ref().filter(|m| m.list.len() == 1 && m.list[0].texture.is_some()).and_then(|m| {
        let target = target?;
        target.pictures(&m.list, &mut encoded.sides).pop().flatten()
    });
    let lost = [
        (model.normals.is_some() && normals.is_none(), "normals dropped, since PLY holds one per vertex"),
        (model.groups.is_some(), "group names dropped, since PLY has none"),
        (model.materials.is_some() && texture.is_none(), "materials dropped, since PLY has none"),
    ];
    for (_, what) in lost.iter().filter(|(lost, _)| *lost) {
        encoded.notes.add(what, 1, None);
    }

    // Mixed sizes are legal, but widespread readers take the first face's size for all.
    let mut outline = Outline::of(model);
    if !outline.is_uniform() {
        outline = Outline::triangles(model);
        encoded.notes.add("polygons of mixed sizes written as triangles", 1, None);
    }
    let mut head = String::from("ply\nformat binary_little_endian 1.0\n");
    if let Some(name) = &texture {
        let _ = writeln!(head, "comment TextureFile {name}");
    }
    let _ = writeln!(head, "element vertex {}", mesh.positions.len());
    let mut properties = |kind: &str, names: &[&str]| {
        for name in names {
            let _ = writeln!(head, "property {kind} {name}");
        }
    };
    properties("double", &["x", "y", "z"]);
    if normals.is_some() {
        properties("double", &["nx", "ny", "nz"]);
    }
    if uvs.is_some() {
        properties("double", &["s", "t"]);
    }
    if colors.is_some() {
        properties("uchar", &RGBA);
    }
    let wide = 2 * outline.largest() > 255;
    let _ = writeln!(head, "element face {}", outline.len());
    let _ = writeln!(head, "property list {} int vertex_indices", if wide { "uint" } else { "uchar" });
    if corner_uvs.is_some() {
        let _ = writeln!(head, "property list {} double texcoord", if wide { "uint" } else { "uchar" });
    }
    if face_colors.is_some() {
        for name in RGBA {
            let _ = writeln!(head, "property uchar {name}");
        }
    }
    head.push_str("end_header\n");
    encoded.body.push(head.into_bytes());

    encoded.body.extend(in_pieces(mesh.positions.len(), |i, out| {
        push_doubles(out, &mesh.positions[i].to_array());
        if let Some(normals) = &normals {
            push_doubles(out, &normals[i].to_array());
        }
        if let Some(uvs) = &uvs {
            push_doubles(out, &uvs[i]);
        }
        if let Some(colors) = &colors {
            out.extend(bytes_of(colors[i]));
        }
    }));
    let vertices = mesh.faces.as_flattened();
    encoded.body.extend(in_pieces(outline.len(), |i, out| {
        let corners = outline.corners(i);
        let push_length = |out: &mut Vec<u8>, n: usize| {
            if wide { out.extend((n as u32).to_le_bytes()) } else { out.push(n as u8) }
        };
        push_length(out, corners.len());
        for corner in corners.clone() {
            out.extend(vertices[corner].0.to_le_bytes());
        }
        if let Some(map) = corner_uvs {
            push_length(out, 2 * corners.len());
            for corner in corners.clone() {
                push_doubles(out, &map.as_slice()[corner]);
            }
        }
        let face = corners.clone().next().map_or(0, |c| c / 3);
        if let Some(colors) = &face_colors {
            out.extend(bytes_of(colors[face]));
        }
    }));
    encoded
}

fn push_doubles(out: &mut Vec<u8>, values: &[f64]) {
    for &x in values {
        // No value: PLY has no way to leave one out, and few readers expect NaN.
        out.extend(if x.is_nan() { 0.0 } else { x }.to_le_bytes());
    }
}

/// A colour in bytes; white where there is none.
fn bytes_of(color: [f64; 4]) -> [u8; 4] {
    if color.is_none() { [255; 4] } else { color.map(|x| (255.0 * x).round().clamp(0.0, 255.0) as u8) }
}
