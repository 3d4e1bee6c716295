//! Reads 3MF: the items to build, with their components, as one mesh.

use super::document::{Document, Object, PropertyGroup, Reference, parse};
use super::package::Package;
use crate::error::Fault;
use crate::model::{Groups, Material, Materials, Model};
use crate::notes::Notes;
use crate::unit::Unit;
use glam::DMat4;
use mesh_core::VertexId;
use std::collections::BTreeMap;

/// Components may multiply a small file: bounds for vertices and triangles, for visits, and for nesting.
const MAX_ELEMENTS: usize = 1 << 25;
const MAX_VISITS: usize = 1 << 20;
const MAX_DEPTH: usize = 64;

/// Reads a 3MF package. Coordinates stay in the file's unit, which the model names.
/// O(size of what is built).
pub(crate) fn read(bytes: &[u8], notes: &mut Notes) -> Result<Model, Fault> {
    let mut package = Package::open(bytes)?;
    let root = package.root_model()?;
    let mut builder = Builder { package, documents: BTreeMap::new(), parts: Parts::default() };
    let root = builder.load(&root, notes)?;
    let name = builder.documents[&root].unit.clone();
    let unit = name.as_deref().map_or(Some(Unit::Millimeter), Unit::from_name);
    if let (None, Some(name)) = (unit, name) {
        notes.add(&format!("unknown unit ({}) taken for the millimetre", crate::encode::clean_name(&name)), 1, None);
    }
    let items = builder.documents[&root].build.clone();
    builder.build(&root, &items, notes)?;
    Ok(Model { unit, ..builder.parts.into_model(notes) })
}

struct Builder<'a> {
    package: Package<'a>,
    /// Parts by name; large packages keep objects in parts of their own.
    documents: BTreeMap<String, Document>,
    parts: Parts,
}

#[derive(Default)]
struct Parts {
    model: Model,
    group_ids: BTreeMap<String, u32>,
    group_of: Vec<u32>,
    group_names: Vec<String>,
    /// Numbers of materials by part, group and entry; `None` for no material.
    material_ids: BTreeMap<Option<(String, u32, u32)>, u32>,
    material_of: Vec<u32>,
    materials: Vec<Material>,
    colors: Vec<[f64; 4]>,
}

impl Builder<'_> {
    fn load(&mut self, part: &str, notes: &mut Notes) -> Result<String, Fault> {
        let name = part.trim_start_matches('/').to_owned();
        if !self.documents.contains_key(&name) {
            let text = self.package.text(&name)?;
            let document = parse(&text, &name, notes)?;
            self.documents.insert(name.clone(), document);
        }
        Ok(name)
    }

    /// Walks items and their components depth first, in order, with an explicit stack.
    fn build(&mut self, root: &str, items: &[Reference], notes: &mut Notes) -> Result<(), Fault> {
        let mut stack: Vec<(String, Reference, usize)> =
            items.iter().rev().map(|item| (root.to_owned(), item.clone(), 0)).collect();
        let mut visits = 0;
        while let Some((part, reference, depth)) = stack.pop() {
            visits += 1;
            if depth > MAX_DEPTH || visits > MAX_VISITS {
                return Err(Fault::whole("the components refer to each other in a loop, or nest too deep"));
            }
            let part = match &reference.part {
                Some(path) => self.load(path, notes)?,
                None => part,
            };
            let document = &self.documents[&part];
            let id = reference.object;
            let object = document
                .objects
                .get(&id)
                .ok_or_else(|| Fault::whole(format!("{part}: object {id} is built but not there")))?;
            for component in object.components.iter().rev() {
                let transform = reference.transform * component.transform;
                stack.push((part.clone(), Reference { transform, ..component.clone() }, depth + 1));
            }
            self.parts.place(&part, document, object, reference.transform)?;
        }
        Ok(())
    }
}

impl Parts {
    fn place(&mut self, part: &str, document: &Document, object: &Object, transform: DMat4) -> Result<(), Fault> {
        let mesh = &mut self.model.mesh;
        let base = mesh.positions.len();
        if base + object.vertices.len() > MAX_ELEMENTS || mesh.faces.len() + object.triangles.len() > MAX_ELEMENTS {
            return Err(Fault::whole(format!("the build has more than {MAX_ELEMENTS} vertices or triangles")));
        }
        if transform == DMat4::IDENTITY {
            mesh.positions.extend(&object.vertices);
        } else {
            mesh.positions.extend(object.vertices.iter().map(|&p| transform.transform_point3(p)));
        }
        if mesh.positions[base..].iter().any(|p| !p.is_finite()) {
            return Err(Fault::whole(format!("{part}: a transform makes coordinates infinite")));
        }
        let mirrored = transform.determinant() < 0.0;
        if object.triangles.is_empty() {
            return Ok(());
        }
        let group = self.group(&object.name);
        for (triangle, property) in object.triangles.iter().zip(&object.properties) {
            let order = if mirrored { [0, 2, 1] } else { [0, 1, 2] };
            let corners = order.map(|k| VertexId(base as u32 + triangle[k]));
            self.model.mesh.faces.push(corners);
            self.group_of.push(group);
            let found = property.and_then(|(id, entries)| Some((id, entries, document.groups.get(&id)?)));
            let mut colors = [[f64::NAN; 4]; 3];
            let (mut key, mut look) = (None, None);
            match found {
                Some((id, entries, PropertyGroup::Materials(list))) if (entries[0] as usize) < list.len() => {
                    key = Some((part.to_owned(), id, entries[0]));
                    look = list.get(entries[0] as usize);
                }
                Some((_, entries, PropertyGroup::Colors(list))) => {
                    colors = order.map(|k| list.get(entries[k] as usize).copied().unwrap_or([f64::NAN; 4]));
                }
                _ => {}
            }
            self.colors.extend(colors);
            let material = self.material(key, look);
            self.material_of.push(material);
        }
        Ok(())
    }

    fn group(&mut self, name: &str) -> u32 {
        let next = self.group_names.len() as u32;
        let id = *self.group_ids.entry(name.to_owned()).or_insert(next);
        if id == next {
            self.group_names.push(name.to_owned());
        }
        id
    }

    /// The number of a material, given its part, group and entry; `look` describes it when first met.
    fn material(&mut self, key: Option<(String, u32, u32)>, look: Option<&(String, [f64; 4])>) -> u32 {
        let next = self.materials.len() as u32;
        let id = *self.material_ids.entry(key).or_insert(next);
        if id == next {
            let plain = Material::default();
            let named = |(name, color): &(String, [f64; 4])| Material {
                name: name.clone(),
                base_color: *color,
                ..Material::default()
            };
            self.materials.push(look.map_or(plain, named));
        }
        id
    }

    fn into_model(self, notes: &mut Notes) -> Model {
        let mut model = self.model;
        if self.group_names.iter().any(|name| !name.is_empty()) {
            model.groups = Some(Groups { of_face: self.group_of.into(), names: self.group_names });
        }
        if self.material_ids.keys().any(Option::is_some) {
            model.materials = Some(Materials { of_face: self.material_of.into(), list: self.materials });
        }
        if self.colors.iter().any(|c| !c[0].is_nan()) {
            model.colors = Some(self.colors.into());
        }
        notes.add("degenerate faces dropped", model.drop_degenerate_faces(), None);
        model
    }
}
