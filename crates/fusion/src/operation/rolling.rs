//! The options of the rolling ball, which blends and booleans share.

use super::define::words;
use super::linked::Files;
use super::option_error::{Check, OptionError, ensure, finite, positive, within};
use super::section::{ProfileAt, REACH, Section};
use super::{Length, RadiusAt};
use crate::blend::{self, Params, Radii};
use spine::{OffsetParams, Solver};
use std::ops::RangeInclusive;

/// Reaches of the base patches, in radii.
pub(super) const ALPHA: RangeInclusive<f64> = 1.0..=16.0;
/// Chord tolerances, as shares of the radius.
pub(super) const TOLERANCE: RangeInclusive<f64> = 1e-6..=0.5;

words! {
    /// What to do where a ball of the full radius does not fit.
    pub enum Overlap: "an overlap" {
        /// Keep the radius and put in the envelope of all balls that fit, with a smaller radius along a whole curve or none
        /// as the last resort
        Full = "full",
        /// Use a smaller radius there and fade into the full one
        Shrink = "shrink",
        /// Stop with the place and a radius that works
        Error = "error",
        not "trim": "`full`, the default, stands for the former `trim`",
    }
}

words! {
    /// How the surface is put in.
    pub enum Surface: "a surface" {
        /// Stitch, and take the field where that fails
        Auto = "auto",
        /// Cut along the ball's contact curves and sew in the sweep
        Stitch = "stitch",
        /// Cut along level sets and draw what is between onto the balls, which cannot fold
        Field = "field",
        /// Move the mesh's own vertices onto the sweep, all faces kept
        Keep = "keep",
    }
}

words! {
    /// What finds the path of the ball's centre.
    pub enum Spine: "a spine" {
        /// Newton on closest points, exact on the mesh
        Contact = "contact",
        /// The crossing of the two sides moved by the radius, off by the sagitta of the facets
        Offset = "offset",
    }
}

/// Hands the shared options to `operation!`, behind what it is given.
macro_rules! with_rolling_options {
    ($given:tt) => {
        $crate::operation::define::operation! {
            $given
            /// Cross-section of the blend: arc, g2 (curvature-continuous), chamfer, sharp, hermite, conic=W, or a file
            ///
            /// The apex of `conic=W` weighs W times that of the arc: below 1 flatter, above 1 sharper. A file holds a NURBS
            /// curve (docs/keep.md). With `,reach=R` behind it the apex is moved out to R radii from the ball's centre.
            #[cfg_attr(feature = "clap", arg(long, value_name = "PROFILE", help_heading = "Blend options",
                default_value_t, requires = "ball"))]
            profile: Section = Section::default();
            /// Distance of the cross-section's apex from the ball's centre, in radii, where it is moved out along its line
            #[schemars(range(min = *$crate::operation::section::REACH.start(), max = *$crate::operation::section::REACH.end()))]
            #[cfg_attr(feature = "clap", arg(long, hide_short_help = true, value_name = "RADII", help_heading = "Blend options", requires = "ball"))]
            reach: Option<f64> = None;
            /// Radius at the place of a curve nearest to X,Y,Z; may be given more than once
            ///
            /// Between such places it changes smoothly, to the radius of the whole at the ends of an open curve and half-way
            /// round a closed one with a single place.
            #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z=R", help_heading = "Blend options",
                requires = "ball", allow_hyphen_values = true))]
            radius_at: Vec<RadiusAt> = vec![];
            /// Cross-section at the place of a curve nearest to X,Y,Z; may be given more than once
            ///
            /// Between such places, and to the profile of the whole at the ends of an open curve and half-way round a closed
            /// one with a single place, one changes smoothly into the other.
            #[cfg_attr(feature = "clap", arg(long, hide_short_help = true, value_name = "X,Y,Z=PROFILE", help_heading = "Blend options",
                requires = "ball", allow_hyphen_values = true))]
            profile_at: Vec<ProfileAt> = vec![];
            /// What to do where a ball of the full radius does not fit
            #[cfg_attr(feature = "clap", arg(long, value_name = "OVERLAP", help_heading = "Blend options",
                default_value_t = Overlap::Full, requires = "ball"))]
            overlap: Overlap = Overlap::Full;
            /// How the surface is put in
            #[cfg_attr(feature = "clap", arg(long, value_name = "SURFACE", help_heading = "Blend options",
                default_value_t = Surface::Auto, requires = "ball"))]
            surface: Surface = Surface::Auto;
            /// Largest distance of the blend's chords from its cross-section, as a share of the radius
            #[schemars(range(min = *$crate::operation::rolling::TOLERANCE.start(), max = *$crate::operation::rolling::TOLERANCE.end()))]
            #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", help_heading = "Blend options",
                default_value_t = Self::default().tolerance, requires = "ball"))]
            tolerance: f64 = rolling_blend::Params::new(1.0).tolerance;
            /// What finds the path of the ball's centre
            #[cfg_attr(feature = "clap", arg(long, value_name = "SPINE", help_heading = $crate::operation::VARIANTS,
                hide_short_help = true, default_value_t = Spine::Contact, requires = "ball"))]
            spine: Spine = Spine::Contact;
            /// Least reach of the two sides the ball rolls on, in radii; grows where more is needed
            #[schemars(range(min = *$crate::operation::rolling::ALPHA.start(), max = *$crate::operation::rolling::ALPHA.end()))]
            #[cfg_attr(feature = "clap", arg(long, value_name = "RADII", help_heading = $crate::operation::VARIANTS,
                hide_short_help = true, default_value_t = Self::default().alpha, requires = "ball"))]
            alpha: f64 = rolling_blend::Params::new(1.0).alpha;
            /// Blend on the coarsest level of a decimation hierarchy that is fine enough for the radius, and put the finer
            /// levels' details back; needs the surface `keep`
            #[cfg_attr(feature = "clap", arg(long, help_heading = $crate::operation::VARIANTS, hide_short_help = true,
                requires_all = ["ball", "surface"]))]
            multiresolution: bool = false;
        }
    };
}
pub(crate) use with_rolling_options;

