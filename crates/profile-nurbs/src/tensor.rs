//! Tensor-product Bézier patches: evaluation with derivatives.

use crate::error::Error;
use glam::DVec3;

/// A polynomial tensor-product Bézier patch of degree (n1, n2) over [0, 1]² (\[PieglTiller1997\] ch. 1).
#[derive(Clone, Debug, PartialEq)]
pub struct TensorBezier {
    degrees: [usize; 2],
    points: Vec<DVec3>,
}

/// A point of a surface with its first and second derivatives by two parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceJet {
    /// The point.
    pub point: DVec3,
    /// First derivatives: by the first parameter, by the second.
    pub first: [DVec3; 2],
    /// Second derivatives: twice by the first, by both, twice by the second.
    pub second: [DVec3; 3],
}

/// Degrees below this are evaluated without allocation.
const STACK: usize = 12;

impl TensorBezier {
    /// A patch from its (n1 + 1)·(n2 + 1) control points, b_{i,j} at i·(n2 + 1) + j. Degrees are 1 or more.
    ///
    /// # Errors
    /// [`Error::Counts`] or [`Error::NotFinite`].
    ///
    /// ```
    /// use glam::DVec3;
    /// use profile_nurbs::TensorBezier;
    /// let square = TensorBezier::new([1, 1], vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(1.0, 1.0, 1.0)])?;
    /// assert_eq!(square.point(0.5, 0.5).z, 0.25);
    /// # Ok::<(), profile_nurbs::Error>(())
    /// ```
    pub fn new(degrees: [usize; 2], points: Vec<DVec3>) -> Result<Self, Error> {
        let [a, b] = degrees;
        let wanted = a.saturating_add(1).saturating_mul(b.saturating_add(1));
        if a < 1 || b < 1 || points.len() != wanted {
            return Err(Error::Counts { degree: a.min(b), points: wanted, weights: points.len(), knots: 0 });
        }
        match points.iter().position(|p| !p.is_finite()) {
            Some(index) => Err(Error::NotFinite { index, point: points[index] }),
            None => Ok(Self { degrees, points }),
        }
    }

    /// The degrees (n1, n2).
    pub fn degrees(&self) -> [usize; 2] {
        self.degrees
    }

    /// The control points, b_{i,j} at i·(n2 + 1) + j.
    pub fn control_points(&self) -> &[DVec3] {
        &self.points
    }

    /// The point at (u, v), by Bernstein polynomials: exact at the corners. O(n1·n2), no allocation below degree 12.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let [a, b] = self.degrees;
        with_basis(a, u, |bu| with_basis(b, v, |bv| self.combine(bu, bv, 0, 0)))
    }

    /// The point at (u, v) and the derivatives up to the second. O(n1·n2).
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let [a, b] = self.degrees;
        let part = |du: usize, dv: usize| {
            if du > a || dv > b {
                return DVec3::ZERO;
            }
            let scale =
                (0..du).map(|i| (a - i) as f64).product::<f64>() * (0..dv).map(|i| (b - i) as f64).product::<f64>();
            with_basis(a - du, u, |bu| with_basis(b - dv, v, |bv| scale * self.combine(bu, bv, du, dv)))
        };
        SurfaceJet { point: part(0, 0), first: [part(1, 0), part(0, 1)], second: [part(2, 0), part(1, 1), part(0, 2)] }
    }

    /// Σ bu_i bv_j Δ^{du,dv} b_{i,j}.
    fn combine(&self, bu: &[f64], bv: &[f64], du: usize, dv: usize) -> DVec3 {
        let row = self.degrees[1] + 1;
        let at = |i: usize, j: usize| self.points[i * row + j];
        let in_v = |i: usize, j: usize| match dv {
            0 => at(i, j),
            1 => at(i, j + 1) - at(i, j),
            _ => at(i, j + 2) - 2.0 * at(i, j + 1) + at(i, j),
        };
        let in_u = |i: usize, j: usize| match du {
            0 => in_v(i, j),
            1 => in_v(i + 1, j) - in_v(i, j),
            _ => in_v(i + 2, j) - 2.0 * in_v(i + 1, j) + in_v(i, j),
        };
        let mut sum = DVec3::ZERO;
        for (i, &wu) in bu.iter().enumerate() {
            let line: DVec3 = bv.iter().enumerate().map(|(j, &wv)| wv * in_u(i, j)).sum();
            sum += wu * line;
        }
        sum
    }
}

