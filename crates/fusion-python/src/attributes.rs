//! What a mesh carries beside vertices and faces: texture coordinates, normals, colours, groups, materials, polygons.

use crate::columns::{attribute, column, cube};
use crate::failure::bad_input;
use fusion::mesh_core::VertexId;
use fusion::mesh_io::{Groups, Material, Materials, Model, Polygons, Texture, TextureSource};
use glam::DVec3;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::PathBuf;

/// Adds the attributes of a Python mesh.
pub fn add(model: &mut Model, mesh: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let faces = model.mesh.faces.len();
    let corners = |key, count| attribute::<f64>(mesh, name, key, &[faces, 3, count]);
    model.uvs = corners("uvs", 2)?.map(|values| values.as_chunks::<2>().0.to_vec().into());
    model.normals =
        corners("normals", 3)?.map(|v| v.as_chunks::<3>().0.iter().map(|&n| DVec3::from(n)).collect::<Vec<_>>().into());
    model.colors = corners("colors", 4)?.map(|values| values.as_chunks::<4>().0.to_vec().into());
    if let Some(of_face) = attribute::<u32>(mesh, name, "face_groups", &[faces])? {
        let names: Vec<String> = mesh.getattr("group_names")?.extract()?;
        in_range(mesh, name, "face_groups", &of_face, names.len())?;
        model.groups = Some(Groups { of_face: of_face.into(), names });
    }
    if let Some(of_face) = attribute::<u32>(mesh, name, "face_materials", &[faces])? {
        let list = mesh.getattr("materials")?.try_iter()?.map(|m| material_from(&m?)).collect::<PyResult<Vec<_>>>()?;
        in_range(mesh, name, "face_materials", &of_face, list.len())?;
        model.materials = Some(Materials { of_face: of_face.into(), list });
    }
    let polygons = mesh.getattr("polygons")?;
    if !polygons.is_none() {
        let [starts, corners, of_face] = polygons.extract::<[Vec<u32>; 3]>()?;
        let corners = corners.into_iter().map(VertexId).collect();
        let polygons = Polygons { starts, corners, of_face: of_face.into() };
        // Faces may have been edited since: the triangles stand for themselves then.
        model.polygons = Some(polygons).filter(|polygons| polygons.fit(&model.mesh));
    }
    Ok(())
}

fn in_range(mesh: &Bound<'_, PyAny>, name: &str, key: &str, ids: &[u32], count: usize) -> PyResult<()> {
    match ids.iter().position(|&id| id as usize >= count) {
        None => Ok(()),
        Some(face) => {
            let message = format!("{name}: {key}[{face}] = {} is out of range; there are {count}", ids[face]);
            Err(bad_input(mesh.py(), message))
        }
    }
}

/// Moves the attributes of a model into the arguments of a Python mesh.
pub fn tell(dict: &Bound<'_, PyDict>, model: &mut Model) -> PyResult<()> {
    let py = dict.py();
    if let Some(uvs) = model.uvs.take() {
        dict.set_item("uvs", cube(py, uvs.as_slice().to_vec())?)?;
    }
    if let Some(normals) = model.normals.take() {
        dict.set_item("normals", cube(py, normals.as_slice().iter().map(glam::DVec3::to_array).collect())?)?;
    }
    if let Some(colors) = model.colors.take() {
        dict.set_item("colors", cube(py, colors.as_slice().to_vec())?)?;
    }
    if let Some(groups) = model.groups.take() {
        dict.set_item("face_groups", column(py, groups.of_face.as_slice().to_vec()))?;
        dict.set_item("group_names", groups.names)?;
    }
    if let Some(materials) = model.materials.take() {
        dict.set_item("face_materials", column(py, materials.of_face.as_slice().to_vec()))?;
        let list = materials.list.iter().map(|m| material_to_python(py, m)).collect::<PyResult<Vec<_>>>()?;
        dict.set_item("materials", list)?;
    }
    if let Some(polygons) = model.polygons.take() {
        let corners = polygons.corners.iter().map(|v| v.0).collect();
        let arrays = [polygons.starts, corners, polygons.of_face.as_slice().to_vec()].map(|values| column(py, values));
        dict.set_item("polygons", arrays)?;
    }
    Ok(())
}

fn material_from(table: &Bound<'_, PyAny>) -> PyResult<Material> {
    let texture = table.get_item("texture")?;
    let texture = if texture.is_none() { None } else { Some(texture_from(&texture)?) };
    Ok(Material {
        name: table.get_item("name")?.extract()?,
        base_color: table.get_item("base_color")?.extract()?,
        metallic: table.get_item("metallic")?.extract()?,
        roughness: table.get_item("roughness")?.extract()?,
        texture,
    })
}

fn texture_from(table: &Bound<'_, PyAny>) -> PyResult<Texture> {
    let [file, bytes] = ["file", "bytes"].map(|key| table.get_item(key));
    let (file, bytes) = (file?, bytes?);
    let source = if !file.is_none() {
        TextureSource::File(file.extract::<PathBuf>()?)
    } else if bytes.is_none() {
        TextureSource::Missing
    } else {
        TextureSource::Embedded(bytes.extract::<Vec<u8>>()?.into())
    };
    Ok(Texture { name: table.get_item("name")?.extract()?, source })
}

fn material_to_python<'py>(py: Python<'py>, material: &Material) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", &material.name)?;
    dict.set_item("base_color", material.base_color)?;
    dict.set_item("metallic", material.metallic)?;
    dict.set_item("roughness", material.roughness)?;
    let texture = material.texture.as_ref().map(|texture| {
        let dict = PyDict::new(py);
        let (file, bytes) = match &texture.source {
            TextureSource::File(path) => (Some(path.as_os_str()), None),
            TextureSource::Embedded(bytes) => (None, Some(PyBytes::new(py, bytes))),
            TextureSource::Missing => (None, None),
        };
        dict.set_item("name", &texture.name)?;
        dict.set_item("file", file)?;
        dict.set_item("bytes", bytes)?;
        PyResult::Ok(dict)
    });
    dict.set_item("texture", texture.transpose()?)?;
    Ok(dict)
}
