//! Reads a glTF scene: every mesh that its nodes place, as one mesh in world coordinates.

use super::accessor::{Values, values};
use super::buffers::{Buffers, chunks};
use super::json::Node;
use super::look;
use crate::error::Fault;
use crate::folder::Folder;
use crate::model::{Groups, Material, Materials, Model};
use crate::notes::Notes;
use crate::text::normalized;
use crate::weld::{apply, same_places};
use glam::{DMat3, DMat4, DQuat, DVec3};
use mesh_core::VertexId;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Instances may multiply a small file; the scene may have this many vertices and triangles, or as many as the file
/// has bytes.
const MAX_ELEMENTS: usize = 1 << 25;

/// Reads either kind of glTF file. Node transforms apply in f64. Vertices that a placed mesh splits for its seams are
/// welded exactly; meshes of different nodes stay apart. O(size of the scene).
pub(crate) fn read(bytes: &[u8], folder: &Folder, notes: &mut Notes) -> Result<Model, Fault> {
    let (json, binary) = if bytes.starts_with(b"glTF") { chunks(bytes)? } else { (bytes, None) };
    let text = normalized(json);
    let value = serde_json::from_slice(&text).map_err(|error| {
        let line_start =
            text.split_inclusive(|&b| b == b'\n').take(error.line().saturating_sub(1)).map(<[u8]>::len).sum();
        let reason = format!("not valid JSON: {error}");
        if binary.is_some() { Fault::whole(reason) } else { Fault::text(line_start, reason) }
    })?;
    let document = Node::root(&value);
    check_version(&document, notes)?;
    let mut scene = Scene {
        buffers: Buffers::new(&document, binary, folder)?,
        document: &document,
        folder,
        limit: MAX_ELEMENTS.max(bytes.len()),
        parts: Parts::default(),
        material_ids: BTreeMap::new(),
        group_ids: BTreeMap::new(),
        decoded: BTreeMap::new(),
    };
    scene.place_nodes(notes)?;
    Ok(scene.parts.into_model(notes))
}

fn check_version(document: &Node, notes: &mut Notes) -> Result<(), Fault> {
    let version = document.get("asset").get("version").text();
    if !version.is_some_and(|v| v.starts_with("2.")) {
        return Err(Fault::whole(format!("glTF version {version:?}; only version 2 is supported")));
    }
    for extension in document.get("extensionsRequired").items()? {
        match extension.text() {
            Some(name @ ("KHR_draco_mesh_compression" | "EXT_meshopt_compression")) => {
                return Err(extension.fault(&format!("{name} is not supported; decompress the file first")));
            }
            Some("KHR_mesh_quantization") => {}
            name => notes.add(&format!("required extensions passed over ({})", name.unwrap_or("?")), 1, None),
        }
    }
    for (key, what) in [("animations", "animations not kept"), ("skins", "skins not kept")] {
        notes.add(what, document.get(key).items()?.len(), None);
    }
    Ok(())
}

struct Scene<'a> {
    document: &'a Node<'a>,
    buffers: Buffers<'a>,
    folder: &'a Folder,
    limit: usize,
    parts: Parts,
    /// Number in the model of each of the document's materials; the document's −1 stands for none.
    material_ids: BTreeMap<Option<usize>, u32>,
    group_ids: BTreeMap<String, u32>,
    decoded: BTreeMap<usize, Rc<Values>>,
}

/// The model as it grows.
#[derive(Default)]
struct Parts {
    model: Model,
    uvs: Vec<[f64; 2]>,
    normals: Vec<DVec3>,
    colors: Vec<[f64; 4]>,
    group_of: Vec<u32>,
    group_names: Vec<String>,
    material_of: Vec<u32>,
    materials: Vec<Material>,
    /// For each vertex the first at its place in the same placed mesh.
    first: Vec<u32>,
}

