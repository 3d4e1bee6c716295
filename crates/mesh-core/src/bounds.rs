//! Axis-aligned boxes.

use glam::DVec3;

/// An axis-aligned box; empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner.
    pub min: DVec3,
    /// Highest corner.
    pub max: DVec3,
}

impl Bounds {
    /// The box of nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around points. NaN coordinates are passed over.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box moved outward by `margin` on every side.
    #[must_use]
    pub fn inflated(self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// Whether the boxes share a point; touching counts.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether nothing is inside.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Length of the diagonal; 0 when empty.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let sides = self.max - self.min;
        let (length, largest) = (sides.length(), sides.max_element());
        // Squares of sides beyond 1e154 overflow, those of sides below 1e-154 vanish.
        let squared = length.is_finite() && length > 1e-150;
        if squared || largest == 0.0 { length } else { largest * (sides / largest).length() }
    }

    /// The middle.
    pub fn center(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }
}
