//! The virtual blending surface: ruled between neighbouring profiles.

use crate::error::Error;
use crate::nurbs::Nurbs;
use glam::DVec3;

/// The surface S(t, u) = (1 − s)·T_i(u) + s·T_{i+1}(u), s = (t − t_i)/(t_{i+1} − t_i), through a row of curves T_i
/// (\[Liu2005\] eq. 1). The curves' domains are all mapped to u in [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    parameters: Vec<f64>,
    curves: Vec<Nurbs>,
}

/// A point of a sweep with its first and mixed derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepPoint {
    /// S.
    pub point: DVec3,
    /// ∂S/∂t, from the right at the curves.
    pub along: DVec3,
    /// ∂S/∂u.
    pub across: DVec3,
    /// ∂²S/∂t∂u.
    pub twist: DVec3,
    /// ∂²S/∂u². (∂²S/∂t² is zero: the surface is ruled.)
    pub bend: DVec3,
}

impl SweepPoint {
    /// The unit normal ∂S/∂t × ∂S/∂u; zero where the surface is singular.
    pub fn normal(&self) -> DVec3 {
        self.along.cross(self.across).normalize_or_zero()
    }
}

impl Sweep {
    /// A surface through `curves`, the i-th at `parameters[i]`.
    ///
    /// # Errors
    /// [`Error::Sweep`] unless there are two curves or more with one strictly rising, finite parameter each.
    pub fn new(parameters: Vec<f64>, curves: Vec<Nurbs>) -> Result<Self, Error> {
        let falls = |i: usize| !parameters[i].is_finite() || i > 0 && parameters[i] <= parameters[i - 1];
        let falling = (0..parameters.len()).find(|&i| falls(i));
        if curves.len() < 2 || parameters.len() != curves.len() || falling.is_some() {
            let index = falling.unwrap_or(parameters.len());
            return Err(Error::Sweep { curves: curves.len(), parameters: parameters.len(), index });
        }
        Ok(Self { parameters, curves })
    }

    /// First and last t.
    pub fn domain(&self) -> [f64; 2] {
        [self.parameters[0], self.parameters[self.parameters.len() - 1]]
    }

    /// The curves T_i.
    pub fn curves(&self) -> &[Nurbs] {
        &self.curves
    }

    /// S(t, u), both clamped to their range. O(log curves + degree²), no allocation.
    pub fn point(&self, t: f64, u: f64) -> DVec3 {
        let (i, s) = self.locate(t);
        let [a, b] = [&self.curves[i], &self.curves[i + 1]];
        a.point(scaled(a, u)).lerp(b.point(scaled(b, u)), s)
    }

    /// S and its derivatives, both parameters clamped to their range.
    pub fn derivatives(&self, t: f64, u: f64) -> SweepPoint {
        let (i, s) = self.locate(t);
        let width = self.parameters[i + 1] - self.parameters[i];
        let [a, b] = [i, i + 1].map(|i| {
            let curve = &self.curves[i];
            let [first, last] = curve.domain();
            let d = curve.derivatives(scaled(curve, u), 2);
            [d[0], (last - first) * d[1], (last - first) * (last - first) * d[2]]
        });
        SweepPoint {
            point: a[0].lerp(b[0], s),
            along: (b[0] - a[0]) / width,
            across: a[1].lerp(b[1], s),
            twist: (b[1] - a[1]) / width,
            bend: a[2].lerp(b[2], s),
        }
    }

    /// The strip that holds t, and s within it.
    fn locate(&self, t: f64) -> (usize, f64) {
        let strips = self.parameters.len() - 1;
        let i = self.parameters.partition_point(|&p| p <= t).clamp(1, strips) - 1;
        let s = (t - self.parameters[i]) / (self.parameters[i + 1] - self.parameters[i]);
        (i, s.clamp(0.0, 1.0))
    }
}

fn scaled(curve: &Nurbs, u: f64) -> f64 {
    let [first, last] = curve.domain();
    first + u.clamp(0.0, 1.0) * (last - first)
}
