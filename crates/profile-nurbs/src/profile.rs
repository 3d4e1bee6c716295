//! Profiles: the curve that replaces an edge between the two feet.

use crate::error::Error;
use crate::nurbs::Nurbs;
use crate::section::Section;
use glam::DVec3;

/// The shape of a blend's cross-section.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The ball's own circular arc, exactly; in a section with unequal legs, the ellipse of least eccentricity.
    Arc,
    /// The straight chord.
    Chamfer,
    /// A conic whose apex weighs W times that of the arc: below 1 flatter, above 1 sharper. W ≥ 0; 0 is the chamfer,
    /// infinity the sharp edge (\[Liu2005\] §4.2).
    Conic(f64),
    /// The two legs, meeting in the apex.
    Sharp,
    /// The cubic with the arc's end tangents and middle point: a polynomial stand-in for the arc, at most 0.03% of r
    /// away at 90° (\[Liu2005\] offers it as "Hermite").
    Hermite,
    /// A quintic that leaves both legs with the curvature of the surfaces there, [`Section::bends`], so that reflections
    /// run unbroken from the faces into the blend. Between flat faces at 90° it is at most 3.7% of r away from the arc and
    /// 13% more curved at its tightest; its middle stands out 1/8 farther than the arc's.
    G2,
    /// A curve in the section's own affine frame: (1, 0, 0) is the first foot, (0, 0, 0) the apex, (0, 1, 0) the
    /// second foot. Made by [`Profile::custom`].
    Custom(Nurbs),
}

/// Beyond this turn (cos φ/2 of 120°) one rational quadratic has a far apex and a small weight; two have not.
const SPLIT_BELOW: f64 = 0.5;

impl Profile {
    /// A profile by its name: `arc`, `g2`, `chamfer`, `sharp`, `hermite`, or `conic=W` with W ≥ 0.
    ///
    /// ```
    /// use profile_nurbs::Profile;
    /// assert_eq!(Profile::named("conic=0.5"), Some(Profile::Conic(0.5)));
    /// assert_eq!(Profile::named("conic=-1"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "arc" => Some(Self::Arc),
            "g2" => Some(Self::G2),
            "chamfer" => Some(Self::Chamfer),
            "sharp" => Some(Self::Sharp),
            "hermite" => Some(Self::Hermite),
            _ => {
                let weight: f64 = name.strip_prefix("conic=")?.parse().ok()?;
                (weight.is_finite() && weight >= 0.0).then_some(Self::Conic(weight))
            }
        }
    }

    /// A custom profile from a curve in the normalised frame.
    ///
    /// # Errors
    /// [`Error::CustomFrame`] when the curve does not run from (1, 0, 0) to (0, 1, 0) or leaves the plane z = 0.
    pub fn custom(curve: Nurbs) -> Result<Self, Error> {
        let [first, last] = curve.domain();
        let ends = [(curve.point(first), DVec3::X), (curve.point(last), DVec3::Y)];
        // The frame's legs have length one, so this is relative.
        let loose = ends.into_iter().find(|(p, foot)| p.distance(*foot) > 1e-9).map(|e| e.0);
        let offender = loose.or(curve.control_points().find(|p| p.z.abs() > 1e-9));
        match offender {
            Some(point) => Err(Error::CustomFrame { point }),
            None => Ok(Self::Custom(curve)),
        }
    }

    /// The profile in a section, from `p1` at parameter 0 to `p2` at 1 (a custom curve keeps its own domain).
    pub fn curve(&self, section: &Section) -> Nurbs {
        let Section { p1, p0, p2, .. } = *section;
        match self {
            Self::Chamfer => Nurbs::from_pieces(1, &[p1, p2], &[1.0; 2]),
            Self::Sharp => Nurbs::from_pieces(1, &[p1, p0, p2], &[1.0; 3]),
            Self::Arc | Self::Conic(_) => match self.apex_weight(section) {
                w if w <= 0.0 => Self::Chamfer.curve(section),
                f64::INFINITY => Self::Sharp.curve(section),
                w if w < SPLIT_BELOW => {
                    let [a, m, b] = [(p1 + w * p0) / (1.0 + w), shoulder(section, w), (p2 + w * p0) / (1.0 + w)];
                    let v = (0.5 * (1.0 + w)).sqrt();
                    Nurbs::from_pieces(2, &[p1, a, m, b, p2], &[1.0, v, 1.0, v, 1.0])
                }
                w => Nurbs::from_pieces(2, &[p1, p0, p2], &[1.0, w, 1.0]),
            },
            Self::Hermite => Nurbs::from_pieces(3, &hermite(section), &[1.0; 4]),
            Self::G2 => Nurbs::from_pieces(5, &quintic(section), &[1.0; 6]),
            Self::Custom(curve) => curve.mapped(|p| into_section(section, p)),
        }
    }

    /// How far the profile's middle stands out from the chord, as a share of the apex' height over it: 0 for the
    /// chamfer, 1 for the sharp edge, 1 / (1 + 1/cos(φ/2)) for the arc.
    pub fn reach(&self, section: &Section) -> f64 {
        match self {
            Self::Chamfer => 0.0,
            Self::Sharp => 1.0,
            Self::Custom(curve) => {
                let [first, last] = curve.domain();
                let p = curve.point(0.5 * (first + last));
                1.0 - p.x - p.y
            }
            Self::G2 => {
                let chord = section.p1.midpoint(section.p2);
                let (apex, middle) = (section.p0 - chord, casteljau(quintic(section), 0.5) - chord);
                middle.dot(apex) / apex.length_squared()
            }
            Self::Arc | Self::Conic(_) | Self::Hermite => match self.apex_weight(section) {
                f64::INFINITY => 1.0,
                w => w / (1.0 + w),
            },
        }
    }

    /// The weight ω0 of the apex for the conics, and for the polynomial profiles that of the arc they follow.
    /// NaN and negative W count as 0.
    pub(crate) fn apex_weight(&self, section: &Section) -> f64 {
        match self {
            Self::Conic(f64::INFINITY) => f64::INFINITY,
            Self::Conic(w) => w.max(0.0) * section.arc_weight(),
            _ => section.arc_weight(),
        }
    }
}

