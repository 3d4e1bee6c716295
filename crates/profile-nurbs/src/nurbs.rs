//! Rational B-spline curves: checked construction, evaluation, derivatives.

use crate::error::Error;
use glam::{DVec3, DVec4};

/// A rational B-spline curve (\[PieglTiller1997\] ch. 4). Immutable, and always sound once made.
#[derive(Clone, Debug, PartialEq)]
pub struct Nurbs {
    pub(crate) degree: usize,
    pub(crate) knots: Vec<f64>,
    /// Control points times weight, and weight.
    pub(crate) lifted: Vec<DVec4>,
}

/// Degrees below this are evaluated without allocation.
const STACK: usize = 12;

impl Nurbs {
    /// A curve of `degree` ≥ 1 with one weight per point and `points + degree + 1` knots, clamped or not.
    ///
    /// # Errors
    /// [`Error::Counts`], [`Error::Knot`], [`Error::Weight`] or [`Error::NotFinite`], naming the first offender.
    ///
    /// ```
    /// use profile_nurbs::{Error, Nurbs};
    /// let line = [glam::DVec3::ZERO, glam::DVec3::X];
    /// assert!(Nurbs::new(1, &[0.0, 0.0, 1.0, 1.0], &line, &[1.0, 1.0]).is_ok());
    /// let refused = Nurbs::new(1, &[0.0, 0.0, 1.0, 1.0], &line, &[1.0, -1.0]);
    /// assert_eq!(refused, Err(Error::Weight { index: 1, value: -1.0 }));
    /// ```
    pub fn new(degree: usize, knots: &[f64], points: &[DVec3], weights: &[f64]) -> Result<Self, Error> {
        let counts = Error::Counts { degree, points: points.len(), weights: weights.len(), knots: knots.len() };
        let enough = degree >= 1 && points.len() > degree && weights.len() == points.len();
        if !enough || knots.len() - points.len() != degree + 1 || knots.len() < points.len() {
            return Err(counts);
        }
        let bad_knot = |index| Error::Knot { index, value: knots[index] };
        if let Some(i) = (0..knots.len()).find(|&i| !knots[i].is_finite() || i > 0 && knots[i] < knots[i - 1]) {
            return Err(bad_knot(i));
        }
        let (first, last) = (knots[degree], knots[points.len()]);
        if first >= last {
            return Err(bad_knot(points.len()));
        }
        for i in 0..knots.len() {
            let inside = first < knots[i] && knots[i] < last;
            let most = if inside { degree } else { degree + 1 };
            if knots.get(i + most).is_some_and(|&k| k == knots[i]) {
                return Err(bad_knot(i));
            }
        }
        if let Some(i) = (0..points.len()).find(|&i| !points[i].is_finite()) {
            return Err(Error::NotFinite { index: i, point: points[i] });
        }
        if let Some(i) = (0..points.len()).find(|&i| !(weights[i] > 0.0 && weights[i].is_finite())) {
            return Err(Error::Weight { index: i, value: weights[i] });
        }
        let lifted = points.iter().zip(weights).map(|(&p, &w)| (w * p).extend(w)).collect();
        Ok(Self { degree, knots: knots.to_vec(), lifted })
    }

    /// A single rational Bézier segment over [0, 1], of degree `points.len() − 1`.
    ///
    /// # Errors
    /// As [`Nurbs::new`].
    pub fn bezier(points: &[DVec3], weights: &[f64]) -> Result<Self, Error> {
        let n = points.len();
        let knots: Vec<f64> = (0..2 * n).map(|i| if i < n { 0.0 } else { 1.0 }).collect();
        Self::new(n.saturating_sub(1), &knots, points, weights)
    }

    /// For curves that are sound by construction: clamped Bézier pieces of equal length over [0, 1].
    pub(crate) fn from_pieces(degree: usize, points: &[DVec3], weights: &[f64]) -> Self {
        let pieces = (points.len() - 1) / degree;
        let mut knots = vec![0.0];
        (0..=pieces).for_each(|i| knots.extend(std::iter::repeat_n(i as f64 / pieces as f64, degree)));
        knots.push(1.0);
        let lifted = points.iter().zip(weights).map(|(&p, &w)| (w * p).extend(w)).collect();
        Self { degree, knots, lifted }
    }

