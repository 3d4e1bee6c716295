//! Cross-sections of blends.

use super::linked::{Files, parsed};
use super::option_error::{Check, OptionError, ensure, within};
use super::place::point;
use crate::profile_file::CurveFile;
use crate::profile_from_text;
use glam::DVec3;
use profile_nurbs::Profile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Distances of a section's apex from the ball's centre, in radii.
pub(super) const REACH: RangeInclusive<f64> = 0.1..=100.0;

/// A cross-section: a curve by its name, by its file or as NURBS, and how far its apex is moved out.
///
/// ```
/// use fusion::operation::Section;
/// let section: Section = "conic=2,reach=1.5".parse()?;
/// assert_eq!((section.to_string(), section.reach), ("conic=2,reach=1.5".into(), Some(1.5)));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Written", into = "Written")]
#[schemars(with = "Written")]
pub struct Section {
    /// The curve.
    pub curve: SectionCurve,
    /// Distance of the apex from the ball's centre, in radii, where it is moved out along its line.
    pub reach: Option<f64>,
}

/// The curve of a cross-section.
#[derive(Clone, Debug, PartialEq)]
pub enum SectionCurve {
    /// The curve itself.
    Known(Profile),
    /// In this file.
    File(PathBuf),
}

/// How a section is written in documents.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a profile is a name, a path, or a table of `degree` and `points`")]
#[schemars(title = "`arc`, `g2`, `chamfer`, `sharp`, `hermite`, `conic=W`, or a path")]
enum Written {
    Text(String),
    Curve(CurveFile),
}

impl Section {
    /// The section of a known curve.
    pub fn new(profile: Profile) -> Self {
        Self { curve: SectionCurve::Known(profile), reach: None }
    }

    pub(super) fn profile(&self, option: &'static str) -> Result<&Profile, OptionError> {
        match &self.curve {
            SectionCurve::Known(profile) => Ok(profile),
            SectionCurve::File(path) => Err(OptionError::new(option, format!("{} has not been read", path.display()))),
        }
    }

    pub(super) fn load(&mut self, option: &'static str, files: &mut dyn Files) -> Check {
        if let SectionCurve::File(path) = &self.curve {
            let profile = parsed(files, path, profile_from_text).map_err(|e| OptionError::new(option, e))?;
            self.curve = SectionCurve::Known(profile);
        }
        Ok(())
    }

    pub(super) fn check(&self, option: &'static str) -> Check {
        if let SectionCurve::Known(Profile::Conic(weight)) = self.curve {
            ensure(weight.is_finite() && weight >= 0.0, option, || NAMES.into())?;
        }
        self.reach.map_or(Ok(()), |reach| within(reach, &REACH, option, "the reach of a profile is a number of radii"))
    }
}

const NAMES: &str = "a profile is arc, g2, chamfer, sharp, hermite, conic=W with W ≥ 0, such as conic=2, or a file with an extension, such as curve.json";

impl Default for Section {
    fn default() -> Self {
        Self::new(Profile::Arc)
    }
}

impl From<Profile> for Section {
    fn from(profile: Profile) -> Self {
        Self::new(profile)
    }
}

impl FromStr for Section {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, reach) = match text.split_once(",reach=") {
            None => (text, None),
            Some((name, reach)) => (name, Some(reach.parse().unwrap_or(f64::NAN))),
        };
        let is_file = Path::new(name).extension().is_some() && !name.starts_with("conic=");
        let curve = match Profile::named(name) {
            Some(profile) => SectionCurve::Known(profile),
            None if is_file => SectionCurve::File(name.into()),
            None => return Err(NAMES.into()),
        };
        let section = Self { curve, reach };
        section.check("profile").map_err(|e| e.reason)?;
        Ok(section)
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.curve {
            SectionCurve::File(path) => path.display().fmt(f)?,
            SectionCurve::Known(Profile::Arc) => f.write_str("arc")?,
            SectionCurve::Known(Profile::G2) => f.write_str("g2")?,
            SectionCurve::Known(Profile::Chamfer) => f.write_str("chamfer")?,
            SectionCurve::Known(Profile::Sharp) => f.write_str("sharp")?,
            SectionCurve::Known(Profile::Hermite) => f.write_str("hermite")?,
            SectionCurve::Known(Profile::Conic(weight)) => write!(f, "conic={weight}")?,
            SectionCurve::Known(Profile::Custom(_)) => f.write_str("custom")?,
        }
        self.reach.map_or(Ok(()), |reach| write!(f, ",reach={reach}"))
    }
}

impl TryFrom<Written> for Section {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Text(text) => text.parse(),
            Written::Curve(curve) => curve.profile().map(Self::new).map_err(|e| e.to_string()),
        }
    }
}

impl From<Section> for Written {
    fn from(section: Section) -> Self {
        match &section.curve {
            SectionCurve::Known(Profile::Custom(curve)) => Self::Curve(CurveFile::of(curve)),
            _ => Self::Text(section.to_string()),
        }
    }
}

/// A cross-section at the place of a curve nearest to a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProfileAt {
    /// The point, in model units.
    #[schemars(with = "[f64; 3]")]
    pub at: DVec3,
    /// The cross-section there.
    pub profile: Section,
}

impl FromStr for ProfileAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (at, profile) =
            text.split_once('=').ok_or("a profile at a place is X,Y,Z=PROFILE, such as 0,1.5,-2=chamfer")?;
        let profile: Section = profile.parse()?;
        if profile.reach.is_some() {
            return Err("the reach is the same all along: give it with the profile of the whole curve".into());
        }
        Ok(Self { at: point(at)?, profile })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_by_name() {
        let known = |text: &str| match text.parse() {
            Ok(Section { curve: SectionCurve::Known(profile), reach }) => Some((profile, reach)),
            _ => None,
        };
        assert_eq!(known("g2"), Some((Profile::G2, None)));
        assert_eq!(known("conic=0.5"), Some((Profile::Conic(0.5), None)));
        assert_eq!(known("conic=2,reach=2.4"), Some((Profile::Conic(2.0), Some(2.4))));
        assert_eq!("curve.json".parse::<Section>().map(|s| s.curve), Ok(SectionCurve::File("curve.json".into())));
        assert!("arc,reach=0".parse::<Section>().is_err_and(|e| e.contains("radii")));
        for bad in ["", "conic", "conic=", "conic=-1", "conic=nan", "conic=inf", "round"] {
            assert!(bad.parse::<Section>().is_err_and(|e| e.contains("chamfer")), "{bad}");
        }
    }

    #[test]
    fn a_section_survives_json() {
        let cubic = profile_from_text("degree = 3\npoints = [[1, 0], [0.4, 0], [0, 0.4], [0, 1]]").unwrap();
        for section in [cubic.into(), "hermite,reach=1.25".parse().unwrap(), "a/b.toml".parse().unwrap()] {
            let json = serde_json::to_string(&section).unwrap();
            assert_eq!(serde_json::from_str::<Section>(&json).unwrap(), section, "{json}");
        }
    }
}
