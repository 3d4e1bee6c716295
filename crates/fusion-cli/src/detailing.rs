//! What can be typed about geometry detail.

use crate::args::{Source, Target};
use crate::length::{Length, point, positive_length};
use crate::place::Place;
use clap::{Args, ValueEnum};
use fusion::detail_transfer::{self, FanLength, Ribbon, Search};
use glam::DVec3;
use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

#[derive(Args)]
pub struct Detail {
    /// The mesh with the region that gets detail
    pub input: PathBuf,
    #[command(flatten)]
    pub output: Target,
    #[command(flatten)]
    pub source: Source,
    /// What gets detail: near=X,Y,Z,RADIUS, group=NAME, origin=STAGE (`origin=transition` for what `compose` made), or a file of face ids
    #[arg(long, value_name = "REGION", allow_hyphen_values = true)]
    pub target: Place,
    /// Where detail is taken from: a region of the same mesh, or FILE:REGION of another; may be given more than once
    #[arg(long = "source", value_name = "REGION", required = true, allow_hyphen_values = true)]
    pub sources: Vec<SourcePlace>,
    #[command(flatten)]
    pub how: How,
}

/// How detail is transferred.
#[derive(Args)]
pub struct How {
    /// Continue detail patch by patch along this curve, which leads from detail into the target, before all else
    #[arg(long, value_name = "X,Y,Z X,Y,Z ...", allow_hyphen_values = true)]
    pub along: Option<Curve>,
    /// The curve on the source, where that is another mesh [default: that of --along]
    #[arg(long, value_name = "X,Y,Z X,Y,Z ...", allow_hyphen_values = true, requires = "along")]
    pub source_along: Option<Curve>,
    /// Width of the band along the curve [default: the whole target]
    #[arg(long, value_name = "L", value_parser = positive_length, requires = "along")]
    pub width: Option<Length>,
    /// Distance of patches along the curve [default: a quarter of the width]
    #[arg(long, value_name = "L", value_parser = positive_length, requires = "along")]
    pub spacing: Option<Length>,
    /// Factor of the detail; negative turns bumps into dents
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = factor, allow_hyphen_values = true)]
    pub intensity: f64,
    /// What is shorter than this counts as detail [default: twelve mean edges of the first source]
    #[arg(long, value_name = "L", value_parser = positive_length)]
    pub wavelength: Option<Length>,
    /// How far around a vertex similarity is judged: `diagonal` (1% of it, at least `edges`), `edges` (1.5 longest edges), or a length
    #[arg(long, value_name = "L", default_value = "diagonal")]
    pub fan: Fan,
    /// How the most similar place is searched for; both find the same
    #[arg(long, value_enum, default_value = "indexed")]
    pub search: Finding,
}

/// Two points or more, apart by spaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(pub Vec<DVec3>);

impl FromStr for Curve {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let points = text.split_whitespace().map(point).collect::<Result<Vec<_>, _>>()?;
        if points.len() < 2 { Err("a curve is two points or more".into()) } else { Ok(Self(points)) }
    }
}

/// Gathers the points after `--along` and `--source-along` into one argument each: a point may begin with a minus, as an option does.
pub fn with_curves(arguments: Vec<OsString>) -> Vec<OsString> {
    let is_point = |a: &OsString| a.to_str().is_some_and(|a| point(a).is_ok());
    let mut out = vec![];
    let mut rest = arguments.into_iter().peekable();
    while let Some(argument) = rest.next() {
        let takes_points = argument == "--along" || argument == "--source-along";
        out.push(argument);
        let mut points = vec![];
        while takes_points && rest.peek().is_some_and(is_point) {
            points.extend(rest.next().and_then(|p| p.into_string().ok()));
        }
        if !points.is_empty() {
            out.push(points.join(" ").into());
        }
    }
    out
}

/// How similar places are searched for.
#[derive(Clone, Copy, ValueEnum)]
pub enum Finding {
    /// By a tree over all places
    Indexed,
    /// By looking at all places
    Exhaustive,
}

