//! The ball's radius as a field in space: constant or by a law along the curve, with dips where a full-size ball does
//! not fit.

use crate::law::Law;
use glam::DVec3;
use std::sync::Arc;

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

/// A C¹ radius field: `base` times the share that the law has, times the product of all dips.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiusField {
    /// Largest radius away from every dip, in model units.
    pub base: f64,
    /// What share of the radius the centre keeps from the left and from the right side, in (0, 1]; the larger is 1.
    pub sides: [f64; 2],
    /// How it varies along the curve, if it does.
    pub law: Option<Arc<Law>>,
    /// Where it is smaller.
    pub dips: Vec<Dip>,
}

impl RadiusField {
    /// The same radius everywhere.
    pub fn constant(base: f64) -> Self {
        Self { base, sides: [1.0; 2], law: None, dips: Vec::new() }
    }

    /// The field for the distance to one side alone.
    pub(crate) fn of_side(&self, side: usize) -> Self {
        Self { base: self.base * self.sides[side], sides: [1.0; 2], ..self.clone() }
    }

    /// Radius and its gradient at `x` but for the dips.
    pub fn undipped(&self, x: DVec3) -> (f64, DVec3) {
        let (share, slope) = self.law.as_ref().map_or((1.0, DVec3::ZERO), |law| law.at(x));
        (self.base * share, self.base * slope)
    }

    /// Radius and its gradient at `x`. Each dip is the bump (1 − d²)², so that the field and the spine stay C¹.
    pub fn at(&self, x: DVec3) -> (f64, DVec3) {
        let (mut value, mut slope) = self.undipped(x);
        for dip in &self.dips {
            let d = (x - dip.at) / dip.extent;
            let left = 1.0 - d.length_squared();
            if left > 0.0 {
                let share = 1.0 - (1.0 - dip.factor) * left * left;
                slope = share * slope + value * 4.0 * (1.0 - dip.factor) * left * d / dip.extent;
                value *= share;
            }
        }
        (value, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradient_matches_finite_differences() {
        let dip = |x, factor| Dip { at: DVec3::new(x, 0.0, 0.2), factor, extent: 2.0 };
        let field = RadiusField { dips: vec![dip(0.3, 0.6), dip(-0.4, 0.8)], ..RadiusField::constant(0.5) };
        let (x, h) = (DVec3::new(0.1, 0.5, -0.3), 1e-6);
        for axis in DVec3::AXES {
            let slope = (field.at(x + h * axis).0 - field.at(x - h * axis).0) / (2.0 * h);
            assert!((slope - field.at(x).1.dot(axis)).abs() < 1e-9);
        }
        assert_eq!(field.at(DVec3::splat(9.0)), (0.5, DVec3::ZERO));
    }
}
