//! Whether a triangle is exactly flat to a line: a filtered exact test.

use glam::{DVec2, DVec3};

/// Whether three points lie exactly on one line, decided without rounding (\[Shewchuk1997\]).
///
/// Exact while products of coordinates, relative to the largest, stay above 1e-290; not finite means not collinear.
pub fn collinear([a, b, c]: [DVec3; 3]) -> bool {
    // Shewchuk's bound for a 2×2 determinant of differences, rounded up.
    const BOUND: f64 = 4.0 * f64::EPSILON;
    let (u, v) = (b - a, c - a);
    let (plus, minus) = (u.zxy() * v.xyz_next(), u.xyz_next() * v.zxy());
    let sure = (plus - minus).abs().cmpgt(BOUND * (plus.abs() + minus.abs()));
    if sure.any() {
        return false;
    }
    let size = a.abs().max(b.abs()).max(c.abs()).max_element();
    if !(a.is_finite() && b.is_finite() && c.is_finite()) {
        return false;
    }
    if size == 0.0 {
        return true;
    }
    // A power of two scales without rounding.
    let exponent = (size.to_bits() >> 52) as i32 - 1023;
    let [a, b, c] = [a, b, c].map(|p| p * 2f64.powi(-exponent / 2) * 2f64.powi(-exponent - -exponent / 2));
    area_is_zero([a.truncate(), b.truncate(), c.truncate()])
        && area_is_zero([a, b, c].map(|p| DVec2::new(p.y, p.z)))
        && area_is_zero([a, b, c].map(|p| DVec2::new(p.z, p.x)))
}

/// `(y, z, x)`, spelled so that the cross product above reads by components.
trait Cyclic {
    fn xyz_next(self) -> DVec3;
    fn zxy(self) -> DVec3;
}

impl Cyclic for DVec3 {
    fn xyz_next(self) -> DVec3 {
        DVec3::new(self.y, self.z, self.x)
    }
    fn zxy(self) -> DVec3 {
        DVec3::new(self.z, self.x, self.y)
    }
}

/// Sums a×b + b×c + c×a as an expansion of non-overlapping parts, which is zero only if every part is.
fn area_is_zero([a, b, c]: [DVec2; 3]) -> bool {
    let mut expansion = [0.0f64; 12];
    let products = [(a.x, b.y), (-a.y, b.x), (b.x, c.y), (-b.y, c.x), (c.x, a.y), (-c.y, a.x)];
    for (i, (x, y)) in products.into_iter().enumerate() {
        let product = x * y;
        for (j, term) in [x.mul_add(y, -product), product].into_iter().enumerate() {
            let used = 2 * i + j;
            let mut carry = term;
            for part in &mut expansion[..used] {
                let sum = carry + *part;
                let virtual_part = sum - carry;
                *part = (carry - (sum - virtual_part)) + (*part - virtual_part);
                carry = sum;
            }
            expansion[used] = carry;
        }
    }
    expansion == [0.0; 12]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_cases() {
        let p = DVec3::new(0.1, 0.7, -0.3);
        assert!(collinear([p, 2.0 * p, 8.0 * p]) && collinear([p, p, DVec3::X]) && collinear([DVec3::ZERO; 3]));
        // 3·p rounds, so this is not a line, although the cross product in f64 may say so.
        assert!(!collinear([p, 2.0 * p, 3.0 * p]));
        assert!(!collinear([DVec3::NAN, p, DVec3::X]) && !collinear([1e308 * p, -1e308 * p, DVec3::X * 1e308]));
        assert!(collinear([1e308 * DVec3::ONE, -1e308 * DVec3::ONE, DVec3::ZERO]));
    }

    proptest! {
        /// Integers up to 2^40: the truth is computed in 128-bit integers.
        #[test]
        fn agrees_with_integers(a in prop::array::uniform3(-(1i64 << 40)..1 << 40), d in prop::array::uniform3(-9i64..9), k in -9i64..9, nudge in 0i64..2) {
            let b = [0, 1, 2].map(|i| a[i] + d[i]);
            let c = [0, 1, 2].map(|i| a[i] + k * d[i] + if i == 2 { nudge } else { 0 });
            let cross = |i: usize, j: usize| {
                i128::from(b[i] - a[i]) * i128::from(c[j] - a[j]) - i128::from(b[j] - a[j]) * i128::from(c[i] - a[i])
            };
            let truth = cross(0, 1) == 0 && cross(1, 2) == 0 && cross(2, 0) == 0;
            let float = |p: [i64; 3]| DVec3::from(p.map(|x| x as f64));
            prop_assert_eq!(collinear([float(a), float(b), float(c)]), truth);
        }
    }
}
