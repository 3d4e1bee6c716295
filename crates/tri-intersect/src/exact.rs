//! Numbers beyond 64 bits: pairs of doubles for positions, expansions for the few comparisons that pairs cannot decide.

use glam::DVec3;
use std::cmp::Ordering;

/// The unevaluated sum of two doubles, about 106 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub hi: f64,
    pub lo: f64,
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let bb = s - a;
    (s, (a - (s - bb)) + (b - bb))
}

fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    (p, a.mul_add(b, -p))
}

impl Pair {
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, b);
        Self { hi, lo }
    }

    fn renormalised(hi: f64, lo: f64) -> Self {
        let s = hi + lo;
        Self { hi: s, lo: lo - (s - hi) }
    }

    pub(crate) fn add(self, o: Self) -> Self {
        let (s, e) = two_sum(self.hi, o.hi);
        let (t, f) = two_sum(self.lo, o.lo);
        let first = Self::renormalised(s, e + t);
        Self::renormalised(first.hi, first.lo + f)
    }

    pub(crate) fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }

    pub(crate) fn sub(self, o: Self) -> Self {
        self.add(o.neg())
    }

    pub(crate) fn mul(self, o: Self) -> Self {
        let (p, e) = two_product(self.hi, o.hi);
        Self::renormalised(p, e + (self.hi * o.lo + self.lo * o.hi))
    }

    pub(crate) fn div(self, o: Self) -> Self {
        let q = self.hi / o.hi;
        let r = self.sub(o.mul(Self { hi: q, lo: 0.0 }));
        let q2 = r.hi / o.hi;
        let r = r.sub(o.mul(Self { hi: q2, lo: 0.0 }));
        Self::renormalised(q, q2).add(Self { hi: r.hi / o.hi, lo: 0.0 })
    }
}

/// A sum of doubles, none overlapping the next, smallest first: an exact number \[Shewchuk1997\].
#[derive(Clone, Debug)]
pub(crate) struct Expansion(Vec<f64>);

impl Expansion {
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let (s, e) = two_sum(a, -b);
        Self::of([e, s])
    }

    fn of(parts: impl IntoIterator<Item = f64>) -> Self {
        let mut sum = Self(vec![]);
        parts.into_iter().for_each(|x| sum.grow(x));
        sum
    }

    /// Adds one double.
    fn grow(&mut self, x: f64) {
        let mut q = x;
        let mut kept = 0;
        for i in 0..self.0.len() {
            let (s, e) = two_sum(q, self.0[i]);
            q = s;
            if e != 0.0 {
                self.0[kept] = e;
                kept += 1;
            }
        }
        self.0.truncate(kept);
        if q != 0.0 {
            self.0.push(q);
        }
    }

    pub(crate) fn add(&self, o: &Self) -> Self {
        let mut sum = self.clone();
        o.0.iter().for_each(|&x| sum.grow(x));
        sum
    }

    pub(crate) fn sub(&self, o: &Self) -> Self {
        let mut sum = self.clone();
        o.0.iter().for_each(|&x| sum.grow(-x));
        sum
    }

    pub(crate) fn mul(&self, o: &Self) -> Self {
        let mut sum = Self(vec![]);
        for &x in &self.0 {
            for &y in &o.0 {
                let (p, e) = two_product(x, y);
                sum.grow(e);
                sum.grow(p);
            }
        }
        sum
    }

    pub(crate) fn sign(&self) -> Ordering {
        self.0.last().map_or(Ordering::Equal, |x| x.total_cmp(&0.0))
    }

    /// The nearest pair of doubles.
    pub(crate) fn rounded(&self) -> Pair {
        let mut sum = Pair { hi: 0.0, lo: 0.0 };
        for &x in &self.0 {
            sum = sum.add(Pair { hi: x, lo: 0.0 });
        }
        sum
    }
}

/// Exact 2D cross product of u1−u0 and v1−v0.
pub(crate) fn cross2(u0: [f64; 2], u1: [f64; 2], v0: [f64; 2], v1: [f64; 2]) -> Expansion {
    let d = Expansion::difference;
    d(u1[0], u0[0]).mul(&d(v1[1], v0[1])).sub(&d(u1[1], u0[1]).mul(&d(v1[0], v0[0])))
}

/// The determinant of (a−d, b−d, c−d), exactly.
pub(crate) fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Expansion {
    let [a, b, c] = [a, b, c].map(|p| [0, 1, 2].map(|i| Expansion::difference(p[i], d[i])));
    let minor = |i: usize, j: usize| b[i].mul(&c[j]).sub(&b[j].mul(&c[i]));
    a[0].mul(&minor(1, 2)).add(&a[1].mul(&minor(2, 0))).add(&a[2].mul(&minor(0, 1)))
}

/// The same determinant in pairs of doubles, and a bound on its error.
pub(crate) fn volume_pair(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> (Pair, f64) {
    let [a, b, c] = [a, b, c].map(|p| [0, 1, 2].map(|i| Pair::sum(p[i], -d[i])));
    let minor = |i: usize, j: usize| b[i].mul(c[j]).sub(b[j].mul(c[i]));
    let value = a[0].mul(minor(1, 2)).add(a[1].mul(minor(2, 0))).add(a[2].mul(minor(0, 1)));
    let size = |v: [Pair; 3]| v[0].hi.abs() + v[1].hi.abs() + v[2].hi.abs();
    // A dozen operations of relative error 2^-102 each, on terms no larger than this product.
    (value, 2.0 * size(a) * size(b) * size(c) * PAIR_ERROR)
}

/// Relative error allowed for a short formula in pairs: generous beside the true 2⁻¹⁰⁰.
pub(crate) const PAIR_ERROR: f64 = 6.3e-29; // 2^-93.7

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expansions_are_exact_where_doubles_cancel() {
        let big = Expansion::difference(1e16, -1.0); // 1e16 + 1 is not a double
        assert_eq!(big.sub(&Expansion::difference(1e16, 0.0)).rounded(), Pair { hi: 1.0, lo: 0.0 });
        let square = big.mul(&big).sub(&Expansion::difference(1e16, 0.0).mul(&Expansion::difference(1e16, 0.0)));
        assert_eq!(square.rounded(), Pair { hi: 2e16, lo: 1.0 });
    }

    #[test]
    fn pairs_divide_to_full_length() {
        let third = Pair { hi: 1.0, lo: 0.0 }.div(Pair { hi: 3.0, lo: 0.0 });
        let back = third.mul(Pair { hi: 3.0, lo: 0.0 }).sub(Pair { hi: 1.0, lo: 0.0 });
        assert!(back.hi.abs() < 1e-31, "{back:?}");
    }

    #[test]
    fn volume_agrees_with_the_adaptive_predicate() {
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let (a, b, c) = (p(0.1, 0.2, 0.3), p(1.3, 0.7, 0.1), p(0.2, 2.1, 0.7));
        for k in 0..50 {
            let s = f64::from(k) * 0.02;
            let d = a + s * (b - a) + (1.0 - s) * (c - a); // on the plane up to rounding
            let exact = volume(a, b, c, d);
            let sign = crate::predicate::volume_sign(a, b, c, d);
            assert_eq!(exact.sign() as i8, sign);
            let (pair, error) = volume_pair(a, b, c, d);
            assert!((pair.sub(exact.rounded())).hi.abs() <= error);
        }
    }
}
