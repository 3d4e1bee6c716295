//! Geometry detail from region to region.

use super::Length;
use super::define::{operation, words};
use super::linked::Files;
use super::option_error::{Check, OptionError, ensure, finite, positive, within};
use super::options::Options;
use super::region::RegionArg;
use super::region_of::{Curve, RegionOf};
use crate::Region;
use crate::attributes::TRANSITION;
use crate::detail::Params;
use detail_transfer::{FanLength, Ribbon};
use mesh_io::Format;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Factors of detail.
const INTENSITY: RangeInclusive<f64> = -1e6..=1e6;

words! {
    /// How the most similar place is searched for; both find the same.
    pub enum Search: "a search" {
        /// By a tree over all places
        Indexed = "indexed",
        /// By looking at all places
        Exhaustive = "exhaustive",
    }
}

words! {
    /// Whether detail is continued along a curve.
    pub enum DetailMode: "a mode" {
        /// By similar surroundings alone
        Unstructured = "unstructured",
        /// Along a curve first
        Structured = "structured",
    }
}

/// How far around a vertex similarity is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fan {
    /// One percent of the target's diagonal, at least as [`Fan::Edges`].
    Diagonal,
    /// One and a half longest edges.
    Edges,
    /// A length.
    Length(Length),
}

impl FromStr for Fan {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "diagonal" => Ok(Self::Diagonal),
            "edges" => Ok(Self::Edges),
            _ => Length::positive(text).map(Self::Length).map_err(|e| format!("diagonal, edges or a length: {e}")),
        }
    }
}

impl fmt::Display for Fan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagonal => f.write_str("diagonal"),
            Self::Edges => f.write_str("edges"),
            Self::Length(length) => length.fmt(f),
        }
    }
}

impl serde::Serialize for Fan {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Length(length) => length.serialize(serializer),
            _ => serializer.collect_str(self),
        }
    }
}

impl<'de> serde::Deserialize<'de> for Fan {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(serde::Deserialize)]
        #[serde(untagged, expecting = "a fan is diagonal, edges or a length")]
        enum Written {
            Units(f64),
            Text(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Units(units) => Ok(Self::Length(units.into())),
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
        }
    }
}

impl JsonSchema for Fan {
    fn schema_name() -> Cow<'static, str> {
        "Fan".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "title": "length, `diagonal`, `edges`", "type": ["number", "string"] })
    }
}

operation! {
    /// Give a smooth region the geometry detail of another
    pub struct Detail {
        /// What gets detail: near=X,Y,Z,RADIUS, group=NAME, origin=STAGE (`origin=transition` for what `compose` made), or a
        /// file of face ids
        #[cfg_attr(feature = "clap", arg(long, value_name = "REGION", allow_hyphen_values = true, required = true))]
        target: Option<RegionOf> = None;
        /// Where detail is taken from: a region of the same mesh, or FILE:REGION of another; may be given more than once
        #[serde(deserialize_with = "super::region_of::one_or_many")]
        #[cfg_attr(feature = "clap", arg(long, value_name = "REGION", required = true, allow_hyphen_values = true))]
        source: Vec<RegionOf> = vec![];
        /// Whether detail is continued along a curve; by the curve where left out
        #[cfg_attr(feature = "clap", arg(skip))]
        mode: Option<DetailMode> = None;
        /// Continue detail patch by patch along this curve, which leads from detail into the target, before all else
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z X,Y,Z ...", allow_hyphen_values = true))]
        along: Option<Curve> = None;
        /// The curve on the source, where that is another mesh; that of the target where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z X,Y,Z ...", allow_hyphen_values = true,
            requires = "along"))]
        source_along: Option<Curve> = None;
        /// Width of the band along the curve; the whole target where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive, requires = "along"))]
        width: Option<Length> = None;
        /// Distance of patches along the curve; a quarter of the width where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive, requires = "along"))]
        spacing: Option<Length> = None;
        /// Factor of the detail; negative turns bumps into dents
        #[cfg_attr(feature = "clap", arg(long, value_name = "FACTOR", default_value_t = Self::default().intensity,
            allow_hyphen_values = true))]
        intensity: f64 = 1.0;
        /// What is shorter than this counts as detail; twelve mean edges of the first source where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive))]
        wavelength: Option<Length> = None;
        /// How far around a vertex similarity is judged: `diagonal` (1% of it, at least `edges`), `edges` (1.5 longest edges),
        /// or a length
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", default_value_t = Fan::Diagonal))]
        fan: Fan = Fan::Diagonal;
        /// How the most similar place is searched for; both find the same
        #[cfg_attr(feature = "clap", arg(long, value_name = "SEARCH", default_value_t = Search::Indexed,
            help_heading = super::VARIANTS, hide_short_help = true))]
        search: Search = Search::Indexed;
    }
}

