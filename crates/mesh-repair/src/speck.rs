//! Small components.

use crate::mended::Mended;
use mesh_core::{Bounds, Faces, TriMesh, components};

/// Drops components whose bounding box has a diagonal below `size`, in model units; the largest component always stays. Counts the
/// components. Corners must be in range. O(n).
///
/// ```
/// use glam::{DQuat, DVec3};
/// use mesh_core::{TriMesh, shapes};
/// let speck = shapes::posed(shapes::icosphere(0.01, 1), DQuat::IDENTITY, DVec3::X);
/// let cleaned = mesh_repair::drop_specks(&TriMesh::merged(&[shapes::cuboid(DVec3::ONE), speck]), 0.1);
/// assert_eq!((cleaned.count, cleaned.mesh.faces.len()), (1, 12));
/// ```
pub fn drop_specks(mesh: &TriMesh, size: f64) -> Mended {
    let parts = components(mesh);
    let mut boxes = vec![Bounds::EMPTY; parts.len()];
    for f in mesh.face_ids() {
        let part = parts.labels[f] as usize;
        boxes[part] = boxes[part].union(Bounds::of(mesh.triangle(f)));
    }
    let diagonals: Vec<f64> = boxes.iter().map(Bounds::diagonal).collect();
    let largest = (0..diagonals.len()).max_by(|&a, &b| diagonals[a].total_cmp(&diagonals[b]).then(b.cmp(&a)));
    let small: Vec<bool> = (0..diagonals.len()).map(|i| diagonals[i] < size && Some(i) != largest).collect();
    let kept = Mended::kept(mesh, |f| !small[parts.labels[f] as usize]);
    Mended { count: small.iter().filter(|&&s| s).count(), ..kept }
}