/// A length of fans as it is typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fan {
    Diagonal,
    Edges,
    Length(Length),
}

impl FromStr for Fan {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "diagonal" => Ok(Self::Diagonal),
            "edges" => Ok(Self::Edges),
            _ => positive_length(text).map(Self::Length),
        }
    }
}

/// A region of the same mesh or of another.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcePlace {
    pub file: Option<PathBuf>,
    pub place: Place,
}

impl FromStr for SourcePlace {
    type Err = Box<dyn std::error::Error + Send + Sync>;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        // A file's name may hold colons; the region begins after the last one that one of its kinds follows.
        let begins = |rest: &str| ["near=", "group=", "origin="].iter().any(|k| rest.starts_with(k));
        let split = text.match_indices(':').map(|(i, _)| i).rfind(|&i| i > 0 && begins(&text[i + 1..]));
        match split {
            Some(i) => Ok(Self { file: Some(text[..i].into()), place: text[i + 1..].parse()? }),
            None => Ok(Self { file: None, place: text.parse()? }),
        }
    }
}

/// A region of one of several inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct PartPlace {
    pub part: usize,
    pub place: Place,
}

impl FromStr for PartPlace {
    type Err = Box<dyn std::error::Error + Send + Sync>;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (part, place) = text.split_once(':').ok_or("a region of a part is MESH:REGION, such as 0:near=0,0,0,2%")?;
        Ok(Self {
            part: part.parse().map_err(|_| "a mesh is its place among the inputs, from 0")?,
            place: place.parse()?,
        })
    }
}

fn factor(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|f: &f64| f.is_finite()).ok_or_else(|| "a factor is a finite number".into())
}

impl How {
    /// With lengths in model units.
    pub fn resolve(&self, diagonal: f64) -> detail_transfer::Params {
        let ribbon = self.along.as_ref().map(|curve| Ribbon {
            curve: curve.0.clone(),
            source_curve: self.source_along.as_ref().map(|c| c.0.clone()),
            width: self.width.map(|l| l.resolve(diagonal)),
            spacing: self.spacing.map(|l| l.resolve(diagonal)),
        });
        detail_transfer::Params {
            wavelength: self.wavelength.map(|l| l.resolve(diagonal)),
            fan: match self.fan {
                Fan::Diagonal => FanLength::Diagonal,
                Fan::Edges => FanLength::Edges,
                Fan::Length(l) => FanLength::Units(l.resolve(diagonal)),
            },
            search: match self.search {
                Finding::Indexed => Search::Indexed,
                Finding::Exhaustive => Search::Exhaustive,
            },
            intensity: Some(self.intensity),
            ribbon,
            most_folded: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_regions_of_this_mesh_or_another() {
        let place = |text: &str| text.parse::<SourcePlace>().unwrap();
        assert_eq!(place("near=1,2,3,4").file, None);
        assert_eq!(place("a:b.off:group=x:y").file, Some("a:b.off".into()));
        assert_eq!(place("a.off:near=1,2,3,5%").place, "near=1,2,3,5%".parse().unwrap());
        assert!("a.off:near=1,2".parse::<SourcePlace>().is_err());
    }

    #[test]
    fn curves_are_gathered() {
        let typed = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        let found = with_curves(typed("detail a --along -1,0,0 1,0,0 -o b"));
        assert_eq!(found, ["detail", "a", "--along", "-1,0,0 1,0,0", "-o", "b"].map(OsString::from));
        assert_eq!("-1,0,0 1,0,0".parse(), Ok(Curve(vec![DVec3::NEG_X, DVec3::X])));
        assert!("1,0,0".parse::<Curve>().is_err());
    }

    #[test]
    fn fans_are_names_or_lengths() {
        assert_eq!("edges".parse(), Ok(Fan::Edges));
        assert_eq!("2%".parse(), Ok(Fan::Length(Length::OfDiagonal(0.02))));
        assert!("-1".parse::<Fan>().is_err() && "wide".parse::<Fan>().is_err());
    }
}
