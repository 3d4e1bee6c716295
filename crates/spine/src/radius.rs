//! The ball's radius as a field in space: constant, but for dips where a full-size ball does not fit.

use glam::DVec3;

/// A place where the ball is made smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dip {
    /// Centre of the dip.
    pub at: DVec3,
    /// Share of the radius that is left there, in (0, 1].
    pub factor: f64,
    /// Distance from the centre at which the dip ends, in model units.
    pub extent: f64,
}

/// A C¹ radius field: `base` times the product of all dips.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusField {
    /// Radius away from every dip, in model units.
    pub base: f64,
    /// Where it is smaller.
    pub dips: Vec<Dip>,
}

impl RadiusField {
    /// The same radius everywhere.
    pub fn constant(base: f64) -> Self {
        Self { base, dips: Vec::new() }
    }

    /// Radius and its gradient at `x`. Each dip is the bump (1 − d²)², so that the field and the spine stay C¹.
    pub fn at(&self, x: DVec3) -> (f64, DVec3) {
        let (mut value, mut log_slope) = (self.base, DVec3::ZERO);
        for dip in &self.dips {
            let d = (x - dip.at) / dip.extent;
            let left = 1.0 - d.length_squared();
            if left > 0.0 {
                let share = 1.0 - (1.0 - dip.factor) * left * left;
                value *= share;
                log_slope += 4.0 * (1.0 - dip.factor) * left * d / (dip.extent * share);
            }
        }
        (value, value * log_slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradient_matches_finite_differences() {
        let dip = |x, factor| Dip { at: DVec3::new(x, 0.0, 0.2), factor, extent: 2.0 };
        let field = RadiusField { base: 0.5, dips: vec![dip(0.3, 0.6), dip(-0.4, 0.8)] };
        let (x, h) = (DVec3::new(0.1, 0.5, -0.3), 1e-6);
        for axis in DVec3::AXES {
            let slope = (field.at(x + h * axis).0 - field.at(x - h * axis).0) / (2.0 * h);
            assert!((slope - field.at(x).1.dot(axis)).abs() < 1e-9);
        }
        assert_eq!(field.at(DVec3::splat(9.0)), (0.5, DVec3::ZERO));
    }
}
