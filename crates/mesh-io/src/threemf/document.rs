//! One model part of a 3MF package, as its XML says it: objects, property groups and what to build.

use super::package::attribute;
use crate::error::Fault;
use crate::notes::Notes;
use crate::number::parse_f64;
use glam::{DMat4, DVec3};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// Ids as the file writes them.
pub(super) type ResourceId = u32;

#[derive(Default)]
pub(super) struct Document {
    pub unit: Option<String>,
    pub objects: BTreeMap<ResourceId, Object>,
    pub groups: BTreeMap<ResourceId, PropertyGroup>,
    pub build: Vec<Reference>,
}

#[derive(Default)]
pub(super) struct Object {
    pub name: String,
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle its property group and the entries at its corners.
    pub properties: Vec<Option<(ResourceId, [u32; 3])>>,
    pub default: Option<(ResourceId, u32)>,
    pub components: Vec<Reference>,
}

/// An object put somewhere.
#[derive(Clone)]
pub(super) struct Reference {
    pub part: Option<String>,
    pub object: ResourceId,
    pub transform: DMat4,
}

pub(super) enum PropertyGroup {
    /// Names and display colours.
    Materials(Vec<(String, [f64; 4])>),
    Colors(Vec<[f64; 4]>),
}

/// Reads one part. `part` is its name, for messages.
pub(super) fn parse(text: &str, part: &str, notes: &mut Notes) -> Result<Document, Fault> {
    let mut parser = Parser { document: Document::default(), object: None, group: None, notes };
    let mut reader = Reader::from_str(text);
    loop {
        let event = reader.read_event();
        let line = |reader: &Reader<&[u8]>| {
            let end = (reader.buffer_position() as usize).min(text.len());
            text.as_bytes()[..end].split(|&b| b == b'\n').count()
        };
        let result = match event {
            Err(error) => Err(error.to_string()),
            Ok(Event::Eof) => break,
            Ok(Event::Start(tag)) => parser.open(&tag),
            Ok(Event::Empty(tag)) => parser.open(&tag).map(|()| parser.close(tag.local_name().as_ref())),
            Ok(Event::End(tag)) => {
                parser.close(tag.local_name().as_ref());
                Ok(())
            }
            Ok(_) => Ok(()),
        };
        result.map_err(|reason| Fault::whole(format!("{part}: line {}: {reason}", line(&reader))))?;
    }
    Ok(parser.document)
}

struct Parser<'n> {
    document: Document,
    object: Option<(ResourceId, Object)>,
    group: Option<(ResourceId, PropertyGroup)>,
    notes: &'n mut Notes,
}

impl Parser<'_> {
    fn open(&mut self, tag: &BytesStart) -> Result<(), String> {
        match tag.local_name().as_ref() {
            "vertex" => {
                if let Some((_, object)) = &mut self.object {
                    object.vertices.push(vertex(tag)?);
                }
            }
            "triangle" => {
                if let Some((_, object)) = &mut self.object {
                    triangle(tag, object)?;
                }
            }
            "model" => self.document.unit = attribute(tag, "unit"),
            "object" => {
                let default =
                    integer(tag, "pid")?.map(|pid| Ok::<_, String>((pid, integer(tag, "pindex")?.unwrap_or(0))));
                let name = attribute(tag, "name").unwrap_or_default();
                let object = Object { name, default: default.transpose()?, ..Object::default() };
                self.object = Some((expect_integer(tag, "id")?, object));
            }
            "component" => {
                let reference = reference(tag)?;
                if let Some((_, object)) = &mut self.object {
                    object.components.push(reference);
                }
            }
            "item" => self.document.build.push(reference(tag)?),
            "basematerials" => self.group = Some((expect_integer(tag, "id")?, PropertyGroup::Materials(vec![]))),
            "colorgroup" => self.group = Some((expect_integer(tag, "id")?, PropertyGroup::Colors(vec![]))),
            "base" => {
                if let Some((_, PropertyGroup::Materials(list))) = &mut self.group {
                    let color = attribute(tag, "displaycolor").and_then(|c| color(&c)).unwrap_or([1.0; 4]);
                    list.push((attribute(tag, "name").unwrap_or_default(), color));
                }
            }
            "color" => {
                if let Some((_, PropertyGroup::Colors(list))) = &mut self.group {
                    list.push(attribute(tag, "color").and_then(|c| color(&c)).unwrap_or([1.0; 4]));
                }
            }
            "texture2d" => self.notes.add("textures not kept", 1, None),
            "beamlattice" => self.notes.add("beam lattices not kept", 1, None),
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, name: &str) {
        match name {
            "object" => self.document.objects.extend(self.object.take()),
            "basematerials" | "colorgroup" => self.document.groups.extend(self.group.take()),
            _ => {}
        }
    }
}

