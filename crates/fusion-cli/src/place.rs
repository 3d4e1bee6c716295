//! Regions as they are typed.

use crate::failure::Failure;
use crate::length::{Length, point};
use crate::text_file::read_text;
use fusion::Region;
use fusion::mesh_core::FaceId;
use glam::DVec3;
use std::path::PathBuf;
use std::str::FromStr;

/// A region as it is typed: `near=x,y,z,radius`, `group=NAME`, `origin=STAGE`, or a file of face ids.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Around a point; the radius may be a share of the diagonal.
    Near(DVec3, Length),
    /// A named group.
    Group(String),
    /// What a stage made.
    Origin(String),
    /// Face ids from 0, apart by spaces, commas or lines.
    File(PathBuf),
}

impl FromStr for Place {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some(("near", rest)) => {
                let (center, radius) = rest.rsplit_once(',').ok_or("a place is near=X,Y,Z,RADIUS")?;
                Ok(Self::Near(point(center)?, radius.parse()?))
            }
            Some(("group", name)) => Ok(Self::Group(name.into())),
            Some(("origin", stage)) => Ok(Self::Origin(stage.into())),
            _ if text.is_empty() => Err("a region is near=X,Y,Z,RADIUS, group=NAME, origin=STAGE, or a file".into()),
            _ => Ok(Self::File(text.into())),
        }
    }
}

impl Place {
    /// The region, with lengths in model units and face ids read.
    pub fn resolve(&self, diagonal: f64) -> Result<Region, Failure> {
        Ok(match self {
            Self::Near(center, radius) => Region::Near { center: *center, radius: radius.resolve(diagonal) },
            Self::Group(name) => Region::Group(name.clone()),
            Self::Origin(stage) => Region::Origin(stage.clone()),
            Self::File(path) => Region::Faces(read_text(path, |text| {
                let words = text.split(|c: char| c.is_whitespace() || ",[]".contains(c)).filter(|w| !w.is_empty());
                let id = |w: &str| w.parse().map(FaceId).map_err(|_| format!("{w:?} is no face id"));
                words.map(id).collect::<Result<_, _>>()
            })?),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_places_names_or_files() {
        assert_eq!("near=1,-2,3,5%".parse(), Ok(Place::Near(DVec3::new(1.0, -2.0, 3.0), Length::OfDiagonal(0.05))));
        assert_eq!("group=a=b".parse(), Ok(Place::Group("a=b".into())));
        assert_eq!("origin=blend".parse(), Ok(Place::Origin("blend".into())));
        assert_eq!("faces.txt".parse(), Ok(Place::File("faces.txt".into())));
        for bad in ["", "near=1,2,3", "near=1,2,x,4", "near=1,2,3,-4"] {
            assert!(bad.parse::<Place>().is_err(), "{bad}");
        }
    }
}
