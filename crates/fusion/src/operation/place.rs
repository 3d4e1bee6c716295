//! Points and directions, and what is given at a point.

use super::length::Length;
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// A point or direction from text, `x,y,z`.
///
/// # Errors
/// A sentence that says what is right.
pub fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 && DVec3::new(x, y, z).is_finite() => Ok(DVec3::new(x, y, z)),
        _ => Err("a point is three finite numbers, such as 0,1.5,-2".into()),
    }
}

/// A direction of length 1 from text: a point other than the origin.
///
/// # Errors
/// A sentence that says what is right.
pub fn direction(text: &str) -> Result<DVec3, String> {
    let d = point(text)?;
    d.try_normalize().ok_or_else(|| "a direction must not be 0,0,0".into())
}

/// A point that names the feature curve nearest to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "PointOrNear", into = "PointOrNear")]
#[schemars(with = "PointOrNear")]
pub struct Near {
    /// The point, in model units.
    pub at: DVec3,
    /// The radius of that curve, if it is its own.
    pub radius: Option<Length>,
}

/// How a [`Near`] is written in documents.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a point is three numbers, or a table of `at` and `radius`")]
#[schemars(title = "x, y, z, or a table of `at` and `radius`")]
enum PointOrNear {
    Point(#[schemars(with = "[f64; 3]")] DVec3),
    Near(RadiusAt),
}

impl From<PointOrNear> for Near {
    fn from(written: PointOrNear) -> Self {
        match written {
            PointOrNear::Point(at) => at.into(),
            PointOrNear::Near(RadiusAt { at, radius }) => Self { at, radius: Some(radius) },
        }
    }
}

impl From<Near> for PointOrNear {
    fn from(Near { at, radius }: Near) -> Self {
        radius.map_or(Self::Point(at), |radius| Self::Near(RadiusAt { at, radius }))
    }
}

impl From<DVec3> for Near {
    fn from(at: DVec3) -> Self {
        Self { at, radius: None }
    }
}

impl FromStr for Near {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some(_) => text.parse().map(|RadiusAt { at, radius }| Self { at, radius: Some(radius) }),
            None => point(text).map(Self::from),
        }
    }
}

/// A radius at the place of a curve nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadiusAt {
    /// The point, in model units.
    #[schemars(with = "[f64; 3]")]
    pub at: DVec3,
    /// The radius there.
    pub radius: Length,
}

impl FromStr for RadiusAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (at, radius) = text.split_once('=').ok_or("a radius at a place is X,Y,Z=R, such as 0,1.5,-2=0.25")?;
        Ok(Self { at: point(at)?, radius: Length::positive(radius)? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_have_three_finite_numbers() {
        assert_eq!(point("0, 1.5,-2"), Ok(DVec3::new(0.0, 1.5, -2.0)));
        for bad in ["1,2", "1,2,3,4", "1,2,", "1,x,3", "1,2,inf", ""] {
            assert!(point(bad).is_err(), "{bad}");
        }
        assert!(direction("0,0,0").is_err());
    }

    #[test]
    fn a_place_may_have_a_radius() {
        let near: Near = "1,0,0=2%".parse().unwrap();
        assert_eq!(near, Near { at: DVec3::X, radius: Some(Length::OfDiagonal(0.02)) });
        let read = |json: &str| serde_json::from_str::<Near>(json).unwrap();
        assert_eq!(read("[1, 0, 0]"), DVec3::X.into());
        assert_eq!(read(&serde_json::to_string(&near).unwrap()), near);
    }
}
