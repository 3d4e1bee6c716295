//! The embedding of a regular polygon into a simplex: l_1, …, l_m with derivatives (\[LoopDeRose1989\], eq. 6 of
//! \[EdgeCluster2019\]).

use glam::DVec2;
use std::f64::consts::TAU;
use std::ops::{Add, Mul};

/// A regular m-gon around the origin, corners at distance one, counter-clockwise.
#[derive(Clone, Debug)]
pub struct Polygon {
    corners: Vec<DVec2>,
    /// Outward unit normal of each side, and its distance from the origin.
    normals: Vec<DVec2>,
    apothem: f64,
}

/// Points evaluated side by side, so that the compiler can use vector registers.
pub(crate) const LANES: usize = 8;
/// One number for each of them.
pub(crate) type Lanes = [f64; LANES];

/// A value and its derivatives by x, y, xx, xy, yy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet(pub [f64; 6]);

impl Polygon {
    /// The polygon with `sides` ≥ 3 corners.
    pub fn new(sides: usize) -> Self {
        let turn = |k: f64| DVec2::from_angle(TAU * k / sides as f64);
        Self {
            corners: (0..sides).map(|k| turn(k as f64)).collect(),
            normals: (0..sides).map(|k| turn(k as f64 + 0.5)).collect(),
            apothem: (0.5 * TAU / sides as f64).cos(),
        }
    }

    /// How many sides.
    pub fn sides(&self) -> usize {
        self.corners.len()
    }

    /// Corner k, counting from 0.
    pub fn corner(&self, k: usize) -> DVec2 {
        self.corners[k % self.corners.len()]
    }

    /// l_k for all k at `LANES` points side by side. The signed areas σ_k are taken as distances from the sides, which all
    /// areas are in the same proportion to. O(m²). `sigma` and `out` hold m entries each.
    #[inline]
    pub(crate) fn embed_lanes(&self, x: &Lanes, y: &Lanes, sigma: &mut [Lanes], out: &mut [Lanes]) {
        let m = self.corners.len();
        for (s, n) in sigma.iter_mut().zip(&self.normals) {
            for lane in 0..LANES {
                s[lane] = self.apothem - (n.x * x[lane] + n.y * y[lane]);
            }
        }
        let mut sum = [0.0; LANES];
        for (k, l) in out.iter_mut().enumerate().take(m) {
            // Every side but the two that meet in corner k.
            let mut product = [1.0; LANES];
            for i in k + 1..k + m - 1 {
                let s = &sigma[if i < m { i } else { i - m }];
                for lane in 0..LANES {
                    product[lane] *= s[lane];
                }
            }
            for lane in 0..LANES {
                sum[lane] += product[lane];
            }
            *l = product;
        }
        let whole = sum.map(|s| 1.0 / s);
        for l in out.iter_mut().take(m) {
            for lane in 0..LANES {
                l[lane] *= whole[lane];
            }
        }
    }

    /// l_k at `p` for all k.
    pub fn embed(&self, p: DVec2) -> Vec<f64> {
        let mut rows = vec![[0.0; LANES]; 2 * self.sides()];
        let (sigma, out) = rows.split_at_mut(self.sides());
        self.embed_lanes(&[p.x; LANES], &[p.y; LANES], sigma, out);
        out.iter().map(|l| l[0]).collect()
    }

    /// l_k at `p` with first and second derivatives.
    pub fn embed_jets(&self, p: DVec2) -> Vec<Jet> {
        let m = self.corners.len();
        let sigma: Vec<Jet> =
            self.normals.iter().map(|n| Jet([self.apothem - n.dot(p), -n.x, -n.y, 0.0, 0.0, 0.0])).collect();
        let pi: Vec<Jet> =
            (0..m).map(|k| (1..m - 1).fold(Jet::ONE, |product, i| product * sigma[(k + i) % m])).collect();
        let whole = pi.iter().fold(Jet::default(), |a, &b| a + b).reciprocal();
        pi.into_iter().map(|p| p * whole).collect()
    }
}

impl Jet {
    const ONE: Self = Self([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);

    fn reciprocal(self) -> Self {
        let [v, x, y, xx, xy, yy] = self.0;
        let r = 1.0 / v;
        let (r2, r3) = (r * r, 2.0 * r * r * r);
        Self([r, -x * r2, -y * r2, x * x * r3 - xx * r2, x * y * r3 - xy * r2, y * y * r3 - yy * r2])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + o.0[i]))
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let ([a, ax, ay, axx, axy, ayy], [b, bx, by, bxx, bxy, byy]) = (self.0, o.0);
        Self([
            a * b,
            ax * b + a * bx,
            ay * b + a * by,
            axx * b + 2.0 * ax * bx + a * bxx,
            axy * b + ax * by + ay * bx + a * bxy,
            ayy * b + 2.0 * ay * by + a * byy,
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedding_is_a_pseudo_affine_partition_of_unity() {
        for m in 3..=9 {
            let polygon = Polygon::new(m);
            for p in [DVec2::ZERO, DVec2::new(0.2, 0.1), DVec2::new(-0.3, 0.35), DVec2::new(0.05, -0.4)] {
                let l = polygon.embed(p);
                assert!((l.iter().sum::<f64>() - 1.0).abs() < 1e-14 && l.iter().all(|&x| x > 0.0));
                // Wachspress' coordinates reproduce the point.
                let back: DVec2 = l.iter().enumerate().map(|(k, &w)| w * polygon.corner(k)).sum();
                assert!(back.distance(p) < 1e-14, "{m}: {back} for {p}");
            }
            // Linear along a side.
            let l = polygon.embed(polygon.corner(1).lerp(polygon.corner(2), 0.3));
            assert!((l[1] - 0.7).abs() < 1e-14 && (l[2 % m] - 0.3).abs() < 1e-14);
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let (polygon, p, h) = (Polygon::new(6), DVec2::new(0.31, -0.22), 1e-4);
        let value = |x: f64, y: f64| polygon.embed(p + DVec2::new(x, y));
        let [c, e, w, n, s] = [value(0.0, 0.0), value(h, 0.0), value(-h, 0.0), value(0.0, h), value(0.0, -h)];
        let [ne, nw, se, sw] = [value(h, h), value(-h, h), value(h, -h), value(-h, -h)];
        for (k, jet) in polygon.embed_jets(p).iter().enumerate() {
            let truth = [
                c[k],
                (e[k] - w[k]) / (2.0 * h),
                (n[k] - s[k]) / (2.0 * h),
                (e[k] - 2.0 * c[k] + w[k]) / (h * h),
                (ne[k] - nw[k] - se[k] + sw[k]) / (4.0 * h * h),
                (n[k] - 2.0 * c[k] + s[k]) / (h * h),
            ];
            assert!(jet.0.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-6), "{jet:?} {truth:?}");
        }
    }
}
