//! Connected components.

use crate::ids::FaceId;
use crate::map::FaceMap;
use crate::traits::Faces;

/// Which faces hang together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Components {
    /// The component of each face. Components are numbered in the order of their lowest face.
    pub labels: FaceMap<u32>,
    /// How many faces each component has.
    pub face_counts: Vec<usize>,
}

impl Components {
    /// How many components there are.
    pub fn len(&self) -> usize {
        self.face_counts.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.face_counts.is_empty()
    }

    /// The faces of each component, ascending.
    pub fn faces(&self) -> Vec<Vec<FaceId>> {
        let mut lists: Vec<Vec<FaceId>> = self.face_counts.iter().map(|&n| Vec::with_capacity(n)).collect();
        for (f, &label) in self.labels.as_slice().iter().enumerate() {
            lists[label as usize].push(FaceId::from(f));
        }
        lists
    }
}

/// Groups faces that share vertices, directly or through others. Any input; corners out of range join nothing.
///
/// On an oriented 2-manifold this is the same as sharing edges. Nearly O(n), by union-find over vertices.
pub fn components(mesh: &impl Faces) -> Components {
    let mut parents: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
    for f in mesh.face_ids() {
        let [a, b, c] = mesh.corners(f).map(|v| root(&mut parents, v.0));
        // Linking to the lower id keeps the result independent of union order.
        let low = a.min(b).min(c);
        for r in [a, b, c] {
            if let Some(parent) = parents.get_mut(r as usize) {
                *parent = low;
            }
        }
    }
    let mut names = vec![u32::MAX; mesh.vertex_count()];
    let mut found = Components::default();
    for f in mesh.face_ids() {
        let fresh = found.face_counts.len() as u32;
        let corners = mesh.corners(f);
        let inside = corners.iter().find(|v| v.index() < names.len());
        let label = inside.map_or(fresh, |v| {
            let name = &mut names[root(&mut parents, v.0) as usize];
            if *name == u32::MAX {
                *name = fresh;
            }
            *name
        });
        if label == fresh {
            found.face_counts.push(0);
        }
        found.face_counts[label as usize] += 1;
        found.labels.push(label);
    }
    found
}

/// The root of `v`, halving the path to it; `v` itself when out of range.
fn root(parents: &mut [u32], mut v: u32) -> u32 {
    while let Some(&parent) = parents.get(v as usize) {
        if parent == v {
            break;
        }
        let grandparent = parents[parent as usize];
        parents[v as usize] = grandparent;
        v = grandparent;
    }
    v
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{TriMesh, shapes};
    use glam::DVec3;

    #[test]
    fn interleaved_boxes_are_told_apart() {
        let mut mesh = TriMesh::default();
        for i in 0..3 {
            mesh.append(&shapes::cuboid(DVec3::splat(1.0 + f64::from(i))));
        }
        // Faces dealt out in turn: 0, 12, 24, 1, 13, …
        mesh.faces = (0..36).map(|i| mesh.faces[i % 3 * 12 + i / 3]).collect();
        let found = components(&mesh);
        assert_eq!(found.face_counts, [12, 12, 12]);
        assert!((0..36).all(|f| found.labels[FaceId(f)] == f % 3));
        assert_eq!(found.faces()[1][..2], [FaceId(1), FaceId(4)]);
    }

    #[test]
    fn wild_corners_are_survived() {
        let mesh = TriMesh::from_arrays(vec![DVec3::ZERO], [[7, 8, 9], [0, 0, 9], [0, 0, 0]]);
        assert_eq!(components(&mesh).face_counts, [1, 2]);
    }
}
