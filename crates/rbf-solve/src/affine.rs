//! The affine part: four functionals that determine it, and all others in terms of them.

use crate::admit::System;
use crate::error::Error;
use glam::{DMat4, DVec3, DVec4};

/// A flatter system is refused: its affine part is lost in rounding.
const THINNEST: f64 = 1e-10;

/// Four unknowns whose functionals determine an affine function, and the share of each in every other functional.
///
/// With the four chosen for greatest volume all shares are about one at most, which keeps the reduced system as well conditioned
/// as the original one.
pub(crate) struct Affine {
    /// The four unknowns.
    pub(crate) special: [usize; 4],
    /// For each of the four, its share in every functional on affine functions.
    pub(crate) shares: [Vec<f64>; 4],
    /// From the values at the four to coefficients (1, x, y, z).
    inverse: DMat4,
}

/// What the functional of `unknown` gives on 1, x, y, z.
fn row(system: &System, unknown: usize) -> DVec4 {
    let n = system.points.len();
    if unknown < n {
        let p = system.points[unknown];
        DVec4::new(1.0, p.x, p.y, p.z)
    } else {
        DVec4::AXES[1 + (unknown - n) / system.gradients.len()]
    }
}

impl Affine {
    /// Chooses the four. O(n).
    pub(crate) fn choose(system: &System) -> Result<Self, Error> {
        let m = system.unknowns();
        let mut special = [0; 4];
        let mut basis: Vec<DVec4> = vec![];
        for slot in &mut special {
            let left = |u: usize| basis.iter().fold(row(system, u), |v, b| v - b.dot(v) * b);
            let (length, best) = (0..m)
                .map(|u| (left(u).length(), u))
                .fold((0.0, 0), |best, next| if next.0 > best.0 { next } else { best });
            if length < THINNEST {
                return Err(Error::Flat { count: system.points.len(), at: middle(system), thickness: length });
            }
            *slot = best;
            basis.push(left(best) / length);
        }
        let mut inverse = DMat4::IDENTITY;
        // Exchanges that enlarge the volume: a few suffice, and each bounds all shares more tightly.
        for _ in 0..32 {
            inverse = DMat4::from_cols_array_2d(&special.map(|u| row(system, u).to_array())).transpose().inverse();
            let share = |u: usize, k: usize| inverse.col(k).dot(row(system, u));
            let candidates = (0..m).flat_map(|u| (0..4).map(move |k| (u, k)));
            let largest = candidates
                .map(|(u, k)| (share(u, k).abs(), u, k))
                .fold((0.0, 0, 0), |a, b| if b.0 > a.0 { b } else { a });
            if largest.0 <= 1.1 {
                break;
            }
            special[largest.2] = largest.1;
        }
        let shares = [0, 1, 2, 3].map(|k| (0..m).map(|u| inverse.col(k).dot(row(system, u))).collect());
        Ok(Self { special, shares, inverse })
    }

    /// Coefficients of 1, x, y, z of the affine function with these values of the four functionals.
    pub(crate) fn coefficients(&self, at_special: [f64; 4]) -> [f64; 4] {
        (self.inverse * DVec4::from_array(at_special)).to_array()
    }
}

fn middle(system: &System) -> DVec3 {
    system.points.iter().sum::<DVec3>() / system.points.len() as f64 * system.scale + system.centre
}
