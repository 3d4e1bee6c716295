//! Writes OFF as text.

use crate::encode::{Encoded, in_pieces};
use crate::model::Model;
use crate::number::{push_f64, push_u64};
use crate::outline::Outline;
use crate::vary::{Value, per_face, per_vertex};

/// The bytes of an OFF file, in the dialect that its attributes need. Positions print as the shortest decimals that
/// read back bit for bit.
pub(crate) fn encode(model: &Model) -> Encoded {
    let mesh = &model.mesh;
    let mut encoded = Encoded::default();
    let uvs = model.uvs.as_ref().and_then(|m| per_vertex(mesh, m));
    let normals = model.normals.as_ref().and_then(|m| per_vertex(mesh, m));
    let colors = model.colors.as_ref().and_then(|m| per_vertex(mesh, m));
    let face_colors = model.colors.as_ref().filter(|_| colors.is_none()).and_then(|m| per_face(mesh, m));
    let lost = [
        model.uvs.is_some() && uvs.is_none(),
        model.normals.is_some() && normals.is_none(),
        model.colors.is_some() && colors.is_none() && face_colors.is_none(),
        model.groups.is_some(),
        model.materials.is_some(),
    ];
    let lost = lost.iter().filter(|&&l| l).count();
    encoded.notes.add("attributes dropped, since OFF holds one value per vertex and no names", lost, None);

    let outline = Outline::of(model);
    let prefix = |on: bool, letters: &'static str| if on { letters } else { "" };
    encoded.body.push(
        format!(
            "{}{}{}OFF\n{} {} 0\n",
            prefix(uvs.is_some(), "ST"),
            prefix(colors.is_some(), "C"),
            prefix(normals.is_some(), "N"),
            mesh.positions.len(),
            outline.len()
        )
        .into_bytes(),
    );
    encoded.body.extend(in_pieces(mesh.positions.len(), |i, out| {
        let mut row = |values: &[f64]| {
            for &x in values {
                // No value: OFF has no way to leave one out.
                push_f64(out, if x.is_nan() { 0.0 } else { x });
                out.push(b' ');
            }
        };
        row(&mesh.positions[i].to_array());
        if let Some(normals) = &normals {
            row(&normals[i].to_array());
        }
        if let Some(color) = colors.as_ref().map(|m| m[i]) {
            row(&if color.is_none() { [1.0; 4] } else { color });
        }
        if let Some(uvs) = &uvs {
            row(&uvs[i]);
        }
        out.pop();
        out.push(b'\n');
    }));
    let vertices = mesh.faces.as_flattened();
    encoded.body.extend(in_pieces(outline.len(), |i, out| {
        let corners = outline.corners(i);
        push_u64(out, corners.len() as u64);
        for corner in corners.clone() {
            out.push(b' ');
            push_u64(out, u64::from(vertices[corner].0));
        }
        let face = corners.clone().next().map_or(0, |c| c / 3);
        if let Some(color) = face_colors.as_ref().map(|m| m[face]).filter(|c| !c.is_none()) {
            for x in color {
                // A point marks the value as a fraction of 1.
                out.extend_from_slice(format!(" {x:?}").as_bytes());
            }
        }
        out.push(b'\n');
    }));
    encoded
}