/// The middle of the conic with apex weight `w`.
pub(crate) fn shoulder(s: &Section, w: f64) -> DVec3 {
    (0.5 * (s.p1 + s.p2) + w * s.p0) / (1.0 + w)
}

/// Control points of the cubic: handles of 4ω / (3 (1 + ω)) of the legs, which is (4/3)·tan(φ/4)·r.
pub(crate) fn hermite(s: &Section) -> [DVec3; 4] {
    let w = s.arc_weight();
    let handle = 4.0 * w / (3.0 * (1.0 + w));
    [s.p1, s.p1.lerp(s.p0, handle), s.p2.lerp(s.p0, handle), s.p2]
}

/// Control points of the quintic: between flat surfaces three on each leg in one line, so that curvature vanishes at the
/// ends; else the third stands off the leg by what gives it the surface's, 5/4·κ·|P1 − P0|².
///
/// Their shares 3ω / (5 (1 + ω)) and 3ω / (2 (1 + ω)) of the legs balance a low peak of curvature, kept flat over the
/// middle, against the steepness of its rise: of the choices with a peak near 1.15 this rises most gently.
pub(crate) fn quintic(s: &Section) -> [DVec3; 6] {
    let w = s.arc_weight();
    let [near, far] = [0.6, 1.5].map(|k| k * w / (1.0 + w));
    let third = |foot: DVec3, other: DVec3, bend: f64| {
        let leg = s.p0 - foot;
        let inside = (other - foot).reject_from_normalized(leg.normalize_or_zero()).normalize_or_zero();
        foot + far * leg + 1.25 * bend * near * near * leg.length_squared() * inside
    };
    let [first, last] = [third(s.p1, s.p2, s.bends[0]), third(s.p2, s.p1, s.bends[1])];
    [s.p1, s.p1.lerp(s.p0, near), first, last, s.p2.lerp(s.p0, near), s.p2]
}

/// From the normalised frame to space.
pub(crate) fn into_section(s: &Section, p: DVec3) -> DVec3 {
    s.p0 + p.x * (s.p1 - s.p0) + p.y * (s.p2 - s.p0)
}

/// A polynomial Bézier curve at `u`, by de Casteljau.
pub(crate) fn casteljau<const N: usize>(mut points: [DVec3; N], u: f64) -> DVec3 {
    for left in (1..N).rev() {
        for i in 0..left {
            points[i] = points[i].lerp(points[i + 1], u);
        }
    }
    points[0]
}