/// Hands over the Bernstein polynomials of a degree at `t`.
fn with_basis<R>(degree: usize, t: f64, work: impl FnOnce(&[f64]) -> R) -> R {
    let fill = |basis: &mut [f64]| {
        basis[0] = 1.0;
        for level in 1..basis.len() {
            let mut carry = 0.0;
            for b in &mut basis[..level] {
                let old = *b;
                *b = carry + (1.0 - t) * old;
                carry = t * old;
            }
            basis[level] = carry;
        }
    };
    if degree < STACK {
        let mut stack = [0.0; STACK];
        let basis = &mut stack[..=degree];
        fill(basis);
        work(basis)
    } else {
        let mut basis = vec![0.0; degree + 1];
        fill(&mut basis);
        work(&basis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn patch(degrees: [usize; 2], seed: &[f64]) -> TensorBezier {
        let count = (degrees[0] + 1) * (degrees[1] + 1);
        let at = |i: usize| seed[i % seed.len()] + (i * i % 7) as f64;
        TensorBezier::new(degrees, (0..count).map(|i| DVec3::new(at(3 * i), at(3 * i + 1), at(3 * i + 2))).collect())
            .unwrap()
    }

    #[test]
    fn wrong_counts_are_refused() {
        assert!(TensorBezier::new([1, 1], vec![DVec3::ZERO; 3]).is_err());
        assert!(TensorBezier::new([0, 3], vec![DVec3::ZERO; 4]).is_err());
        assert!(TensorBezier::new([1, 1], vec![DVec3::NAN; 4]).is_err());
        assert!(TensorBezier::new([usize::MAX, 1], vec![]).is_err());
    }

    proptest! {
        /// Repeated linear interpolation, first along v and then along u, is another way to the same point; derivatives
        /// are held against central differences of it.
        #[test]
        fn agrees_with_de_casteljau(a in 1usize..6, b in 1usize..14, u in 0.1..0.9f64, v in 0.1..0.9f64, seed in prop::collection::vec(-1.0..1.0f64, 11)) {
            let surface = patch([a, b], &seed);
            let fold = |mut p: Vec<DVec3>, t: f64| {
                while p.len() > 1 {
                    p = p.windows(2).map(|w| w[0].lerp(w[1], t)).collect();
                }
                p[0]
            };
            let truth = |u: f64, v: f64| fold(surface.points.chunks(b + 1).map(|row| fold(row.to_vec(), v)).collect(), u);
            prop_assert!(surface.point(u, v).distance(truth(u, v)) < 1e-12);
            let (h, jet) = (1e-4, surface.jet(u, v));
            prop_assert_eq!(jet.point, surface.point(u, v));
            let [e, w, n, s] = [truth(u + h, v), truth(u - h, v), truth(u, v + h), truth(u, v - h)];
            let close = |x: DVec3, y: DVec3, scale: f64| x.distance(y) < 1e-5 * scale * (1.0 + x.length());
            prop_assert!(close(jet.first[0], (e - w) / (2.0 * h), 1.0) && close(jet.first[1], (n - s) / (2.0 * h), 1.0));
            prop_assert!(close(jet.second[0], (e + w - 2.0 * jet.point) / (h * h), 10.0));
            prop_assert!(close(jet.second[2], (n + s - 2.0 * jet.point) / (h * h), 10.0));
            let mixed = (truth(u + h, v + h) - truth(u - h, v + h) - truth(u + h, v - h) + truth(u - h, v - h)) / (4.0 * h * h);
            prop_assert!(close(jet.second[1], mixed, 10.0));
        }
    }
}
