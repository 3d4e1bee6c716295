//! Two models in a random pose, overlapping.

use glam::DQuat;
use mesh_core::{TriMesh, bounds};

/// Turns both at random, scales the second to 60–100% of the first's diagonal and puts its middle on a vertex of the
/// first. The same seed gives the same pose.
pub fn overlapping(mut a: TriMesh, mut b: TriMesh, seed: u64) -> [TriMesh; 2] {
    let mut random = SplitMix(seed);
    for mesh in [&mut a, &mut b] {
        let turn = random.rotation();
        let center = bounds(mesh).center();
        mesh.positions.iter_mut().for_each(|p| *p = turn * (*p - center));
    }
    let sizes = [&a, &b].map(|m| bounds(m).diagonal());
    let scale = (0.6 + 0.4 * random.unit()) * sizes[0] / sizes[1];
    let at = a.positions[(random.unit() * a.positions.len() as f64) as usize];
    b.positions.iter_mut().for_each(|p| *p = at + scale * *p);
    [a, b]
}

/// The SplitMix64 generator: seeds need no warming up.
pub struct SplitMix(pub u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A uniformly random rotation: a random direction in four dimensions, by rejection from the cube.
    pub fn rotation(&mut self) -> DQuat {
        loop {
            let q = DQuat::from_array([(); 4].map(|()| 2.0 * self.unit() - 1.0));
            if (1e-3..=1.0).contains(&q.length_squared()) {
                return q.normalize();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::shapes;

    #[test]
    fn poses_repeat_and_overlap() {
        let parts = || (shapes::cuboid(DVec3::ONE), shapes::icosphere(7.0, 2));
        let [a, b] = overlapping(parts().0, parts().1, 5);
        assert_eq!([a.clone(), b.clone()], overlapping(parts().0, parts().1, 5));
        assert_ne!([a.clone(), b.clone()], overlapping(parts().0, parts().1, 6));
        assert!(bounds(&a).overlaps(&bounds(&b)));
        let ratio = bounds(&b).diagonal() / bounds(&a).diagonal();
        assert!((0.5..=1.1).contains(&ratio), "{ratio}");
        assert!(a.positions.iter().any(|p| p.distance(bounds(&b).center()) < 0.05));
    }
}
