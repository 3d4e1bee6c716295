//! One cross-section of a blend: the feet of the ball and the apex where the tangents there meet.

use crate::error::Error;
use glam::DVec3;

/// One profile's frame: feet `p1` and `p2`, and the apex `p0` where the tangents at the feet meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// First foot.
    pub p1: DVec3,
    /// Apex.
    pub p0: DVec3,
    /// Second foot.
    pub p2: DVec3,
    /// How each surface bends at its foot, in the plane of the section: its normal curvature in 1/model unit, positive
    /// towards the inside, as the arc bends. [`crate::Profile::G2`] takes it over; 0 is a flat surface.
    pub bends: [f64; 2],
}

/// Feet may differ this much in their distance from the centre, relative to it: what solvers and f32 files leave.
const RADIUS_SLACK: f64 = 1e-5;
/// The centre must be farther than this from the chord, relative to the radius, or the apex has no digits left.
const NEARLY_OPPOSITE: f64 = 1e-9;

impl Section {
    /// The section of a ball with its centre and feet: `P0 = ((cos φ − 1) P + P1 + P2) / (cos φ + 1)`, φ the angle
    /// between the feet (\[Liu2005\] §4.2), written so that it keeps its digits for every φ in (0, π).
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::UnequalRadii`] when the feet lie on no common ball; [`Error::NoApex`] when they
    /// coincide or lie opposite each other.
    pub fn from_ball(center: DVec3, p1: DVec3, p2: DVec3) -> Result<Self, Error> {
        finite([center, p1, p2])?;
        let (first, second) = (p1.distance(center), p2.distance(center));
        if (first - second).abs() > RADIUS_SLACK * first.max(second) {
            return Err(Error::UnequalRadii { center, first, second });
        }
        let half = 0.5 * (p2 - p1);
        let middle = 0.5 * (p1 - center) + 0.5 * (p2 - center);
        let (half_length, height) = (half.length(), middle.length());
        if half_length <= f64::EPSILON * first || height <= NEARLY_OPPOSITE * first {
            return Err(Error::NoApex { first: p1, second: p2 });
        }
        // For nearly opposite feet `middle` is short and its rounding would tilt the apex: square it to the chord,
        // twice, since once leaves the rounding of the first time.
        let chord = half / half_length;
        let square = |v: DVec3| (v - v.dot(chord) * chord).normalize_or_zero();
        let out = square(square(middle));
        Ok(Self { p1, p0: p1 + half + half_length * (half_length / height) * out, p2, bends: [0.0; 2] })
    }

    /// The section between two feet with surface normals `n1` and `n2` (any length, either sign): the apex is the
    /// point of both tangent planes that is nearest to the middle of the chord.
    ///
    /// Agrees with [`Section::from_ball`] where the normals meet in a centre, and serves feet that were smoothed,
    /// offset, or belong to two radii.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::NoApex`] when the normals are parallel.
    pub fn from_tangents(p1: DVec3, n1: DVec3, p2: DVec3, n2: DVec3) -> Result<Self, Error> {
        finite([p1, n1, p2, n2])?;
        let (n1, n2) = (n1.normalize_or_zero(), n2.normalize_or_zero());
        let det = n1.cross(n2).length_squared();
        let half = 0.5 * (p2 - p1);
        if det <= NEARLY_OPPOSITE * NEARLY_OPPOSITE || half == DVec3::ZERO {
            return Err(Error::NoApex { first: p1, second: p2 });
        }
        let (cos, rise, fall) = (n1.dot(n2), half.dot(n1), half.dot(n2));
        let apex = (-rise - cos * fall) / det * n1 + (fall + cos * rise) / det * n2;
        Ok(Self { p1, p0: p1 + half + apex, p2, bends: [0.0; 2] })
    }

    /// The weight of the apex that makes the conic an arc: cos(φ/2) where the legs are equal, and that of the ellipse
    /// of least eccentricity where they are not. In (0, 1]; 0 only for sections without extent.
    pub fn arc_weight(&self) -> f64 {
        let chord = self.p1.distance(self.p2);
        // From lengths, not angles: for nearly opposite feet its rounding then cancels against that of the apex.
        let legs = (2.0 * (self.p0.distance_squared(self.p1) + self.p0.distance_squared(self.p2))).sqrt();
        if legs > 0.0 { (chord / legs).min(1.0) } else { 0.0 }
    }

    /// The angle φ through which the profile turns, which for a ball is the angle between its feet; radians in [0, π].
    pub fn angle(&self) -> f64 {
        let (a, b) = (self.p0 - self.p1, self.p2 - self.p0);
        let (a, b) = (a.normalize_or_zero(), b.normalize_or_zero());
        a.cross(b).length().atan2(a.dot(b))
    }

    /// The section with its apex moved along the line from the ball's `center` to the distance `reach`·r, r being the
    /// distance of the first foot: the pulled-out profile of \[Liu2005\] Fig. 4c (`reach` 2.4). The curve then meets the
    /// surfaces at an angle. Unchanged when the apex is at the centre or `reach` is not finite.
    #[must_use]
    pub fn with_reach(&self, center: DVec3, reach: f64) -> Self {
        let out = (self.p0 - center).normalize_or_zero();
        if out == DVec3::ZERO || !reach.is_finite() {
            return *self;
        }
        Self { p0: center + reach * self.p1.distance(center) * out, ..*self }
    }
}

fn finite<const N: usize>(points: [DVec3; N]) -> Result<(), Error> {
    match points.iter().position(|p| !p.is_finite()) {
        Some(index) => Err(Error::NotFinite { index, point: points[index] }),
        None => Ok(()),
    }
}
