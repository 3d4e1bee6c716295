//! Planes, and where several of them meet.

use glam::DVec3;

/// A plane `normal · x = offset`, its normal of length one and pointing out of the solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit normal.
    pub normal: DVec3,
    /// Distance of the plane from the origin along the normal, in model units.
    pub offset: f64,
}

impl Plane {
    /// The plane through `point`; `None` where `normal` has no direction.
    pub fn new(normal: DVec3, point: DVec3) -> Option<Self> {
        let normal = normal.try_normalize()?;
        Some(Self { normal, offset: normal.dot(point) })
    }

    /// Signed distance of `p`, positive outside.
    #[inline]
    pub fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// Two unit vectors in the plane; with the normal they are right-handed.
    pub fn axes(&self) -> [DVec3; 2] {
        let u = self.normal.any_orthonormal_vector();
        [u, self.normal.cross(u)]
    }
}

/// The point, line, plane or whole space in which some planes meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flat {
    /// A point of it.
    pub origin: DVec3,
    /// Orthonormal directions; the first [`Flat::dimension`] span it.
    pub axes: [DVec3; 3],
    /// 0 for a point, 1 for a line, 2 for a plane, 3 for space.
    pub dimension: usize,
}

/// Squared sine of the angle below which two planes count as parallel: about 0.002°.
const PARALLEL: f64 = 1e-9;

impl Flat {
    /// Where `planes` meet, with its origin as near to `near` as it can be. `None` if they have no common point to
    /// within `tolerance`, in model units.
    pub fn meet(planes: &[Plane], near: DVec3, tolerance: f64) -> Option<Self> {
        let (axes, values) = eigen(planes.iter().map(|p| p.normal));
        let dimension = values.iter().filter(|&&v| v < PARALLEL).count();
        let mut origin = near;
        // The second step removes what the first one rounded.
        for _ in 0..3 {
            let pull = planes.iter().map(|p| p.height(origin) * p.normal).sum::<DVec3>();
            origin -= (dimension..3).map(|i| axes[i].dot(pull) / values[i] * axes[i]).sum::<DVec3>();
        }
        let met = origin.is_finite() && planes.iter().all(|p| p.height(origin).abs() <= tolerance);
        met.then_some(Self { origin, axes, dimension })
    }

    /// A single point.
    pub fn point(origin: DVec3) -> Self {
        Self { origin, axes: DVec3::AXES, dimension: 0 }
    }

    /// The point of it nearest to `p`.
    #[inline]
    pub fn nearest(&self, p: DVec3) -> DVec3 {
        self.origin + self.along(p - self.origin)
    }

    /// The part of a vector that lies in its directions.
    #[inline]
    pub fn along(&self, v: DVec3) -> DVec3 {
        match self.dimension {
            0 => DVec3::ZERO,
            1 => self.axes[0].dot(v) * self.axes[0],
            2 => v - self.axes[2].dot(v) * self.axes[2],
            _ => v,
        }
    }
}

/// Eigenvectors and eigenvalues, ascending, of Σ n nᵀ, by cyclic Jacobi rotations.
fn eigen(normals: impl Iterator<Item = DVec3>) -> ([DVec3; 3], [f64; 3]) {
    let mut m = [[0.0; 3]; 3];
    for n in normals {
        let n = n.to_array();
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += n[i] * n[j];
            }
        }
    }
    let mut axes = DVec3::AXES;
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut m {
                let (a, b) = (row[p], row[q]);
                (row[p], row[q]) = (c * a - s * b, s * a + c * b);
            }
            let (a, b) = (DVec3::from(m[p]), DVec3::from(m[q]));
            (m[p], m[q]) = ((c * a - s * b).to_array(), (s * a + c * b).to_array());
            (axes[p], axes[q]) = (c * axes[p] - s * axes[q], s * axes[p] + c * axes[q]);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| m[i][i].total_cmp(&m[j][j]));
    (order.map(|i| axes[i]), order.map(|i| m[i][i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn plane(n: [f64; 3], through: DVec3) -> Plane {
        Plane::new(n.into(), through).unwrap()
    }

    #[test]
    fn planes_meet_in_what_geometry_says() {
        let at = DVec3::new(1.0, 2.0, 3.0);
        let all = [plane([1.0, 0.0, 0.0], at), plane([0.0, 1.0, 0.2], at), plane([0.3, 0.0, 1.0], at)];
        for count in 0..=3 {
            let flat = Flat::meet(&all[..count], DVec3::new(9.0, -4.0, 2.0), 1e-12).unwrap();
            assert_eq!(flat.dimension, 3 - count);
            assert!(all[..count].iter().all(|p| p.height(flat.nearest(DVec3::splat(7.0))).abs() < 1e-14));
        }
        assert!(Flat::meet(&all, DVec3::ZERO, 1e-12).unwrap().origin.distance(at) < 1e-14);
        let apart = [plane([1.0, 0.0, 0.0], at), plane([-1.0, 0.0, 0.0], DVec3::ZERO)];
        assert_eq!(Flat::meet(&apart, at, 1e-12), None);
    }

    proptest! {
        /// The nearest point is in every plane, and what is left is at right angles to the flat.
        #[test]
        fn nearest_is_nearest(n in prop::array::uniform2(prop::array::uniform3(-1.0..1.0f64)), p in prop::array::uniform3(-5.0..5.0f64)) {
            let planes = n.map(|n| plane([n[0], n[1], n[2] + 2.0], DVec3::ONE));
            prop_assume!(planes[0].normal.cross(planes[1].normal).length() > 1e-2);
            let (flat, p) = (Flat::meet(&planes, DVec3::ZERO, 1e-9).unwrap(), p.into());
            let q = flat.nearest(p);
            prop_assert_eq!(flat.dimension, 1);
            prop_assert!(planes.iter().all(|n| n.height(q).abs() < 1e-12));
            prop_assert!((p - q).dot(flat.axes[0]).abs() < 1e-12);
        }
    }
}