impl Scene<'_> {
    /// Walks the scene's node trees with an explicit stack. A node met twice is a cycle or has two parents; both are
    /// against the rules, and refusing them bounds the walk.
    fn place_nodes(&mut self, notes: &mut Notes) -> Result<(), Fault> {
        let nodes = self.document.get("nodes");
        let count = nodes.items()?.len();
        let mut stack: Vec<(usize, DMat4)> = vec![];
        for root in self.roots(count)?.into_iter().rev() {
            stack.push((root, DMat4::IDENTITY));
        }
        let mut met = vec![false; count];
        while let Some((index, above)) = stack.pop() {
            let node = nodes.item(index)?;
            if std::mem::replace(&mut met[index], true) {
                return Err(node.fault("the node is reached twice; node trees must not join or loop"));
            }
            let here = above * local_transform(&node)?;
            if let Some(mesh) = node.get("mesh").index()? {
                let mesh = self.document.get("meshes").item(mesh)?;
                let name = node.get("name").text().or(mesh.get("name").text()).unwrap_or_default().to_owned();
                self.place_mesh(&mesh, &name, here, notes)?;
            }
            for child in node.get("children").items()?.iter().rev() {
                let child = child.expect_index()?;
                if child >= count {
                    return Err(node.fault(&format!("node {child} does not exist")));
                }
                stack.push((child, here));
            }
        }
        Ok(())
    }

    /// The root nodes of the scene shown; without scenes, all nodes that are nobody's child.
    fn roots(&self, count: usize) -> Result<Vec<usize>, Fault> {
        let scenes = self.document.get("scenes");
        let shown = self.document.get("scene").index()?.unwrap_or(0);
        if scenes.items()?.is_empty() {
            let mut is_child = vec![false; count];
            for node in self.document.get("nodes").items()? {
                for child in node.get("children").items()? {
                    if let Some(flag) = child.index()?.and_then(|c| is_child.get_mut(c)) {
                        *flag = true;
                    }
                }
            }
            return Ok((0..count).filter(|&n| !is_child[n]).collect());
        }
        let roots = scenes.item(shown)?.get("nodes").items()?;
        roots.iter().map(Node::expect_index).collect()
    }

    fn place_mesh(&mut self, mesh: &Node, name: &str, transform: DMat4, notes: &mut Notes) -> Result<(), Fault> {
        let start = self.parts.model.mesh.positions.len();
        self.decoded.clear();
        let mut bases: BTreeMap<usize, u32> = BTreeMap::new();
        for primitive in mesh.get("primitives").items()? {
            notes.add("morph targets not kept", primitive.get("targets").items()?.len(), None);
            let mode = primitive.get("mode").index()?.unwrap_or(4);
            if mode < 4 {
                notes.add("primitives of points or lines not kept", 1, None);
                continue;
            }
            let attributes = primitive.get("attributes");
            let Some(accessor) = attributes.get("POSITION").index()? else {
                notes.add("primitives without positions passed over", 1, None);
                continue;
            };
            let base = if let Some(&base) = bases.get(&accessor) {
                base
            } else {
                let base = self.add_vertices(accessor, transform)?;
                bases.insert(accessor, base);
                base
            };
            self.add_faces(&primitive, mode, accessor, base, name, transform)?;
        }
        let first = same_places(&self.parts.model.mesh.positions[start..]);
        self.parts.first.extend(first.into_iter().map(|f| f + start as u32));
        Ok(())
    }

    /// An accessor's values. Primitives of one mesh often share them, so they are kept until the next mesh.
    fn values(&mut self, accessor: usize) -> Result<Rc<Values>, Fault> {
        if let Some(values) = self.decoded.get(&accessor) {
            return Ok(values.clone());
        }
        let node = self.document.get("accessors").item(accessor)?;
        let values = Rc::new(values(&node, &mut self.buffers, self.limit)?);
        self.decoded.insert(accessor, values.clone());
        Ok(values)
    }

    fn add_vertices(&mut self, accessor: usize, transform: DMat4) -> Result<u32, Fault> {
        let node = self.document.get("accessors").item(accessor)?;
        let values = self.values(accessor)?;
        if values.width != 3 {
            return Err(node.fault("positions must be of type VEC3"));
        }
        let positions = &mut self.parts.model.mesh.positions;
        let base = positions.len();
        if base + values.len() > self.limit {
            return Err(node.fault(&format!("the scene's instances have more than {} vertices", self.limit)));
        }
        for i in 0..values.len() {
            let p = transform.transform_point3(DVec3::from_slice(values.row(i)));
            if !p.is_finite() {
                return Err(node.fault(&format!("position {i} is not finite")));
            }
            positions.push(p);
        }
        Ok(base as u32)
    }

    fn add_faces(
        &mut self,
        primitive: &Node,
        mode: usize,
        positions: usize,
        base: u32,
        name: &str,
        transform: DMat4,
    ) -> Result<(), Fault> {
        let count = self.document.get("accessors").item(positions)?.get("count").expect_index()?;
        let indices = match primitive.get("indices").index()? {
            None => (0..count as u32).collect(),
            Some(accessor) => {
                let node = self.document.get("accessors").item(accessor)?;
                let check = |(i, &x): (usize, &f64)| {
                    let index = x as u32;
                    let fault = || node.fault(&format!("index {i} is {x}, beyond {count} vertices"));
                    if f64::from(index) == x && (index as usize) < count { Ok(index) } else { Err(fault()) }
                };
                self.values(accessor)?.numbers.iter().enumerate().map(check).collect::<Result<Vec<u32>, _>>()?
            }
        };
        let mut triangles = triangles(&indices, mode).ok_or_else(|| primitive.fault("the mode must be from 0 to 6"))?;
        if transform.determinant() < 0.0 {
            for t in &mut triangles {
                t.swap(1, 2);
            }
        }
        let material = primitive.get("material").index()?;
        let material_node = material.map(|m| self.document.get("materials").item(m)).transpose()?;
        let uv_set = material_node.as_ref().map_or(Ok(0), look::uv_set)?;
        let mut attribute = |name: &str, widths: &[usize]| {
            let node = primitive.get("attributes").get(name);
            let Some(accessor) = node.index()? else { return Ok(None) };
            let values = self.values(accessor)?;
            let fits = widths.contains(&values.width) && values.len() >= count;
            if fits { Ok(Some(values)) } else { Err(node.fault("not of the type, or shorter than the positions")) }
        };
        let uvs = attribute(&format!("TEXCOORD_{uv_set}"), &[2])?;
        let normals = attribute("NORMAL", &[3])?;
        let colors = attribute("COLOR_0", &[3, 4])?;
        let material = self.material(material, material_node.as_ref())?;
        let group = primitive.get("extras").get("group").text().unwrap_or(name);
        let group = self.group(group);

        let parts = &mut self.parts;
        let before = 3 * parts.model.mesh.faces.len();
        if parts.model.mesh.faces.len() + triangles.len() > self.limit {
            return Err(primitive.fault(&format!("the scene's instances have more than {} triangles", self.limit)));
        }
        parts.model.mesh.faces.extend(triangles.iter().map(|t| t.map(|i| VertexId(base + i))));
        let corners = || triangles.iter().flatten().map(|&i| i as usize);
        if let Some(uvs) = uvs {
            parts.uvs.resize(before, [f64::NAN; 2]);
            // glTF counts v from the top.
            let value =
                |row: &[f64]| if row.iter().all(|x| x.is_finite()) { [row[0], 1.0 - row[1]] } else { [f64::NAN; 2] };
            parts.uvs.extend(corners().map(|i| value(uvs.row(i))));
        }
        if let Some(normals) = normals {
            parts.normals.resize(before, DVec3::NAN);
            let turn = normal_transform(transform);
            let value = |row: &[f64]| {
                let n = DVec3::from_slice(row);
                let n = if transform == DMat4::IDENTITY { n } else { (turn * n).normalize_or(DVec3::NAN) };
                if n.is_finite() { n } else { DVec3::NAN }
            };
            parts.normals.extend(corners().map(|i| value(normals.row(i))));
        }
        if let Some(colors) = colors {
            parts.colors.resize(before, [f64::NAN; 4]);
            let value = |row: &[f64]| match [row[0], row[1], row[2], row.get(3).copied().unwrap_or(1.0)] {
                color if color.iter().all(|x| x.is_finite()) => color,
                _ => [f64::NAN; 4],
            };
            parts.colors.extend(corners().map(|i| value(colors.row(i))));
        }
        parts.group_of.resize(parts.model.mesh.faces.len(), group);
        parts.material_of.resize(parts.model.mesh.faces.len(), material);
        Ok(())
    }

    fn material(&mut self, index: Option<usize>, node: Option<&Node>) -> Result<u32, Fault> {
        if let Some(&id) = self.material_ids.get(&index) {
            return Ok(id);
        }
        let material = match node {
            None => Material::default(),
            Some(node) => look::material(node, self.document, &mut self.buffers, self.folder)?,
        };
        let id = self.parts.materials.len() as u32;
        self.parts.materials.push(material);
        self.material_ids.insert(index, id);
        Ok(id)
    }

    fn group(&mut self, name: &str) -> u32 {
        if let Some(&id) = self.group_ids.get(name) {
            return id;
        }
        let id = self.parts.group_names.len() as u32;
        self.parts.group_names.push(name.to_owned());
        self.group_ids.insert(name.to_owned(), id);
        id
    }
}

