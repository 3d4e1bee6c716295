//! One ball at rest against two patches.

use crate::patch::Patch;
use crate::radius::RadiusField;
use glam::DVec3;
use mesh_core::{Adjacency, Positions};
use mesh_query::ClosestPoint;

/// A ball that touches both patches and enters neither.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Centre.
    pub center: DVec3,
    /// Radius at the centre, in model units: the larger of the two where the sides have different ones.
    pub radius: f64,
    /// Where it touches the left and the right patch.
    pub feet: [ClosestPoint; 2],
    /// Largest | distance to a patch − radius |, in model units.
    pub residual: f64,
}

/// Residual at which Newton stops, as a share of the radius. The promise is 1e-9.
const SEATED: f64 = 1e-11;

impl Contact {
    fn at<M: Adjacency + Positions>(
        mesh: &M,
        patches: &[Patch; 2],
        radius: &RadiusField,
        center: DVec3,
        known: Option<[DVec3; 2]>,
    ) -> Option<(Self, DVec3)> {
        let foot = |side: usize| match known {
            Some(points) => patches[side].closest_near(mesh, center, points[side]),
            None => patches[side].closest(mesh, center),
        };
        let feet = [foot(0)?, foot(1)?];
        let (r, slope) = radius.at(center);
        let off = |side: usize| (feet[side].distance - r * radius.sides[side]).abs();
        let residual = off(0).max(off(1));
        residual.is_finite().then_some((Self { center, radius: r, feet, residual }, slope))
    }

    /// Seats the ball: damped Newton on { distance to left = r, distance to right = r }, each r as the field has it for
    /// that side, each step the shortest that
    /// solves the linearised pair, so that the centre stays nearest to the guess.
    ///
    /// `known` are points of the patches near which the feet are expected; they only save time.
    ///
    /// `None` where it does not converge: the patches face each other too squarely for a ball to wedge between them,
    /// or no ball fits nearby.
    pub fn seat<M: Adjacency + Positions>(
        mesh: &M,
        patches: &[Patch; 2],
        radius: &RadiusField,
        guess: DVec3,
        known: Option<[DVec3; 2]>,
    ) -> Option<Self> {
        let (mut here, mut slope) = Self::at(mesh, patches, radius, guess, known)?;
        for _ in 0..40 {
            if here.residual <= SEATED * here.radius {
                return Some(here);
            }
            let mut step = here.newton_step(radius.sides, slope)?.clamp_length_max(0.5 * here.radius);
            let known = Some(here.feet.map(|f| f.point));
            let mut next = Self::at(mesh, patches, radius, here.center + step, known)?;
            // A foot that jumps to another facet can make a full step worse; half steps then find the new facet.
            for _ in 0..6 {
                if next.0.residual < here.residual {
                    break;
                }
                step *= 0.5;
                next = Self::at(mesh, patches, radius, here.center + step, known)?;
            }
            (here, slope) = next;
        }
        (here.residual <= 1e-9 * here.radius).then_some(here)
    }

    /// The nearest points to `center` as if a ball stood there; its residual tells how far it is from doing so.
    pub(crate) fn probe<M: Adjacency + Positions>(
        mesh: &M,
        patches: &[Patch; 2],
        radius: &RadiusField,
        center: DVec3,
        known: Option<[DVec3; 2]>,
    ) -> Option<Self> {
        Self::at(mesh, patches, radius, center, known).map(|(contact, _)| contact)
    }

    /// Unit directions from the feet to the centre.
    pub fn normals(&self) -> [DVec3; 2] {
        self.feet.map(|f| (self.center - f.point).normalize_or_zero())
    }

    /// Unit tangent of the spine, along left normal × right normal. `None` where the two feet are one.
    pub fn tangent(&self) -> Option<DVec3> {
        let [a, b] = self.normals();
        a.cross(b).try_normalize()
    }

    fn newton_step(&self, sides: [f64; 2], slope: DVec3) -> Option<DVec3> {
        let normals = self.normals();
        let [a, b] = [0, 1].map(|i| normals[i] - sides[i] * slope);
        let [fa, fb] = [0, 1].map(|i| self.radius * sides[i] - self.feet[i].distance);
        let (aa, ab, bb) = (a.dot(a), a.dot(b), b.dot(b));
        let det = aa * bb - ab * ab;
        // sin² of the angle between the offsets: below this they meet within 0.1 degree of tangency.
        (det > 3e-6).then(|| ((bb * fa - ab * fb) * a + (aa * fb - ab * fa) * b) / det)
    }
}
