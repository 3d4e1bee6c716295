//! Binary frames: arrays behind a header that names them.

use axum::body::Bytes;
use fusion::document::Shown;
use fusion::mesh_core::{FaceOrigin, bounds};
use glam::DVec3;
use serde_json::{Value, json};

/// Arrays start at a multiple of this.
const ALIGNMENT: usize = 8;

/// An array of a frame.
pub struct Array<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its numbers.
    pub numbers: Numbers,
}

/// Numbers of 32 bits.
pub enum Numbers {
    /// `f32`
    F32(Vec<f32>),
    /// `u32`
    U32(Vec<u32>),
}

impl Numbers {
    fn kind(&self) -> &'static str {
        match self {
            Self::F32(_) => "f32",
            Self::U32(_) => "u32",
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::F32(all) => all.len(),
            Self::U32(all) => all.len(),
        }
    }

    fn put(&self, out: &mut Vec<u8>) {
        match self {
            Self::F32(all) => all.iter().for_each(|x| out.extend_from_slice(&x.to_le_bytes())),
            Self::U32(all) => all.iter().for_each(|x| out.extend_from_slice(&x.to_le_bytes())),
        }
    }
}

/// Arrays as bytes, behind a header with these keys.
pub fn encode(mut header: Value, arrays: &[Array<'_>]) -> Bytes {
    let list = arrays.iter().map(|a| json!({ "name": a.name, "type": a.numbers.kind(), "length": a.numbers.len() }));
    header["arrays"] = list.collect();
    let mut text = header.to_string().into_bytes();
    text.resize((4 + text.len()).next_multiple_of(ALIGNMENT) - 4, b' ');
    let size: usize = arrays.iter().map(|a| 4 * a.numbers.len()).sum();
    let mut out = Vec::with_capacity(4 + text.len() + size);
    out.extend_from_slice(&(text.len() as u32).to_le_bytes());
    out.extend_from_slice(&text);
    for array in arrays {
        array.numbers.put(&mut out);
    }
    out.into()
}

/// A shape's revision: equal for equal shapes.
pub fn revision(shown: &Shown) -> String {
    shown.key[..8].iter().fold(String::new(), |text, byte| format!("{text}{byte:02x}"))
}

/// What the drawing of a shape is relative to: the centre of its box, rounded so that it is exact in 32 bits.
pub fn drawing_origin(shown: &Shown) -> DVec3 {
    let bounds = bounds(&shown.model.mesh);
    if bounds.is_empty() {
        return DVec3::ZERO;
    }
    let centre = 0.5 * (bounds.min + bounds.max);
    if centre.is_finite() { centre.as_vec3().as_dvec3() } else { DVec3::ZERO }
}

/// A point relative to that.
pub fn drawn(point: DVec3, origin: DVec3) -> [f32; 3] {
    (point - origin).as_vec3().to_array()
}

/// A shape as it is drawn, under the name that was asked for.
pub fn mesh(name: &str, shown: &Shown) -> Bytes {
    let (mesh, origin) = (&shown.model.mesh, drawing_origin(shown));
    let positions = mesh.positions.iter().flat_map(|&p| drawn(p, origin)).collect();
    let faces = mesh.faces.iter().flat_map(|corners| corners.map(|v| v.0)).collect();
    let part = |of: &FaceOrigin| match *of {
        FaceOrigin::Input { part, .. } | FaceOrigin::Piece { part, .. } => part.saturating_add(1),
        FaceOrigin::New { .. } => 0,
    };
    let origins = shown.origins.faces.as_slice().iter().map(part).collect();
    let header = json!({ "frame": "mesh", "shape": name, "revision": revision(shown), "origin": origin.to_array() });
    let array = |name, numbers| Array { name, numbers };
    encode(
        header,
        &[
            array("positions", Numbers::F32(positions)),
            array("faces", Numbers::U32(faces)),
            array("face_origin", Numbers::U32(origins)),
        ],
    )
}

/// A number for every vertex.
pub fn values(request: u64, what: &str, name: &str, shown: &Shown, values: Vec<f32>) -> Bytes {
    let header = json!({ "frame": "values", "re": request, "shape": name, "revision": revision(shown), "what": what });
    encode(header, &[Array { name: "values", numbers: Numbers::F32(values) }])
}
