//! Even triangles and smooth surfaces.

use super::define::operation;
use super::linked::Files;
use super::option_error::{Check, OptionError, ensure, positive};
use super::options::Options;
use super::region::RegionArg;
use super::smoothing::SmoothMethod;
use super::{Length, Precision};
use crate::remeshing::{self, Params};
use crate::{Error, Outcome, features};
use mesh_core::{Watch, bounds};
use mesh_io::{Format, Model};
use std::ops::RangeInclusive;

/// Rounds of remeshing.
const ROUNDS: RangeInclusive<usize> = 1..=1000;

operation! {
    /// Make triangles even; boundaries and features are kept
    ///
    /// ```
    /// use fusion::operation::{Precision, Remesh};
    /// use fusion::mesh_core::{Watch, shapes};
    /// let ball = shapes::icosphere(1.0, 3).into();
    /// let even = Remesh::default().with_edge_length(0.2).run(&ball, Precision::F64, &Watch::default())?;
    /// assert_eq!(even.report.validity.closed, Some(true));
    /// # Ok::<(), fusion::Error>(())
    /// ```
    pub struct Remesh {
        /// Wanted edge length; without it the triangles stay
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive,
            required_unless_present = "smooth"))]
        edge_length: Option<Length> = None;
        /// Move the vertices first: taubin, taubin=ROUNDS, flow=LENGTH, harmonic, biharmonic or triharmonic
        ///
        /// `taubin` keeps the volume. `flow` halves waves of this length and all but removes shorter ones, shrinking. With the
        /// last three the region becomes the fairest surface that continues what is around it.
        #[cfg_attr(feature = "clap", arg(long, value_name = "METHOD"))]
        smooth: Option<SmoothMethod> = None;
        /// Rounds of splitting, collapsing, flipping and relaxing
        #[schemars(range(min = *ROUNDS.start(), max = *ROUNDS.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "N", default_value_t = Self::default().iterations))]
        iterations: usize = remesh::Params::new(1.0).rounds;
        /// Work on these faces only: near=X,Y,Z,RADIUS, group=NAME, origin=STAGE, or a file of face ids
        #[cfg_attr(feature = "clap", arg(long, value_name = "REGION", allow_hyphen_values = true))]
        region: Option<RegionArg> = None;
        /// Least angle between the normals of two neighbouring faces that makes their edge a feature, in degrees; 180 keeps
        /// none
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 180))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "DEG", default_value_t = Self::default().angle))]
        angle: f64 = features::Params::default().angle;
    }
}

impl Options for Remesh {
    const NAME: &'static str = "remesh";

    fn validate(&self) -> Check {
        ensure(self.edge_length.is_some() || self.smooth.is_some(), "edge_length", || {
            "an edge length or a method of smoothing is needed".into()
        })?;
        self.edge_length.map_or(Ok(()), |l| positive(l, "edge_length"))?;
        if let Some(SmoothMethod::Flow(length)) = self.smooth {
            positive(length, "smooth")?;
        }
        ensure(ROUNDS.contains(&self.iterations), "iterations", || {
            format!("the rounds are from {} to {}", ROUNDS.start(), ROUNDS.end())
        })?;
        self.region.as_ref().map_or(Ok(()), |r| r.check("region"))?;
        ensure(self.angle > 0.0 && self.angle <= 180.0, "angle", || {
            "an angle is a number of degrees above 0, at most 180".into()
        })
    }

    fn load(&mut self, files: &mut dyn Files) -> Check {
        self.region.as_mut().map_or(Ok(()), |r| r.load("region", files))
    }
}

impl Remesh {
    /// Smooths and remeshes a surface, or a region of it; lengths may be a share of its diagonal.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`remesh()`](crate::remesh()).
    pub fn run(&self, part: &Model, precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        remeshing::remesh(part, &self.params(bounds(&part.mesh).diagonal(), precision.into())?, watch)
    }

    /// The same for [`remesh()`](crate::remesh()), with lengths in model units; `diagonal` is what they may be a share of.
    ///
    /// # Errors
    /// As [`Options::validate`], and for files that have not been read.
    pub fn params(&self, diagonal: f64, format: Format) -> Result<Params, OptionError> {
        self.validate()?;
        let rounds = self.iterations;
        let remesh = self.edge_length.map(|l| remesh::Params { rounds, ..remesh::Params::new(l.resolve(diagonal)) });
        Ok(Params {
            smooth: self.smooth.map(|method| method.resolve(diagonal)),
            remesh,
            feature_angle: self.angle,
            region: self.region.as_ref().map(|r| r.resolve("region", diagonal)).transpose()?,
            format,
        })
    }
}
