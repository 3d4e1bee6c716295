//! Union, difference and intersection, with fillets along their seams.

use super::define::{operation, words};
use super::linked::Files;
use super::option_error::{Check, OptionError, finite, positive};
use super::options::Options;
use super::rolling::{self, Overlap, Rolling, Spine, Surface};
use super::section::{ProfileAt, Section};
use super::{Length, Precision, Radius, RadiusAt};
use crate::blend::Limit;
use crate::{Error, Outcome, join};
use glam::DVec3;
use mesh_core::{Bounds, Watch, bounds};
use mesh_io::{Format, Model};

words! {
    /// Which points the result of a boolean holds.
    pub enum SetOperation: "an operation" {
        /// Those of any solid
        Union = "union",
        /// Those of the first solid alone
        Difference = "difference",
        /// Those that all solids share
        Intersection = "intersection",
    }
}

impl From<SetOperation> for tri_intersect::Operation {
    fn from(operation: SetOperation) -> Self {
        match operation {
            SetOperation::Union => Self::Union,
            SetOperation::Difference => Self::Difference,
            SetOperation::Intersection => Self::Intersection,
        }
    }
}

operation! {
    [rolling]
    /// Join solids, and fillet the seams with a rolling ball
    ///
    /// ```
    /// use fusion::operation::{Boolean, Length, Precision};
    /// use fusion::mesh_core::{Watch, shapes};
    /// let cube = shapes::cuboid(glam::DVec3::ONE);
    /// let moved = shapes::posed(cube.clone(), glam::DQuat::IDENTITY, glam::DVec3::splat(0.5));
    /// let union = Boolean::default().with_radius(Length::OfDiagonal(0.02));
    /// let both = union.run(&[cube.into(), moved.into()], Precision::F64, &Watch::default())?;
    /// assert_eq!(both.report.validity.closed, Some(true));
    /// # Ok::<(), fusion::Error>(())
    /// ```
    #[cfg_attr(feature = "clap", command(group(clap::ArgGroup::new("ball").multiple(true))))]
    pub struct Boolean {
        /// Which points the result holds
        #[cfg_attr(feature = "clap", arg(skip = SetOperation::Union))]
        operation: SetOperation = SetOperation::Union;
        /// Blend the seams with a ball of this radius; with `R1,R2` its centre keeps R1 from the first part and R2 from the
        /// other
        #[cfg_attr(feature = "clap", arg(long, value_name = "R[,R2]", group = "ball"))]
        radius: Option<Radius> = None;
        /// Blend only the seam nearest this point; may be given more than once
        #[schemars(with = "Vec<[f64; 3]>")]
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z", value_parser = super::place::point,
            allow_hyphen_values = true, help_heading = "Which seams"))]
        near: Vec<DVec3> = vec![];
        /// Blend only seams longer than this
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive,
            help_heading = "Which seams"))]
        longer: Option<Length> = None;
    }
}

impl Options for Boolean {
    const NAME: &'static str = "boolean";

    fn validate(&self) -> Check {
        self.radius.iter().flat_map(|r| r.sides()).try_for_each(|r| positive(r, "radius"))?;
        self.near.iter().try_for_each(|&p| finite(p, "near"))?;
        self.longer.map_or(Ok(()), |l| positive(l, "longer"))?;
        Rolling::from(self).check()
    }

    fn load(&mut self, files: &mut dyn Files) -> Check {
        rolling::load(&mut self.profile, &mut self.profile_at, files)
    }
}

impl Boolean {
    /// Joins solids in order; each seam is blended before the next solid is joined. Lengths may be a share of the diagonal of
    /// the box around all.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`join()`](crate::join()).
    pub fn run(&self, parts: &[Model], precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        join::join(parts, &self.params(joint_diagonal(parts), precision.into())?, watch)
    }

    /// The largest radius at which the chosen seams can be blended; see [`join::max_radius`].
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn max_radius(&self, parts: &[Model], watch: &Watch) -> Result<Limit, Error> {
        join::max_radius(parts, &self.params(joint_diagonal(parts), Format::Obj)?, watch)
    }

    /// The same for [`join()`](crate::join()), with lengths in model units; `diagonal` is what they may be a share of.
    ///
    /// # Errors
    /// As [`Self::validate`], and for files that have not been read.
    pub fn params(&self, diagonal: f64, format: Format) -> Result<join::Params, OptionError> {
        self.validate()?;
        let blend = self.radius.map(|r| Rolling::from(self).params(r.sides(), diagonal)).transpose()?;
        let seams = join::SeamChoice { near: self.near.clone(), longer: self.longer.map(|l| l.resolve(diagonal)) };
        Ok(join::Params { operation: self.operation.into(), blend, seams, format })
    }
}

/// The diagonal of the box around all inputs as posed.
fn joint_diagonal(parts: &[Model]) -> f64 {
    parts.iter().map(|m| bounds(&m.mesh)).fold(Bounds::EMPTY, Bounds::union).diagonal()
}