    /// Highest power of the parameter.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The knots, never falling.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The control points.
    pub fn control_points(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        self.lifted.iter().map(|&p| project(p))
    }

    /// The weights, all positive.
    pub fn weights(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.lifted.iter().map(|p| p.w)
    }

    /// First and last parameter.
    pub fn domain(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.lifted.len()]]
    }

    /// The same curve in another affine frame: `map` must be affine. Weights and knots stay.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        let lifted = self.lifted.iter().map(|&p| (p.w * map(project(p))).extend(p.w)).collect();
        Self { lifted, knots: self.knots.clone(), degree: self.degree }
    }

    /// The point at `u`, clamped to the domain. O(degree²), no allocation below degree 12.
    pub fn point(&self, u: f64) -> DVec3 {
        let (u, span) = self.locate(u);
        self.with_local(span, |local| project(self.de_boor(local, span, u)))
    }

    /// The curve and its derivatives by `u` up to `order`, at `u` clamped to the domain: `order + 1` vectors, from the
    /// right at knots and from the left at the end. O(order·(degree² + order)).
    pub fn derivatives(&self, u: f64, order: usize) -> Vec<DVec3> {
        let (u, span) = self.locate(u);
        let lifted: Vec<DVec4> = self.with_local(span, |local| {
            let mut local = local;
            let mut all = Vec::with_capacity(order + 1);
            for _ in 0..=order {
                if local.is_empty() {
                    all.push(DVec4::ZERO);
                    continue;
                }
                let mut scratch = local.to_vec();
                all.push(self.de_boor(&mut scratch, span, u));
                // The control points of the derivative, one fewer and one degree lower on the same knots.
                let q = local.len() - 1;
                for i in 0..q {
                    let width = self.knots[span + 1 + i] - self.knots[span + 1 + i - q];
                    local[i] = (q as f64 / width) * (local[i + 1] - local[i]);
                }
                local = &mut local[..q];
            }
            all
        });
        // Leibniz' rule on (curve · weight), solved for the curve.
        let mut curve: Vec<DVec3> = Vec::with_capacity(order + 1);
        for k in 0..=order {
            let mut sum = lifted[k].truncate();
            let mut binomial = 1.0;
            for i in 1..=k {
                binomial *= (k + 1 - i) as f64 / i as f64;
                sum -= binomial * lifted[i].w * curve[k - i];
            }
            curve.push(sum / lifted[0].w);
        }
        curve
    }

    /// `u` clamped to the domain, and the index of the last knot of positive span that is not after it.
    pub(crate) fn locate(&self, u: f64) -> (f64, usize) {
        let [first, last] = self.domain();
        let u = u.clamp(first, last);
        let after = self.knots.partition_point(|&k| k <= u);
        let mut span = after.clamp(self.degree + 1, self.lifted.len()) - 1;
        while span > self.degree && self.knots[span] == self.knots[span + 1] {
            span -= 1;
        }
        (u, span)
    }

    /// Hands a scratch copy of the control points that matter in `span`.
    fn with_local<R>(&self, span: usize, work: impl FnOnce(&mut [DVec4]) -> R) -> R {
        let local = &self.lifted[span - self.degree..=span];
        if local.len() <= STACK {
            let mut stack = [DVec4::ZERO; STACK];
            stack[..local.len()].copy_from_slice(local);
            work(&mut stack[..local.len()])
        } else {
            work(&mut local.to_vec())
        }
    }

    /// De Boor's triangle on the local points of a curve of degree `local.len() − 1` over this curve's knots.
    fn de_boor(&self, local: &mut [DVec4], span: usize, u: f64) -> DVec4 {
        let q = local.len() - 1;
        for level in 1..=q {
            for i in (level..=q).rev() {
                let (left, right) = (self.knots[span + i - q], self.knots[span + 1 + i - level]);
                local[i] = local[i - 1].lerp(local[i], (u - left) / (right - left));
            }
        }
        local[q]
    }
}

pub(crate) fn project(p: DVec4) -> DVec3 {
    p.truncate() / p.w
}
