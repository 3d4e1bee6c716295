//! Fillets taken back to edges.

use super::define::operation;
use super::option_error::{Check, OptionError, ensure, finite, positive};
use super::options::Options;
use super::{Length, Precision};
use crate::{Error, Outcome, features, sharpen};
use glam::DVec3;
use mesh_core::{Watch, bounds};
use mesh_io::{Format, Model};

operation! {
    /// Take fillets back to edges
    ///
    /// ```
    /// use fusion::operation::{Blend, Precision, Sharpen};
    /// use fusion::mesh_core::{Watch, shapes, volume};
    /// use glam::DVec3;
    /// let blend = Blend::default().with_radius(0.2).with_near(vec![DVec3::new(0.5, 0.5, 0.0).into()]);
    /// let round = blend.run(&shapes::cuboid(DVec3::ONE).into(), Precision::F64, &Watch::default())?;
    /// let sharpen = Sharpen::default().with_near(vec![DVec3::new(0.45, 0.45, 0.0)]);
    /// let sharp = sharpen.run(&round.model, Precision::F64, &Watch::default())?;
    /// assert!((volume(&sharp.model.mesh) - 1.0).abs() < 1e-12);
    /// # Ok::<(), fusion::Error>(())
    /// ```
    pub struct Sharpen {
        /// A point on the fillet; may be given more than once
        #[schemars(with = "Vec<[f64; 3]>")]
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z", value_parser = super::place::point,
            allow_hyphen_values = true, required = true))]
        near: Vec<DVec3> = vec![];
        /// What is rounded by this radius or less is taken back; as it is rounded at each point where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "R", value_parser = Length::positive))]
        radius: Option<Length> = None;
        /// Least angle between the normals of two neighbouring faces that makes their edge a crease, at which fillets end, in
        /// degrees
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "DEG", default_value_t = Self::default().angle))]
        angle: f64 = features::Params::default().angle;
    }
}

impl Options for Sharpen {
    const NAME: &'static str = "sharpen";

    fn validate(&self) -> Check {
        ensure(!self.near.is_empty(), "near", || "a point on a fillet is needed".into())?;
        self.near.iter().try_for_each(|&p| finite(p, "near"))?;
        self.radius.map_or(Ok(()), |r| positive(r, "radius"))?;
        ensure(self.angle > 0.0 && self.angle < 180.0, "angle", || {
            "an angle is a number of degrees between 0 and 180".into()
        })
    }
}

impl Sharpen {
    /// Takes the fillets of a solid back; lengths may be a share of its diagonal.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`sharpen()`](crate::sharpen()).
    pub fn run(&self, part: &Model, precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        sharpen::sharpen(part, &self.params(bounds(&part.mesh).diagonal(), precision.into())?, watch)
    }

    /// The same for [`sharpen()`](crate::sharpen()), with lengths in model units; `diagonal` is what they may be a share of.
    ///
    /// # Errors
    /// As [`Options::validate`].
    pub fn params(&self, diagonal: f64, format: Format) -> Result<sharpen::Params, OptionError> {
        self.validate()?;
        let radius = self.radius.map(|r| r.resolve(diagonal));
        Ok(sharpen::Params { near: self.near.clone(), radius, angle: self.angle, format })
    }
}
