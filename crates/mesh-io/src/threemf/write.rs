//! Writes 3MF: one object, built where it stands.

use crate::encode::{Encoded, UNNAMED, clean_name, in_pieces};
use crate::model::Model;
use crate::number::{push_f64, push_u64};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;
const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

/// The bytes of a 3MF package, in the model's unit or else in millimetres. Positions print as the shortest decimals that read back bit for bit.
pub(crate) fn encode(model: &Model) -> Encoded {
    let mut encoded = Encoded::default();
    let text = model_text(model, &mut encoded);
    // Writing to memory fails only beyond 4 GiB, where the writer was not told to use large entries; it is.
    encoded.body = vec![package(&text).unwrap_or_default()];
    encoded
}

fn package(model: &[Vec<u8>]) -> zip::result::ZipResult<Vec<u8>> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        // Text of numbers gains little from more effort.
        .compression_level(Some(1))
        .last_modified_time(DateTime::default())
        .large_file(model.iter().map(Vec::len).sum::<usize>() > 1 << 31);
    let mut zip = ZipWriter::new(Cursor::new(vec![]));
    for (name, text) in [("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONS)] {
        zip.start_file(name, options)?;
        zip.write_all(text.as_bytes())?;
    }
    zip.start_file("3D/3dmodel.model", options)?;
    for piece in model {
        zip.write_all(piece)?;
    }
    Ok(zip.finish()?.into_inner())
}

fn model_text(model: &Model, encoded: &mut Encoded) -> Vec<Vec<u8>> {
    let mesh = &model.mesh;
    let (colors, color_of_corner) = palette(model);
    let materials = model.materials.as_ref().filter(|_| colors.is_empty());
    let lost = [
        (model.uvs.is_some(), "texture coordinates dropped"),
        (model.normals.is_some(), "normals dropped, since 3MF has none"),
        (model.materials.is_some() && materials.is_none(), "materials dropped in favour of colours"),
        (
            model.groups.as_ref().is_some_and(|g| g.names.len() > 1),
            "group names dropped, since objects would split the mesh",
        ),
    ];
    for (_, what) in lost.iter().filter(|(lost, _)| *lost) {
        encoded.notes.add(what, 1, None);
    }

    let unit = model.unit.unwrap_or_default().name();
    let mut head = format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"{unit}\" xml:lang=\"en-US\" ");
    head.push_str(concat!(
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" ",
        "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n<resources>\n"
    ));
    if let Some(materials) = materials {
        head.push_str("<basematerials id=\"1\">\n");
        for material in &materials.list {
            let color = hex(bytes_of(material.base_color));
            let name = if clean_name(&material.name).is_empty() { UNNAMED } else { &material.name };
            let _ = writeln!(head, "<base name=\"{}\" displaycolor=\"{color}\"/>", escaped(name));
        }
        head.push_str("</basematerials>\n");
    }
    if !colors.is_empty() {
        head.push_str("<m:colorgroup id=\"1\">\n");
        for &color in &colors {
            let _ = writeln!(head, "<m:color color=\"{}\"/>", hex(color));
        }
        head.push_str("</m:colorgroup>\n");
    }
    let name = model.groups.as_ref().filter(|g| g.names.len() == 1).map_or("", |g| &g.names[0]);
    let name = if name.is_empty() { String::new() } else { format!(" name=\"{}\"", escaped(name)) };
    let _ = write!(head, "<object id=\"2\" type=\"model\"{name}>\n<mesh>\n<vertices>\n");

    let mut text = vec![head.into_bytes()];
    text.extend(in_pieces(mesh.positions.len(), |i, out| {
        out.extend(b"<vertex");
        for (name, x) in [b"x", b"y", b"z"].iter().zip(mesh.positions[i].to_array()) {
            out.push(b' ');
            out.extend(*name);
            out.extend(b"=\"");
            push_f64(out, x);
            out.push(b'"');
        }
        out.extend(b"/>\n");
    }));
    text.push(b"</vertices>\n<triangles>\n".to_vec());
    text.extend(in_pieces(mesh.faces.len(), |f, out| {
        let mut field = |name: &[u8], value: u32| {
            out.extend(name);
            push_u64(out, u64::from(value));
            out.push(b'"');
        };
        let [a, b, c] = mesh.faces[f];
        field(b"<triangle v1=\"", a.0);
        field(b" v2=\"", b.0);
        field(b" v3=\"", c.0);
        if let Some(materials) = materials {
            field(b" pid=\"", 1);
            field(b" p1=\"", materials.of_face.as_slice()[f]);
        } else if let Some([Some(a), Some(b), Some(c)]) = color_of_corner.get(f) {
            field(b" pid=\"", 1);
            field(b" p1=\"", *a);
            field(b" p2=\"", *b);
            field(b" p3=\"", *c);
        }
        out.extend(b"/>\n");
    }));
    let tail = "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"2\"/>\n</build>\n</model>\n";
    text.push(tail.as_bytes().to_vec());
    text
}

/// The distinct colours, and the number of each face's corners' colours.
fn palette(model: &Model) -> (Vec<[u8; 4]>, Vec<[Option<u32>; 3]>) {
    let Some(colors) = &model.colors else { return (vec![], vec![]) };
    let (mut list, mut ids) = (vec![], BTreeMap::new());
    let mut number = |color: [f64; 4]| {
        (!color[0].is_nan()).then(|| {
            *ids.entry(bytes_of(color)).or_insert_with_key(|&bytes| {
                list.push(bytes);
                list.len() as u32 - 1
            })
        })
    };
    let of_corner = colors.as_slice().chunks_exact(3).map(|c| [number(c[0]), number(c[1]), number(c[2])]).collect();
    (list, of_corner)
}

fn bytes_of(color: [f64; 4]) -> [u8; 4] {
    color.map(|x| (255.0 * x).round().clamp(0.0, 255.0) as u8)
}

fn hex([r, g, b, a]: [u8; 4]) -> String {
    format!("#{r:02X}{g:02X}{b:02X}{a:02X}")
}

fn escaped(name: &str) -> String {
    let mut out = String::new();
    for c in clean_name(name).chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // No XML 1.0 document may hold these.
            '\u{fffe}' | '\u{ffff}' => out.push('_'),
            _ => out.push(c),
        }
    }
    out
}
