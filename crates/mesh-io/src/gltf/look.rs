//! Materials and pictures of a glTF document.

use super::buffers::{Buffers, file_name, load};
use super::json::Node;
use crate::error::Fault;
use crate::folder::Folder;
use crate::model::{Material, Texture, TextureSource};

/// A material and the texture coordinate set that its picture uses. What is broken about a picture costs the
/// picture.
pub(super) fn material(
    node: &Node,
    document: &Node,
    buffers: &mut Buffers,
    folder: &Folder,
) -> Result<Material, Fault> {
    let pbr = node.get("pbrMetallicRoughness");
    let factor = |name: &str| pbr.get(name).value.as_f64().map_or(1.0, |x| x.clamp(0.0, 1.0));
    let texture = pbr.get("baseColorTexture").get("index").index()?.and_then(|index| {
        let texture = document.get("textures").item(index).ok()?;
        let image = texture.get("source").index().ok()??;
        picture(&document.get("images").item(image).ok()?, image, buffers, folder)
    });
    Ok(Material {
        name: node.get("name").text().unwrap_or_default().to_owned(),
        base_color: pbr.get("baseColorFactor").numbers()?.unwrap_or([1.0; 4]),
        metallic: factor("metallicFactor"),
        roughness: factor("roughnessFactor"),
        texture,
    })
}

/// The set of texture coordinates that a material's base colour uses.
pub(super) fn uv_set(material: &Node) -> Result<usize, Fault> {
    let set = material.get("pbrMetallicRoughness").get("baseColorTexture").get("texCoord").index()?;
    Ok(set.unwrap_or(0))
}

fn picture(image: &Node, index: usize, buffers: &mut Buffers, folder: &Folder) -> Option<Texture> {
    let embedded = |bytes: Vec<u8>| {
        let extension = if is_jpeg(&bytes) { "jpg" } else { "png" };
        let name = image.get("name").text().filter(|n| !n.is_empty()).unwrap_or("picture");
        let stem = name.strip_suffix(".png").or(name.strip_suffix(".jpg")).unwrap_or(name);
        let name = format!("{stem}{index}.{extension}");
        Texture { name, source: TextureSource::Embedded(bytes.into()) }
    };
    if let Some(uri) = image.get("uri").text() {
        if uri.starts_with("data:") {
            return load(uri, folder).ok().map(embedded);
        }
        let name = file_name(uri);
        let source = folder.texture(&name);
        return Some(Texture { name, source });
    }
    let view = image.get("bufferView").index().ok()??;
    buffers.view(view).ok().map(|(bytes, _)| embedded(bytes.to_vec()))
}

pub(super) fn is_jpeg(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xff\xd8")
}

pub(super) fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG")
}
