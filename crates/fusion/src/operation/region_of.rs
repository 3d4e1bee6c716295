//! Regions of one of several parts, and curves over them.

use super::length::Length;
use super::option_error::Check;
use super::place::point;
use super::region::RegionArg;
use glam::DVec3;
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// A region, and the part it lies on: `PART:REGION` in text, or the region alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Written", into = "Written")]
#[schemars(with = "Written")]
pub struct RegionOf {
    /// The part by its name, or on the command line by its file.
    pub part: Option<String>,
    /// The region.
    pub region: RegionArg,
}

/// How a region is written in documents.
#[derive(Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct Written {
    /// Which part, by name.
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<String>,
    /// The faces around the surface point nearest to this one, as far as the radius.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<[f64; 3]>")]
    near: Option<DVec3>,
    /// How far a region around a point reaches.
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<Length>,
    /// The faces of a group.
    #[serde(skip_serializing_if = "Option::is_none")]
    group: Option<String>,
    /// What a stage made.
    #[serde(skip_serializing_if = "Option::is_none")]
    origin: Option<String>,
    /// Faces by their ids.
    #[serde(skip_serializing_if = "Option::is_none")]
    faces: Option<Vec<u32>>,
    /// The file of face ids.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<PathBuf>,
}

impl TryFrom<Written> for RegionOf {
    type Error = &'static str;

    fn try_from(written: Written) -> Result<Self, Self::Error> {
        let Written { part, near, radius, group, origin, faces, file } = written;
        let region = match (near, radius, group, origin, faces, file) {
            (Some(near), Some(radius), None, None, None, None) => RegionArg::Near { near, radius },
            (None, None, Some(group), None, None, None) => RegionArg::Group { group },
            (None, None, None, Some(origin), None, None) => RegionArg::Origin { origin },
            (None, None, None, None, Some(faces), None) => RegionArg::Faces { faces },
            (None, None, None, None, None, Some(file)) => RegionArg::File(file),
            _ => return Err("a region is near and radius (above 0), or group, or origin, or faces, or file"),
        };
        Ok(Self { part, region })
    }
}

impl From<RegionOf> for Written {
    fn from(RegionOf { part, region }: RegionOf) -> Self {
        let written = Self { part, ..Self::default() };
        match region {
            RegionArg::Near { near, radius } => Self { near: Some(near), radius: Some(radius), ..written },
            RegionArg::Group { group } => Self { group: Some(group), ..written },
            RegionArg::Origin { origin } => Self { origin: Some(origin), ..written },
            RegionArg::Faces { faces } => Self { faces: Some(faces), ..written },
            RegionArg::File(file) => Self { file: Some(file), ..written },
        }
    }
}

impl FromStr for RegionOf {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // A part's name may hold colons; the region begins after the last one that one of its kinds follows.
        let begins = |rest: &str| ["near=", "group=", "origin="].iter().any(|k| rest.starts_with(k));
        let split = text.match_indices(':').map(|(i, _)| i).rfind(|&i| i > 0 && begins(&text[i + 1..]));
        match split {
            Some(i) => Ok(Self { part: Some(text[..i].into()), region: text[i + 1..].parse()? }),
            None => Ok(Self { part: None, region: text.parse()? }),
        }
    }
}

impl RegionOf {
    pub(super) fn check(&self, option: &'static str) -> Check {
        self.region.check(option)
    }
}

/// One region, or a list of them. Read as they come, so that what is wrong is told by its place.
pub(super) fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RegionOf>, D::Error> {
    struct Either;

    impl<'de> Visitor<'de> for Either {
        type Value = Vec<RegionOf>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("a region, or a list of regions")
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
            RegionOf::deserialize(MapAccessDeserializer::new(map)).map(|region| vec![region])
        }

        fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Self::Value, A::Error> {
            Vec::deserialize(SeqAccessDeserializer::new(list))
        }
    }

    deserializer.deserialize_any(Either)
}

/// Points of a curve, in text apart by spaces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "list of x, y, z")]
pub struct Curve(#[schemars(with = "Vec<[f64; 3]>")] pub Vec<DVec3>);

impl FromStr for Curve {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let points = text.split_whitespace().map(point).collect::<Result<Vec<_>, _>>()?;
        if points.len() < 2 { Err("a curve is two points or more".into()) } else { Ok(Self(points)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_lie_on_this_part_or_another() {
        let region = |text: &str| text.parse::<RegionOf>().unwrap();
        assert_eq!(region("near=1,2,3,4").part, None);
        assert_eq!(region("a:b.off:group=x:y").part, Some("a:b.off".into()));
        assert_eq!(region("a.off:near=1,2,3,5%").region, "near=1,2,3,5%".parse().unwrap());
        assert!("a.off:near=1,2".parse::<RegionOf>().is_err());
        assert_eq!("-1,0,0 1,0,0".parse(), Ok(Curve(vec![DVec3::NEG_X, DVec3::X])));
        assert!("1,0,0".parse::<Curve>().is_err());
        let json = serde_json::to_string(&region("a:origin=blend")).unwrap();
        assert_eq!(json, r#"{"part":"a","origin":"blend"}"#);
        assert_eq!(serde_json::from_str::<RegionOf>(&json).unwrap(), region("a:origin=blend"));
    }
}
