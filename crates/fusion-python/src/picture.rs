//! Still pictures.

use crate::failure::Fault;
use fusion::mesh_core::{TriMesh, Watch};
use fusion::render::{self, Color, Params, Projection, Wireframe};
use pyo3::prelude::*;

/// How a picture is taken, as Python asks for it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct View {
    color: String,
    /// The part of each face for the colour `origin`, -1 for new ones.
    parts: Option<Vec<i64>>,
    /// Towards the eye.
    #[pyo3(item("view"))]
    from: Option<[f64; 3]>,
    up: Option<[f64; 3]>,
    parallel: bool,
    wireframe: bool,
    size: [u32; 2],
}

/// The bytes of a PNG file.
pub fn png(mesh: &TriMesh, view: View, watch: &Watch) -> Result<Vec<u8>, Fault> {
    let color = match (view.color.as_str(), view.parts) {
        ("curvature", _) => Color::Curvature,
        ("quality", _) => Color::Quality,
        ("zebra", _) => Color::Zebra,
        ("origin", Some(parts)) => {
            Color::Origin(parts.into_iter().map(|part| fusion::palette_index(u32::try_from(part).ok())).collect())
        }
        ("plain", _) => Color::Plain,
        (other, _) => return Err(Fault::BadOption(format!("color: {other:?} is not a colour"))),
    };
    let defaults = Params::default();
    let params = Params {
        width: view.size[0],
        height: view.size[1],
        view: view.from.map_or(defaults.view, Into::into),
        up: view.up.map_or(defaults.up, Into::into),
        projection: if view.parallel { Projection::Orthographic } else { defaults.projection },
        color,
        wireframe: view.wireframe.then(Wireframe::default),
        ..defaults
    };
    let picture = render::picture(mesh, &params, watch).map_err(|e| match e {
        render::Error::Cancelled(_) => Fault::Cancelled,
        e => Fault::Impossible(e.to_string()),
    })?;
    picture.to_png().map_err(|e| Fault::Unwritable(e.to_string()))
}
