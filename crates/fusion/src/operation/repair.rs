//! Meshes made solids.

use super::define::{operation, words};
use super::option_error::{Check, OptionError, ensure};
use super::options::Options;
use super::{Length, Precision};
use crate::repair::{self, Params, Step};
use crate::{Error, Outcome};
use mesh_core::{Watch, bounds};
use mesh_io::{Format, Model};

/// The share of the diagonal up to which cracks are closed: two hundred times the rounding of 32-bit coordinates.
const GAP: f64 = 1e-5;

words! {
    /// What becomes of holes.
    pub enum Holes: "a way with holes" {
        /// A result that has any is refused
        Refuse = "refuse",
        /// They are filled one by one with smooth surfaces; a result with one that cannot be is refused
        Fill = "fill",
        /// They stay
        Keep = "keep",
    }
}

words! {
    /// A step of a repair.
    pub enum RepairStep: "a step" {
        /// Merge vertices at the same place
        Weld = "weld",
        /// Take out faces without area
        Flat = "flat",
        /// Drop faces that repeat another
        Duplicates = "duplicates",
        /// Close cracks
        Cracks = "cracks",
        /// Turn faces so that neighbours agree
        Orient = "orient",
        /// Take apart what hangs together by an edge or a vertex alone
        Split = "split",
    }
}

operation! {
    /// Make a mesh a solid: weld, orient, split, drop what has no area, close cracks, fill holes
    ///
    /// ```
    /// use fusion::operation::{Precision, Repair};
    /// use fusion::mesh_core::{Faces, TriMesh, Watch, shapes, volume};
    /// // Every triangle with corners of its own, one turned over.
    /// let cube = shapes::cuboid(glam::DVec3::ONE);
    /// let corners = cube.face_ids().flat_map(|f| cube.triangle(f)).collect();
    /// let mut soup = TriMesh::from_arrays(corners, (0..12).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]));
    /// soup.faces[5].swap(0, 1);
    /// let solid = Repair::default().run(&soup.into(), Precision::F64, &Watch::default())?;
    /// assert_eq!(solid.report.validity.closed, Some(true));
    /// assert!((volume(&solid.model.mesh) - 1.0).abs() < 1e-12);
    /// # Ok::<(), fusion::Error>(())
    /// ```
    pub struct Repair {
        /// Merge vertices no further apart than this; 0 merges those at the same place
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", default_value_t = Self::default().weld))]
        weld: Length = Length::Units(0.0);
        /// Close cracks up to this width: boundary edges that nearly coincide become one
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", default_value_t = Self::default().gap))]
        gap: Length = Length::OfDiagonal(GAP);
        /// Drop components whose bounding box has a diagonal below this
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive))]
        specks: Option<Length> = None;
        /// What becomes of holes
        #[cfg_attr(feature = "clap", arg(long, value_name = "HOLES", default_value_t = Self::default().holes))]
        holes: Holes = Holes::Refuse;
        /// Leave out this step; may be given more than once
        #[cfg_attr(feature = "clap", arg(long, value_name = "STEP"))]
        skip: Vec<RepairStep> = vec![];
    }
}

impl Options for Repair {
    const NAME: &'static str = "repair";

    fn validate(&self) -> Check {
        let lengths = [(Some(self.weld), "weld"), (Some(self.gap), "gap"), (self.specks, "specks")];
        lengths.into_iter().try_for_each(|(length, option)| {
            let number = length.map_or(0.0, Length::number);
            ensure(number >= 0.0 && number.is_finite(), option, || {
                "a length is a number, not negative, or a share of the diagonal such as \"2%\"".into()
            })
        })
    }
}

impl Repair {
    /// Repairs a mesh; lengths may be a share of its diagonal.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`repair::repair`].
    pub fn run(&self, part: &Model, precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        repair::repair(part, &self.params(bounds(&part.mesh).diagonal(), precision.into())?, watch)
    }

    /// The same for [`repair::repair`], with lengths in model units; `diagonal` is what they may be a share of.
    ///
    /// # Errors
    /// As [`Options::validate`].
    pub fn params(&self, diagonal: f64, format: Format) -> Result<Params, OptionError> {
        self.validate()?;
        // A vertex at infinity leaves no diagonal to have a share of.
        let resolve = |length: Length| Some(length.resolve(diagonal)).filter(|l| l.is_finite()).unwrap_or(0.0);
        let wanted = |name: RepairStep, step: Step| (!self.skip.contains(&name)).then_some(step);
        let clean = || [wanted(RepairStep::Flat, Step::Flat), wanted(RepairStep::Duplicates, Step::Duplicates)];
        let mut steps = vec![Some(Step::Unusable), Some(Step::Unused)];
        steps.push(wanted(RepairStep::Weld, Step::Weld(resolve(self.weld))));
        steps.extend(clean());
        steps.push(self.specks.map(|size| Step::Specks(resolve(size))));
        steps.push(wanted(RepairStep::Cracks, Step::Cracks(resolve(self.gap))));
        // Closed cracks may have left faces without area, or twice.
        steps.extend(clean());
        steps.push(wanted(RepairStep::Orient, Step::Orient));
        steps.push(wanted(RepairStep::Split, Step::Split));
        steps.push((self.holes == Holes::Fill).then_some(Step::Holes));
        // Self-crossings are told, not resolved: that would need the closed and oriented surface that there is now.
        steps.push(Some(Step::Unused));
        let holes = if self.holes == Holes::Keep { repair::Holes::Kept } else { repair::Holes::Refused };
        Ok(Params { steps: steps.into_iter().flatten().collect(), holes, format })
    }
}