impl Parts {
    fn into_model(mut self, notes: &mut Notes) -> Model {
        let mut model = self.model;
        let corners = 3 * model.mesh.faces.len();
        self.uvs.resize(if self.uvs.is_empty() { 0 } else { corners }, [f64::NAN; 2]);
        self.normals.resize(if self.normals.is_empty() { 0 } else { corners }, DVec3::NAN);
        self.colors.resize(if self.colors.is_empty() { 0 } else { corners }, [f64::NAN; 4]);
        model.uvs = (!self.uvs.is_empty()).then(|| self.uvs.into());
        model.normals = (!self.normals.is_empty()).then(|| self.normals.into());
        model.colors = (!self.colors.is_empty()).then(|| self.colors.into());
        if self.group_names.iter().any(|name| !name.is_empty()) {
            model.groups = Some(Groups { of_face: self.group_of.into(), names: self.group_names });
        }
        if self.materials.iter().any(|m| *m != Material::default()) {
            model.materials = Some(Materials { of_face: self.material_of.into(), list: self.materials });
        }
        let dropped = apply(&mut model, &self.first).dropped + model.drop_degenerate_faces();
        notes.add("degenerate faces dropped", dropped, None);
        model
    }
}

/// Triangles of a list (4), strip (5) or fan (6). Repeated indices in a strip are how exporters join strips.
fn triangles(indices: &[u32], mode: usize) -> Option<Vec<[u32; 3]>> {
    Some(match mode {
        4 => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        5 => {
            let turned = |(i, t): (usize, &[u32])| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
            indices.windows(3).enumerate().map(turned).collect()
        }
        6 => indices.get(1..).unwrap_or_default().windows(2).map(|t| [indices[0], t[0], t[1]]).collect(),
        _ => return None,
    })
}

fn local_transform(node: &Node) -> Result<DMat4, Fault> {
    if let Some(matrix) = node.get("matrix").numbers::<16>()? {
        return Ok(DMat4::from_cols_array(&matrix));
    }
    let translation = node.get("translation").numbers::<3>()?.unwrap_or_default();
    let rotation = node.get("rotation").numbers::<4>()?.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = node.get("scale").numbers::<3>()?.unwrap_or([1.0; 3]);
    let rotation = DQuat::from_array(rotation);
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    Ok(DMat4::from_scale_rotation_translation(scale.into(), rotation, translation.into()))
}

/// What turns normals as `transform` turns surfaces: the cofactor matrix, with its sign mended where it mirrors.
fn normal_transform(transform: DMat4) -> DMat3 {
    let m = DMat3::from_mat4(transform);
    let side = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    side * DMat3::from_cols(m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis))
}
