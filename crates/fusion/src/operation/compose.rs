//! Openings joined by one smooth surface.

use super::define::{as_text, operation, words};
use super::option_error::{Check, OptionError, ensure, positive, within};
use super::options::Options;
use super::silhouette::SilhouetteArg;
use super::{Length, Precision};
use crate::compose::{self, Params};
use crate::{Error, Outcome};
use mesh_core::{Bounds, Watch, bounds};
use mesh_io::{Format, Model};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Rings of vertices around an opening.
const RINGS: RangeInclusive<usize> = 0..=16;
/// Angles by which the surface turns inward, in degrees.
const CREASE: RangeInclusive<f64> = -90.0..=90.0;

words! {
    /// The kernel of a field.
    pub enum Kernel: "a kernel" {
        /// r³: smooth, tolerant of noise
        Triharmonic = "triharmonic",
        /// r: shrinks least, bends sharply at the openings
        Biharmonic = "biharmonic",
        /// r³ with exact normals: smoothest on clean meshes
        Hermite = "hermite",
    }
}

words! {
    /// How a field is held at the openings.
    pub enum Method: "a method" {
        /// Rings of the parts' vertices, and points outside of them
        Implicit = "implicit",
        /// Boundary vertices alone, and points on both sides of them
        Montage = "montage",
    }
}

/// A boundary loop of a part: `part:0`, or `part` for all of its loops. Where parts have no names they are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LoopName {
    /// The part.
    pub part: String,
    /// The loop, counted from 0 as `info` lists them for the part; all of them where left out.
    pub index: Option<usize>,
}

as_text! { LoopName }

impl FromStr for LoopName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((part, index)) = text.rsplit_once(':') else { return Ok(Self { part: text.into(), index: None }) };
        let index = index.parse().map_err(|_| "a loop is \"part:0\", or \"part\" for all of its loops")?;
        Ok(Self { part: part.into(), index: Some(index) })
    }
}

impl fmt::Display for LoopName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.part)?;
        self.index.map_or(Ok(()), |index| write!(f, ":{index}"))
    }
}

impl JsonSchema for LoopName {
    fn schema_name() -> Cow<'static, str> {
        "LoopName".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "title": "`\"part:loop\"` or `\"part\"`", "type": "string" })
    }
}

/// By how many degrees the surface turns inward at the openings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a crease is an angle from -90 to 90 degrees, or a table by names of loops")]
#[schemars(title = "degrees, or a table by names of loops")]
pub enum Creases {
    /// At every one.
    All(f64),
    /// At those named.
    Each(BTreeMap<String, f64>),
}

impl FromStr for Creases {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.parse().map(Self::All).map_err(|_| "must be an angle from -90 to 90 degrees".into())
    }
}

impl fmt::Display for Creases {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All(angle) => angle.fmt(f),
            Self::Each(each) => write!(f, "{each:?}"),
        }
    }
}

operation! {
    /// Join the openings of parts by one smooth surface, leaving the parts as they are
    pub struct Compose {
        /// Join only this loop; may be given more than once, all open boundaries where left out
        #[cfg_attr(feature = "clap", arg(long = "loop", alias = "loops", value_name = "MESH:LOOP"))]
        loops: Vec<LoopName> = vec![];
        /// Kernel of the field
        #[cfg_attr(feature = "clap", arg(long, value_name = "KERNEL", default_value_t = Kernel::Triharmonic))]
        kernel: Kernel = Kernel::Triharmonic;
        /// How the field is held at the openings
        #[cfg_attr(feature = "clap", arg(long, value_name = "METHOD", default_value_t = Method::Implicit,
            help_heading = super::VARIANTS, hide_short_help = true))]
        method: Method = Method::Implicit;
        /// Rings of vertices around each opening that the field interpolates; where left out 3, for the kernel `hermite` 1,
        /// for the method `montage` 0
        #[schemars(range(min = *RINGS.start(), max = *RINGS.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
        rings: Option<usize> = None;
        /// Size of the tessellation's cells, as a share of the openings' mean edge
        #[schemars(extend("exclusiveMinimum" = 0))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = Self::default().cell))]
        cell: f64 = Params::new(Format::Ply).cell;
        /// Edge length of the surface away from the openings; that of the nearest openings where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive))]
        edge_length: Option<Length> = None;
        /// How far from the openings the surface may go, in diagonals of the box around them
        #[schemars(extend("exclusiveMinimum" = 0))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = Self::default().space))]
        space: f64 = Params::new(Format::Ply).space;
        /// By how many degrees the surface turns inward where it leaves the openings, -90 to 90; negative outward
        #[cfg_attr(feature = "clap", arg(long, value_name = "DEG", default_value_t = Self::default().crease,
            allow_hyphen_values = true))]
        crease: Creases = Creases::All(Params::new(Format::Ply).crease);
        /// Trim openings nearer than this to one of another part back along their own part
        #[cfg_attr(feature = "clap", arg(long, value_name = "DISTANCE", value_parser = Length::positive))]
        adjust: Option<Length> = None;
        /// Silhouettes that the surface shall have
        #[cfg_attr(feature = "clap", arg(skip))]
        silhouette: Vec<SilhouetteArg> = vec![];
    }
}

