//! What stands in a document: parts, primitives, steps, outputs.

use super::Error;
use super::action::Action;
use super::table::{Places, check_keys, read, take};
use crate::operation::{LoopName, Pose, Precision, Primitive};
use mesh_io::Format;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::ops::Range;
use std::path::PathBuf;
use toml::Spanned;
use toml::de::DeTable;

/// An input.
#[derive(Clone, Debug)]
pub struct Part {
    /// What steps call it.
    pub name: String,
    /// Its file, relative to the document.
    pub mesh: PathBuf,
    /// Where it stands.
    pub pose: Pose,
    pub(super) places: Places,
}

/// A primitive by its name.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) primitive: Primitive,
    pub(super) places: Places,
}

/// An operation on named shapes, which gives a named shape.
#[derive(Clone, Debug)]
pub struct Step {
    /// The shapes it works on, in order.
    pub of: Vec<String>,
    /// What the result is called.
    pub name: String,
    /// Whether it is passed over; then the result is the first shape.
    pub is_off: bool,
    /// What it does.
    pub action: Action,
    /// What stands in the text in the place of the first two, before names are known.
    pub(super) written: Written,
    pub(super) places: Places,
}

/// The names of a step as they are written.
#[derive(Clone, Debug, Default)]
pub(super) struct Written {
    pub(super) of: Option<Vec<LoopName>>,
    pub(super) name: Option<String>,
}

/// A result.
#[derive(Clone, Debug)]
pub struct Output {
    /// The shape; the only one that is left where left out.
    pub of: String,
    /// Its file, relative to the document.
    pub file: PathBuf,
    pub(super) written: Option<String>,
    pub(super) places: Places,
}

impl Output {
    /// What its file can hold; 64 bits where the extension names no format.
    pub fn precision(&self) -> Precision {
        match Format::from_path(&self.file) {
            Ok(format) if !format.is_lossless() => Precision::F32,
            _ => Precision::F64,
        }
    }
}

/// One, or several.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a name, or a list of names")]
enum Names {
    One(LoopName),
    Several(Vec<LoopName>),
}

impl Part {
    pub(super) fn read(text: &str, whole: Range<usize>, mut table: DeTable<'_>) -> Result<Self, Error> {
        let places = Places::of(whole.clone(), &table);
        let name: String = needed(text, &mut table, &places, "name")?;
        let mesh = needed(text, &mut table, &places, "mesh")?;
        let known = [&["name", "mesh"][..], &super::table::fields::<Pose>()].concat();
        check_keys(text, &table, &known)?;
        let pose: Pose = read(text, whole, table, &[])?;
        crate::operation::Options::validate(&pose).map_err(|e| places.wrong(text, &e))?;
        check_name(text, &places, "name", &name)?;
        Ok(Self { name, mesh, pose, places })
    }
}

impl Named {
    pub(super) fn read(text: &str, whole: Range<usize>, table: DeTable<'_>) -> Result<Self, Error> {
        let places = Places::of(whole.clone(), &table);
        let primitive: Primitive = read(text, whole, table, &[])?;
        primitive.check().map_err(|e| places.wrong(text, &e))?;
        Ok(Self { primitive, places })
    }
}

impl Step {
    pub(super) fn read(text: &str, whole: Range<usize>, mut table: DeTable<'_>) -> Result<Self, Error> {
        let places = Places::of(whole.clone(), &table);
        let verb: Spanned<String> = needed(text, &mut table, &places, "do")?;
        let of: Option<Names> = take(text, &mut table, "of")?;
        let name: Option<String> = take(text, &mut table, "as")?;
        let is_off = take(text, &mut table, "off")?.unwrap_or(false);
        if let Some(name) = &name {
            check_name(text, &places, "as", name)?;
        }
        let of = of.map(|names| match names {
            Names::One(name) => vec![name],
            Names::Several(names) => names,
        });
        let action = Action::read(text, (verb.get_ref(), verb.span()), whole, table)?;
        action.validate().map_err(|e| places.wrong(text, &e))?;
        Ok(Self { of: vec![], name: String::new(), is_off, action, written: Written { of, name }, places })
    }
}

impl Output {
    pub(super) fn read(text: &str, whole: Range<usize>, mut table: DeTable<'_>) -> Result<Self, Error> {
        let places = Places::of(whole, &table);
        let written: Option<String> = take(text, &mut table, "of")?;
        let file = needed(text, &mut table, &places, "file")?;
        check_keys(text, &table, &["of", "file"])?;
        Ok(Self { of: String::new(), file, written, places })
    }
}

fn needed<T: DeserializeOwned>(text: &str, table: &mut DeTable<'_>, places: &Places, key: &str) -> Result<T, Error> {
    take(text, table, key)?.ok_or_else(|| Error::at(text, places.whole.clone(), format!("`{key}` is missing")))
}

/// Names of shapes must differ from names of loops.
fn check_name(text: &str, places: &Places, key: &str, name: &str) -> Result<(), Error> {
    if name.is_empty() || name.contains(':') {
        let told = Error::at(text, places.span(key), format!("{name:?} is no name of a shape"));
        return Err(told.remedy("a name has one character or more, and no colon"));
    }
    Ok(())
}
