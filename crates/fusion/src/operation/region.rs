//! Regions of a surface, as options name them.

use super::length::Length;
use super::linked::Files;
use super::option_error::{Check, OptionError, ensure, finite, positive};
use super::place::point;
use crate::Region;
use glam::DVec3;
use mesh_core::FaceId;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::str::FromStr;

/// A region: `near=x,y,z,radius`, `group=NAME`, `origin=STAGE`, or a file of face ids.
///
/// ```
/// use fusion::operation::RegionArg;
/// let cap: RegionArg = "near=0,0,1,5%".parse()?;
/// assert_eq!(serde_json::to_string(&cap).unwrap(), r#"{"near":[0.0,0.0,1.0],"radius":"5%"}"#);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "a region is near and radius (above 0), or group, or origin, or faces, or a path"
)]
#[schemars(title = "region")]
pub enum RegionArg {
    /// The faces around the surface point nearest to a point.
    Near {
        /// The point, in model units.
        #[schemars(with = "[f64; 3]")]
        near: DVec3,
        /// How far the region reaches.
        radius: Length,
    },
    /// The faces of a group.
    Group {
        /// Its name.
        group: String,
    },
    /// What a stage made.
    Origin {
        /// The stage.
        origin: String,
    },
    /// These faces.
    Faces {
        /// Their ids, from 0.
        faces: Vec<u32>,
    },
    /// The faces in this file: ids apart by spaces, commas or lines.
    File(PathBuf),
}

impl FromStr for RegionArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some(("near", rest)) => {
                let (near, radius) = rest.rsplit_once(',').ok_or("a place is near=X,Y,Z,RADIUS")?;
                Ok(Self::Near { near: point(near)?, radius: radius.parse()? })
            }
            Some(("group", name)) => Ok(Self::Group { group: name.into() }),
            Some(("origin", stage)) => Ok(Self::Origin { origin: stage.into() }),
            _ if text.is_empty() => Err("a region is near=X,Y,Z,RADIUS, group=NAME, origin=STAGE, or a file".into()),
            _ => Ok(Self::File(text.into())),
        }
    }
}

impl RegionArg {
    pub(super) fn check(&self, option: &'static str) -> Check {
        match self {
            Self::Near { near, radius } => finite(*near, option).and_then(|()| positive(*radius, option)),
            Self::Group { group: name } | Self::Origin { origin: name } => {
                ensure(!name.is_empty(), option, || "a name is needed".into())
            }
            Self::Faces { .. } | Self::File(_) => Ok(()),
        }
    }

    pub(super) fn load(&mut self, option: &'static str, files: &mut dyn Files) -> Check {
        let Self::File(path) = self else { return Ok(()) };
        let text = files.text(path).map_err(|e| OptionError::new(option, e))?;
        let ids = text.split(|c: char| c.is_whitespace() || ",[]".contains(c)).filter(|id| !id.is_empty());
        let wrong = |id: &str| OptionError::new(option, format!("{}: {id:?} is no face id", path.display()));
        let faces = ids.map(|id| id.parse().map_err(|_| wrong(id))).collect::<Result<_, _>>()?;
        *self = Self::Faces { faces };
        Ok(())
    }

    /// The region with lengths in model units.
    pub(super) fn resolve(&self, option: &'static str, diagonal: f64) -> Result<Region, OptionError> {
        Ok(match self {
            Self::Near { near, radius } => Region::Near { center: *near, radius: radius.resolve(diagonal) },
            Self::Group { group } => Region::Group(group.clone()),
            Self::Origin { origin } => Region::Origin(origin.clone()),
            Self::Faces { faces } => Region::Faces(faces.iter().map(|&f| FaceId(f)).collect()),
            Self::File(path) => {
                return Err(OptionError::new(option, format!("{} has not been read", path.display())));
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_places_names_or_files() {
        let near = RegionArg::Near { near: DVec3::new(1.0, -2.0, 3.0), radius: Length::OfDiagonal(0.05) };
        assert_eq!("near=1,-2,3,5%".parse(), Ok(near.clone()));
        assert_eq!("group=a=b".parse(), Ok(RegionArg::Group { group: "a=b".into() }));
        assert_eq!("origin=blend".parse(), Ok(RegionArg::Origin { origin: "blend".into() }));
        assert_eq!("faces.txt".parse(), Ok(RegionArg::File("faces.txt".into())));
        for bad in ["", "near=1,2,3", "near=1,2,x,4", "near=1,2,3,-4"] {
            assert!(bad.parse::<RegionArg>().is_err(), "{bad}");
        }
        assert_eq!(serde_json::from_str::<RegionArg>(&serde_json::to_string(&near).unwrap()).unwrap(), near);
    }
}