/// The shared options of one operation.
pub(crate) struct Rolling {
    pub profile: Section,
    pub reach: Option<f64>,
    pub radius_at: Vec<RadiusAt>,
    pub profile_at: Vec<ProfileAt>,
    pub overlap: Overlap,
    pub surface: Surface,
    pub tolerance: f64,
    pub spine: Spine,
    pub alpha: f64,
    pub multiresolution: bool,
}

/// Most levels of a hierarchy, each of about two thirds of the vertices of the one before.
const LEVELS: usize = 6;

impl Rolling {
    pub(super) fn check(&self) -> Check {
        self.profile.check("profile")?;
        if let Some(reach) = self.reach {
            within(reach, &REACH, "reach", "the reach of a profile is a number of radii")?;
        }
        for key in &self.radius_at {
            finite(key.at, "radius_at")?;
            positive(key.radius, "radius_at")?;
        }
        for key in &self.profile_at {
            finite(key.at, "profile_at")?;
            key.profile.check("profile_at")?;
        }
        within(self.alpha, &ALPHA, "alpha", "the reach is a number of radii")?;
        within(self.tolerance, &TOLERANCE, "tolerance", "the tolerance is a share of the radius")?;
        ensure(!self.multiresolution || self.surface == Surface::Keep, "multiresolution", || {
            "needs the surface keep: details are put back on the same triangles".into()
        })
    }

    /// The same for the engine; `diagonal` is what lengths may be a share of.
    pub(super) fn params(self, sides: [Length; 2], diagonal: f64) -> Result<Params, OptionError> {
        let at: Vec<_> = self.radius_at.iter().map(|k| (k.at, k.radius.resolve(diagonal))).collect();
        let (radius, radii) = Radii::of(sides.map(|r| r.resolve(diagonal)), &at);
        let keep = blend::keep::Params { levels: if self.multiresolution { LEVELS } else { 0 }, ..Default::default() };
        let profile_at = self.profile_at.iter().map(|k| Ok((k.at, k.profile.profile("profile_at")?.clone())));
        Ok(Params {
            radii,
            profile: self.profile.profile("profile")?.clone(),
            profile_at: profile_at.collect::<Result<_, _>>()?,
            reach: self.reach.or(self.profile.reach),
            overlap: match self.overlap {
                Overlap::Full => blend::Overlap::Full,
                Overlap::Shrink => blend::Overlap::Shrink,
                Overlap::Error => blend::Overlap::Error,
            },
            solver: match self.spine {
                Spine::Contact => Solver::Contact,
                Spine::Offset => Solver::Offset(OffsetParams::default()),
            },
            alpha: self.alpha,
            tolerance: self.tolerance,
            surface: match self.surface {
                Surface::Auto => blend::Surface::Auto,
                Surface::Stitch => blend::Surface::Stitch,
                Surface::Keep => blend::Surface::Keep(keep),
                Surface::Field => blend::Surface::Field,
            },
            ..Params::new(radius)
        })
    }
}

/// Reads the files of cross-sections.
pub(super) fn load(profile: &mut Section, profile_at: &mut [ProfileAt], files: &mut dyn Files) -> Check {
    profile.load("profile", files)?;
    profile_at.iter_mut().try_for_each(|k| k.profile.load("profile_at", files))
}
