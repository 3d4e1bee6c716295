//! How curves are blended.

use crate::keep;
use crate::radii::Radii;
use crate::sketch::Sketch;
use glam::DVec3;
use profile_nurbs::Profile;
use spine::Solver;

/// How curves are blended.
#[derive(Clone, Debug)]
pub struct Params {
    /// Ball radius, in model units; the largest one where it varies. Positive and finite.
    pub radius: f64,
    /// How it varies.
    pub radii: Radii,
    /// Cross-section of the blend.
    pub profile: Profile,
    /// Places and the cross-section there, as for the keys of [`Radii`]; `profile` is the one away from them. In between
    /// the two are mixed point by point.
    pub profile_at: Vec<(DVec3, Profile)>,
    /// Distance of the apex from the ball's centre in radii, if it is moved out along its line; see
    /// [`profile_nurbs::Section::with_reach`]. The blend then meets the surfaces at an angle.
    pub reach: Option<f64>,
    /// What to do where the ball does not fit.
    pub overlap: Overlap,
    /// What finds the way of the ball's centre.
    pub solver: Solver,
    /// Least reach of the base patches, as a multiple of the radius; see [`spine::Params::alpha`].
    pub alpha: f64,
    /// Longest gap that is bridged where the sweep folds, in radii; see [`spine::Params::bridge`].
    pub bridge: f64,
    /// Largest sagitta of the blend's chords across, as a share of the radius.
    pub tolerance: f64,
    /// How far linkage vertices may be moved to spare slivers, as a share of the radius, in [0, 0.02]. A point moved by
    /// this much turns the linkage edges next to it, and with them the normals there: at the default, a five-thousandth,
    /// by less than a picture shows. More makes a mesh that survives 32-bit coordinates.
    pub snap: f64,
    /// How the surface is put in.
    pub surface: Surface,
    /// Where the stages draw what they do.
    pub sketch: Sketch,
}

/// How the surface is put in.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Surface {
    /// Swept as [`Surface::Stitch`]; where that fails, as [`Surface::Field`].
    #[default]
    Auto,
    /// Swept, and sewn between exact cuts along the linkages.
    Stitch,
    /// The mesh's own vertices are moved onto it; connectivity is kept.
    Keep(keep::Params),
    /// As a field of balls around both sides, which cannot fold; an arc in profile.
    Field,
}

/// What to do where a ball of the full radius does not fit, or its sweep would fold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlap {
    /// Refuse, naming the place and a radius that works.
    Error,
    /// Use the envelope of all balls of the full radius there; where no such ball can act, a smaller one, and where none is
    /// found leave the curve sharp, and say so.
    #[default]
    Full,
    /// Use a smaller ball there, fading into the full one, and say so.
    Shrink,
}

impl Params {
    /// Whether any cross-section is of a kind.
    pub(crate) fn uses(&self, kind: &Profile) -> bool {
        self.profile == *kind || self.profile_at.iter().any(|k| k.1 == *kind)
    }

    /// An arc of radius `radius`, made smaller where it does not fit.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            radii: Radii::default(),
            profile: Profile::Arc,
            profile_at: Vec::new(),
            reach: None,
            overlap: Overlap::default(),
            solver: Solver::Contact,
            alpha: 1.75,
            bridge: 3.0,
            tolerance: 0.005,
            snap: 2e-4,
            surface: Surface::default(),
            sketch: Sketch::default(),
        }
    }
}
