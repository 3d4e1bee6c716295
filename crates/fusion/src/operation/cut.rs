//! Cuts by planes and by paths over the surface.

use super::Precision;
use super::define::{operation, words};
use super::option_error::{Check, OptionError, ensure, finite, within};
use super::options::Options;
use crate::cut::{self, Keep, Params, PathCut, PlaneCut};
use crate::{Error, Outcome};
use glam::DVec3;
use mesh_core::Watch;
use mesh_io::{Format, Model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Attractions of creases.
const CREASE: RangeInclusive<f64> = 0.0..=1e3;
/// Shares of an edge by which crossings are moved onto vertices.
const SNAP: RangeInclusive<f64> = 0.0..=0.25;

/// A plane; what its normal points to is removed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of it, in model units.
    #[schemars(with = "[f64; 3]")]
    pub point: DVec3,
    /// Its normal, of any length.
    #[schemars(with = "[f64; 3]")]
    pub normal: DVec3,
}

impl Plane {
    fn is_one(&self) -> bool {
        self.point.is_finite() && self.normal.is_finite() && self.normal != DVec3::ZERO
    }
}

const PLANE: &str = "a plane is a finite point and a normal other than 0,0,0, such as 0,0,1.5,0,0,1";

impl FromStr for Plane {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Vec<f64> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
        if numbers.len() != 6 || text.split(',').count() != 6 {
            return Err(PLANE.into());
        }
        let plane = Self { point: DVec3::from_slice(&numbers), normal: DVec3::from_slice(&numbers[3..]) };
        if plane.is_one() { Ok(plane) } else { Err(PLANE.into()) }
    }
}

words! {
    /// A side of a path.
    pub enum Side: "a side" {
        /// The one with more area
        Larger = "larger",
        /// The one with less
        Smaller = "smaller",
    }
}

operation! {
    /// Take away what lies beyond a plane or a path over the surface, leaving a clean opening
    ///
    /// ```
    /// use fusion::operation::{Cut, Plane, Precision};
    /// use fusion::mesh_core::{Watch, shapes};
    /// use glam::DVec3;
    /// let cut = Cut::default().with_plane(Plane { point: DVec3::ZERO, normal: DVec3::Z });
    /// let half = cut.run(&shapes::icosphere(1.0, 3).into(), Precision::F64, &Watch::default())?;
    /// assert_eq!(half.report.figures["rims"], 1.0);
    /// # Ok::<(), fusion::Error>(())
    /// ```
    pub struct Cut {
        /// A point of the plane and its normal; the side the normal points away from is kept
        #[cfg_attr(feature = "clap", arg(long, value_name = "PX,PY,PZ,NX,NY,NZ", allow_hyphen_values = true))]
        plane: Option<Plane> = None;
        /// Cut along a closed path over the surface through these points, two or more, in concave creases where there are any
        #[schemars(with = "Vec<[f64; 3]>")]
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z", value_parser = super::place::point,
            allow_hyphen_values = true, required_unless_present = "plane", conflicts_with = "plane"))]
        path: Vec<DVec3> = vec![];
        /// Which side of the path stays
        #[cfg_attr(feature = "clap", arg(long, value_name = "SIDE", default_value_t = Side::Larger, requires = "path",
            conflicts_with = "seed"))]
        keep: Side = Side::Larger;
        /// How strongly creases attract the path; 0 gives the geodesic
        #[schemars(range(min = *CREASE.start(), max = *CREASE.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "STRENGTH", default_value_t = Self::default().crease,
            requires = "path"))]
        crease: f64 = PathCut::new(vec![]).crease;
        /// With a plane, cut only the contour nearest this point; with a path, keep the side nearest to it
        #[schemars(with = "Option<[f64; 3]>")]
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z", value_parser = super::place::point,
            allow_hyphen_values = true))]
        seed: Option<DVec3> = None;
        /// Move crossings onto vertices nearer than this share of an edge, which gives openings without short edges; 1e-6
        /// where left out, 0.05 for a path
        #[schemars(range(min = *SNAP.start(), max = *SNAP.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE"))]
        snap: Option<f64> = None;
        /// Rounds by which the boundary loop is made smooth on the surface
        #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = Self::default().smooth))]
        smooth: u16 = 0;
    }
}

impl Options for Cut {
    const NAME: &'static str = "cut";

    fn validate(&self) -> Check {
        ensure(self.plane.is_some() == self.path.is_empty(), "plane", || {
            "a cut needs either a plane or a path".into()
        })?;
        ensure(self.plane.is_none_or(|p| p.is_one()), "plane", || PLANE.into())?;
        self.path.iter().try_for_each(|&p| finite(p, "path"))?;
        self.seed.map_or(Ok(()), |p| finite(p, "seed"))?;
        within(self.crease, &CREASE, "crease", "the attraction is a number")?;
        self.snap.map_or(Ok(()), |s| within(s, &SNAP, "snap", "a share of an edge is a number"))
    }
}

impl Cut {
    /// Cuts a mesh, closed or open.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`cut()`](crate::cut()).
    pub fn run(&self, part: &Model, precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        cut::cut(part, &self.params(precision.into())?, watch)
    }

    /// The same for [`cut()`](crate::cut()).
    ///
    /// # Errors
    /// As [`Options::validate`].
    pub fn params(&self, format: Format) -> Result<Params, OptionError> {
        Ok(Params::new(vec![self.cut()?], format))
    }

    /// One of several cuts.
    pub(crate) fn cut(&self) -> Result<cut::Cut, OptionError> {
        self.validate()?;
        let smooth = usize::from(self.smooth);
        if let Some(Plane { point, normal }) = self.plane {
            let made = PlaneCut::new(point, normal);
            return Ok(PlaneCut { seed: self.seed, snap: self.snap.unwrap_or(made.snap), smooth, ..made }.into());
        }
        let made = PathCut::new(self.path.clone());
        let keep = match (self.seed, self.keep) {
            (Some(seed), _) => Keep::Near(seed),
            (None, Side::Larger) => Keep::Larger,
            (None, Side::Smaller) => Keep::Smaller,
        };
        let snap = self.snap.unwrap_or(made.snap);
        Ok(PathCut { keep, crease: self.crease, snap, smooth, ..made }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_have_six_finite_numbers() {
        let plane = Plane { point: DVec3::new(0.0, 1.0, 2.0), normal: DVec3::new(0.0, 0.0, -3.0) };
        assert_eq!("0,1,2, 0,0,-3".parse(), Ok(plane));
        for bad in ["0,0,0,0,0,0", "0,0,1", "0,0,0,0,0,1,2", "0,0,0,0,0,nan", ""] {
            assert!(bad.parse::<Plane>().is_err(), "{bad}");
        }
    }

    #[test]
    fn a_cut_has_a_plane_or_a_path() {
        let path = vec![DVec3::ZERO, DVec3::X];
        let plane = Plane { point: DVec3::ZERO, normal: DVec3::Z };
        for (cut, option) in [
            (Cut::default(), "plane"),
            (Cut::default().with_plane(plane).with_path(path.clone()), "plane"),
            (Cut::default().with_path(path.clone()).with_snap(0.5), "snap"),
            (Cut::default().with_path(path.clone()).with_crease(-1.0), "crease"),
        ] {
            assert_eq!(cut.validate().map_err(|e| e.option), Err(option), "{cut:?}");
        }
        assert!(Cut::default().with_path(path).params(Format::Off).is_ok());
    }
}