impl Options for Detail {
    const NAME: &'static str = "detail";

    fn validate(&self) -> Check {
        ensure(!self.source.is_empty(), "source", || "a region to take detail from is needed".into())?;
        self.target.as_ref().map_or(Ok(()), |t| t.check("target"))?;
        self.source.iter().try_for_each(|s| s.check("source"))?;
        ensure(self.mode != Some(DetailMode::Structured) || self.along.is_some(), "mode", || MODE.into())?;
        ensure(self.mode != Some(DetailMode::Unstructured) || self.along.is_none(), "mode", || MODE.into())?;
        for (curve, option) in [(&self.along, "along"), (&self.source_along, "source_along")] {
            let Some(Curve(points)) = curve else { continue };
            ensure(points.len() >= 2, option, || "a curve is two points or more".into())?;
            points.iter().try_for_each(|&p| finite(p, option))?;
        }
        let lengths = [(self.width, "width"), (self.spacing, "spacing"), (self.wavelength, "wavelength")];
        lengths.into_iter().try_for_each(|(l, option)| l.map_or(Ok(()), |l| positive(l, option)))?;
        if let Fan::Length(length) = self.fan {
            positive(length, "fan")?;
        }
        within(self.intensity, &INTENSITY, "intensity", "a factor is a number")
    }

    fn load(&mut self, files: &mut dyn Files) -> Check {
        self.target.as_mut().map_or(Ok(()), |t| t.region.load("target", files))?;
        self.source.iter_mut().try_for_each(|s| s.region.load("source", files))
    }
}

const MODE: &str = "a mode is unstructured, or structured with a curve `along` of two points or more";

impl Detail {
    /// What gets detail: what joins have made where left out.
    pub fn target(&self) -> RegionOf {
        let made = RegionArg::Origin { origin: TRANSITION.into() };
        self.target.clone().unwrap_or(RegionOf { part: None, region: made })
    }

    /// The same for [`detail()`](crate::detail::detail()), with lengths in model units; `diagonal` is what they may be a share
    /// of. `parts` tells the input of each source by its name, of which there is none in the target's own part.
    ///
    /// # Errors
    /// As [`Options::validate`], and for files that have not been read.
    pub fn params(
        &self,
        diagonal: f64,
        format: Format,
        mut parts: impl FnMut(Option<&str>) -> usize,
    ) -> Result<Params, OptionError> {
        self.validate()?;
        let resolve = |l: Option<Length>| l.map(|l| l.resolve(diagonal));
        let ribbon = self.along.as_ref().map(|curve| Ribbon {
            curve: curve.0.clone(),
            source_curve: self.source_along.as_ref().map(|c| c.0.clone()),
            width: resolve(self.width),
            spacing: resolve(self.spacing),
        });
        let source = |s: &RegionOf| -> Result<(usize, Region), OptionError> {
            Ok((parts(s.part.as_deref()), s.region.resolve("source", diagonal)?))
        };
        Ok(Params {
            target: self.target().region.resolve("target", diagonal)?,
            sources: self.source.iter().map(source).collect::<Result<_, _>>()?,
            transfer: detail_transfer::Params {
                wavelength: resolve(self.wavelength),
                fan: match self.fan {
                    Fan::Diagonal => FanLength::Diagonal,
                    Fan::Edges => FanLength::Edges,
                    Fan::Length(length) => FanLength::Units(length.resolve(diagonal)),
                },
                search: match self.search {
                    Search::Indexed => detail_transfer::Search::Indexed,
                    Search::Exhaustive => detail_transfer::Search::Exhaustive,
                },
                intensity: Some(self.intensity),
                ribbon,
                ..detail_transfer::Params::default()
            },
            format,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans_are_names_or_lengths() {
        assert_eq!("edges".parse(), Ok(Fan::Edges));
        assert_eq!("2%".parse(), Ok(Fan::Length(Length::OfDiagonal(0.02))));
        assert!("-1".parse::<Fan>().is_err() && "wide".parse::<Fan>().is_err());
    }
}