fn vertex(tag: &BytesStart) -> Result<DVec3, String> {
    let mut p = DVec3::NAN;
    for attribute in tag.attributes().with_checks(false).flatten() {
        let slot = match attribute.key.into_inner() {
            "x" => &mut p.x,
            "y" => &mut p.y,
            "z" => &mut p.z,
            _ => continue,
        };
        *slot = number(&attribute.value)?;
    }
    if p.is_finite() { Ok(p) } else { Err("a vertex without x, y or z".into()) }
}

fn triangle(tag: &BytesStart, object: &mut Object) -> Result<(), String> {
    let (mut corners, mut entries, mut group) = ([None; 3], [None; 3], None);
    for attribute in tag.attributes().with_checks(false).flatten() {
        let slot = match attribute.key.into_inner() {
            "v1" => &mut corners[0],
            "v2" => &mut corners[1],
            "v3" => &mut corners[2],
            "p1" => &mut entries[0],
            "p2" => &mut entries[1],
            "p3" => &mut entries[2],
            "pid" => &mut group,
            _ => continue,
        };
        let value = attribute.value.trim();
        *slot = Some(value.parse::<u32>().map_err(|_| format!("{value:?} is not an index"))?);
    }
    let [Some(a), Some(b), Some(c)] = corners else { return Err("a triangle without v1, v2 or v3".into()) };
    let count = object.vertices.len();
    if let Some(v) = [a, b, c].into_iter().find(|&v| v as usize >= count) {
        return Err(format!("a triangle names vertex {v} of {count} (counted from 0)"));
    }
    object.triangles.push([a, b, c]);
    let group = group.or(object.default.map(|(group, _)| group));
    let first = entries[0].or(object.default.map(|(_, entry)| entry));
    let property = group.zip(first).map(|(group, first)| (group, entries.map(|e| e.unwrap_or(first))));
    object.properties.push(property);
    Ok(())
}

fn reference(tag: &BytesStart) -> Result<Reference, String> {
    let transform = match attribute(tag, "transform") {
        None => DMat4::IDENTITY,
        Some(text) => {
            let numbers = text.split_whitespace().map(number).collect::<Result<Vec<f64>, _>>()?;
            let m = <[f64; 12]>::try_from(numbers).map_err(|_| "a transform needs 12 numbers".to_owned())?;
            // Rows of the file multiply from the left, so they are columns here.
            let column = |i: usize, w: f64| DVec3::from_slice(&m[3 * i..]).extend(w);
            DMat4::from_cols(column(0, 0.0), column(1, 0.0), column(2, 0.0), column(3, 1.0))
        }
    };
    Ok(Reference { part: attribute(tag, "path"), object: expect_integer(tag, "objectid")?, transform })
}

fn number(text: &str) -> Result<f64, String> {
    let value = parse_f64(text.trim().as_bytes()).ok_or_else(|| format!("{text:?} is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err(format!("{text:?} is not a finite number")) }
}

fn integer(tag: &BytesStart, name: &str) -> Result<Option<u32>, String> {
    let Some(text) = attribute(tag, name) else { return Ok(None) };
    text.trim().parse().map(Some).map_err(|_| format!("{name} {text:?} is not a whole number"))
}

fn expect_integer(tag: &BytesStart, name: &str) -> Result<u32, String> {
    integer(tag, name)?.ok_or_else(|| format!("{name} is missing"))
}

/// `#RRGGBB` or `#RRGGBBAA`.
fn color(text: &str) -> Option<[f64; 4]> {
    let digits = text.trim().strip_prefix('#')?;
    let byte = |i: usize| Some(f64::from(u8::from_str_radix(digits.get(i..i + 2)?, 16).ok()?) / 255.0);
    let alpha = if digits.len() == 8 { byte(6)? } else { 1.0 };
    Some([byte(0)?, byte(2)?, byte(4)?, alpha])
}