impl Options for Compose {
    const NAME: &'static str = "compose";

    fn validate(&self) -> Check {
        self.rings.map_or(Ok(()), |n| {
            ensure(RINGS.contains(&n), "rings", || {
                format!("must be a number from {} to {}", RINGS.start(), RINGS.end())
            })
        })?;
        for (number, option) in [(self.cell, "cell"), (self.space, "space")] {
            ensure(number > 0.0 && number.is_finite(), option, || "must be a number above zero".into())?;
        }
        self.edge_length.map_or(Ok(()), |l| positive(l, "edge_length"))?;
        self.adjust.map_or(Ok(()), |l| positive(l, "adjust"))?;
        let crease = |&angle: &f64| within(angle, &CREASE, "crease", "a crease is an angle in degrees");
        match &self.crease {
            Creases::All(angle) => crease(angle)?,
            Creases::Each(each) => each.values().try_for_each(crease)?,
        }
        self.silhouette.iter().try_for_each(SilhouetteArg::check)
    }
}

impl Compose {
    /// Joins the openings of parts, which are counted from 0 in names of loops. Lengths may be a share of the diagonal of the
    /// box around all.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`compose::compose`].
    pub fn run(&self, parts: &[Model], precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        let diagonal = parts.iter().map(|m| bounds(&m.mesh)).fold(Bounds::EMPTY, Bounds::union).diagonal();
        compose::compose(parts, &self.numbered(diagonal, precision.into())?, watch)
    }

    /// The same for [`compose::compose`], with lengths in model units; `diagonal` is what they may be a share of. Names of
    /// loops are those of parts counted from 0.
    ///
    /// # Errors
    /// As [`Options::validate`], and for other names.
    pub fn numbered(&self, diagonal: f64, format: Format) -> Result<Params, OptionError> {
        let mut params = self.params(diagonal, format)?;
        let number = |name: &LoopName, option| {
            let pair = name.part.parse().ok().zip(name.index);
            pair.ok_or_else(|| OptionError::new(option, "a loop is the number of its mesh and its own, such as 1:0"))
        };
        if !self.loops.is_empty() {
            params.loops = Some(self.loops.iter().map(|l| number(l, "loops")).collect::<Result<_, _>>()?);
        }
        if let Creases::Each(each) = &self.crease {
            let one = |(name, &angle): (&String, &f64)| {
                let name: LoopName = name.parse().map_err(|e: String| OptionError::new("crease", e))?;
                number(&name, "crease").map(|(part, index)| compose::Crease { part, index, angle })
            };
            params.creases = each.iter().map(one).collect::<Result<_, _>>()?;
        }
        Ok(params)
    }

    /// The same without the loops and creases that go by names.
    pub(crate) fn params(&self, diagonal: f64, format: Format) -> Result<Params, OptionError> {
        self.validate()?;
        let made = Params::new(format);
        Ok(Params {
            kernel: match self.kernel {
                Kernel::Biharmonic => compose::Kernel::Biharmonic,
                Kernel::Triharmonic => compose::Kernel::Triharmonic,
                Kernel::Hermite => compose::Kernel::Hermite,
            },
            method: match self.method {
                Method::Implicit => compose::Method::Implicit,
                Method::Montage => compose::Method::Montage,
            },
            rings: self.rings,
            cell: self.cell,
            edge_length: self.edge_length.map(|l| l.resolve(diagonal)),
            crease: if let Creases::All(angle) = self.crease { angle } else { made.crease },
            adjust: self.adjust.map(|l| l.resolve(diagonal)),
            silhouettes: self.silhouette.iter().map(SilhouetteArg::resolve).collect(),
            space: self.space,
            ..made
        })
    }
}
