//! The zero set of a dense grid of samples.

use crate::extract::extract;
use crate::grid::{Grid, Surface, corner};
use glam::{DVec3, IVec3};
use mesh_core::TriMesh;

/// The zero set of the trilinear interpolant of samples on a grid, positive side outward: closed but for where it leaves
/// the grid, manifold, and of the interpolant's topology in every cell (\[Chernyaev1995\]; zeros count as positive).
///
/// `values` runs along x first; `counts` says how many samples there are along each axis, `cell` apart. Empty if the
/// numbers do not fit each other. O(n).
pub fn isosurface(values: &[f64], counts: [usize; 3], origin: DVec3, cell: f64) -> TriMesh {
    let [nx, ny, nz] = counts;
    let fits = nx.checked_mul(ny).and_then(|n| n.checked_mul(nz)) == Some(values.len());
    if !fits || counts.iter().any(|&n| n < 2) || u32::try_from(values.len()).is_err() {
        return TriMesh::default();
    }
    let index = |k: IVec3| (k.x as usize + nx * (k.y as usize + ny * k.z as usize)) as u32;
    let all =
        |n: [usize; 3]| (0..n[2]).flat_map(move |z| (0..n[1]).flat_map(move |y| (0..n[0]).map(move |x| [x, y, z])));
    let place = |n: [usize; 3]| IVec3::from(n.map(|x| (x as u32).cast_signed()));
    let mut surface =
        Surface { nodes: all(counts).map(place).collect(), values: values.to_vec(), ..Surface::default() };
    for k in all(counts.map(|n| n - 1)).map(place) {
        let nodes: [u32; 8] = std::array::from_fn(|c| index(corner(k, c)));
        let negative = nodes.iter().filter(|&&n| values[n as usize] < 0.0).count();
        if negative != 0 && negative != 8 {
            surface.cells.push(nodes);
        }
    }
    extract(&|_: &[DVec3], _: &mut [f64]| (), &Grid { origin, size: cell }, &surface, 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{Connected, topology, validate};
    use proptest::prelude::*;

    proptest! {
        /// White noise has every ambiguity at every corner; inside a positive shell its zero set is closed.
        #[test]
        fn noise_has_a_closed_manifold(noise in prop::collection::vec(-1.0f64..1.0, 6 * 6 * 6)) {
            let mut values = vec![1.0; 8 * 8 * 8];
            for (i, v) in noise.into_iter().enumerate() {
                values[(i % 6 + 1) + 8 * (i / 6 % 6 + 1) + 64 * (i / 36 + 1)] = v;
            }
            let mesh = isosurface(&values, [8, 8, 8], DVec3::ZERO, 1.0);
            prop_assert!(validate(&mesh).is_closed());
        }
    }

    #[test]
    fn a_torus_has_its_genus_and_wrong_numbers_give_nothing() {
        let n = 40;
        let at = |i: usize| 0.1 * DVec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64) - 1.95;
        let values: Vec<f64> = (0..n * n * n).map(|i| (at(i).truncate().length() - 1.2).hypot(at(i).z) - 0.4).collect();
        let mesh = isosurface(&values, [n; 3], DVec3::splat(-1.95), 0.1);
        assert!(mesh.positions.iter().all(|p| ((p.truncate().length() - 1.2).hypot(p.z) - 0.4).abs() < 0.01));
        let counts = topology(&Connected::new(mesh).unwrap());
        assert_eq!((counts.genus(), counts.components, counts.boundary_loops), (1, 1, 0));
        assert_eq!(isosurface(&values, [n, n, n + 1], DVec3::ZERO, 0.1), TriMesh::default());
        assert_eq!(isosurface(&[], [usize::MAX, 3, 0], DVec3::ZERO, 0.1), TriMesh::default());
    }
}
