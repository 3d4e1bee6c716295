//! How far one mesh stands above another.

use glam::{DVec2, DVec3};
use mesh_core::{FaceId, Faces, Positions, TriMesh};
use mesh_query::TriBvh;

/// How far `part` comes down along −z, from high above, before it first touches `ground`, in model units: negative where it
/// must go up. `None` where nothing of the ground is below it.
///
/// The height between two triangles is linear where both are above a place, so it is least at a corner of what their outlines
/// share; triangles that stand upright have no outline, but their ends belong to others. O(pairs of overlapping boxes).
pub(crate) fn height_above(part: &TriMesh, ground: &TriMesh) -> Option<f64> {
    let (flat_part, flat_ground) = (flat(part), flat(ground));
    let tree = |mesh: &TriMesh| TriBvh::build(mesh).ok();
    let pairs = tree(&flat_part)?.overlapping_pairs(&flat_part, &tree(&flat_ground)?, &flat_ground);
    let heights = pairs.into_iter().filter_map(|[f, g]| between(triangle(part, f), triangle(ground, g)));
    heights.reduce(f64::min)
}

/// The mesh with every height 0.
fn flat(mesh: &TriMesh) -> TriMesh {
    let positions = mesh.positions.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
    TriMesh { positions, faces: mesh.faces.clone() }
}

fn triangle(mesh: &TriMesh, f: FaceId) -> [DVec3; 3] {
    mesh.corners(f).map(|v| mesh.position(v))
}

/// The least height of one triangle above another where both have a point on the same upright line.
fn between(upper: [DVec3; 3], lower: [DVec3; 3]) -> Option<f64> {
    let (upper, lower) = (counter_clockwise(upper)?, counter_clockwise(lower)?);
    let mut shared: Vec<DVec2> = upper.iter().map(|p| p.truncate()).collect();
    for k in 0..3 {
        let (a, b) = (lower[k].truncate(), lower[(k + 1) % 3].truncate());
        shared = left_of(&shared, a, b);
    }
    let height = |p: &DVec2| Some(at(&upper, *p)? - at(&lower, *p)?);
    shared.iter().filter_map(height).reduce(f64::min)
}

/// The triangle as seen from above, counter-clockwise; `None` for one that stands upright.
fn counter_clockwise(t: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let area = (t[1] - t[0]).truncate().perp_dot((t[2] - t[0]).truncate());
    match area {
        area if area > 0.0 => Some(t),
        area if area < 0.0 => Some([t[0], t[2], t[1]]),
        _ => None,
    }
}

/// The part of a convex polygon to the left of a line, or on it.
fn left_of(polygon: &[DVec2], a: DVec2, b: DVec2) -> Vec<DVec2> {
    let side = |p: DVec2| (b - a).perp_dot(p - a);
    let mut kept = vec![];
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (of_p, of_q) = (side(p), side(q));
        if of_p >= 0.0 {
            kept.push(p);
        }
        if (of_p > 0.0 && of_q < 0.0) || (of_p < 0.0 && of_q > 0.0) {
            kept.push(p + (q - p) * (of_p / (of_p - of_q)));
        }
    }
    kept
}

/// The height of a triangle's plane at a place.
fn at(t: &[DVec3; 3], p: DVec2) -> Option<f64> {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]);
    let height = t[0].z - normal.truncate().dot(p - t[0].truncate()) / normal.z;
    height.is_finite().then_some(height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use mesh_core::shapes;

    fn at(mesh: TriMesh, x: f64, y: f64, z: f64) -> TriMesh {
        shapes::posed(mesh, DQuat::IDENTITY, DVec3::new(x, y, z))
    }

    #[test]
    fn a_cube_comes_down_onto_a_cube() {
        let cube = shapes::cuboid(DVec3::ONE);
        let up = at(cube.clone(), 0.3, 0.2, 5.0);
        assert!((height_above(&up, &cube).unwrap() - 4.0).abs() < 1e-12);
        // Wherever it starts.
        assert!((height_above(&at(cube.clone(), 0.3, 0.2, -5.0), &cube).unwrap() + 6.0).abs() < 1e-12);
        assert_eq!(height_above(&at(cube.clone(), 2.0, 0.0, 5.0), &cube), None);
    }

    /// Two bars across each other touch at edges alone, far from any vertex.
    #[test]
    fn edges_that_cross_touch_first() {
        let roof = |length: DVec3, ridge: f64| {
            let side = DVec3::Z.cross(length).normalize();
            let p = |along: f64, across: f64, z: f64| along * length + across * side + z * DVec3::Z;
            let positions = vec![
                p(-1.0, 0.0, 0.0),
                p(1.0, 0.0, 0.0),
                p(-1.0, 1.0, ridge),
                p(1.0, 1.0, ridge),
                p(-1.0, -1.0, ridge),
                p(1.0, -1.0, ridge),
            ];
            TriMesh::from_arrays(positions, [[0, 1, 3], [0, 3, 2], [1, 0, 4], [1, 4, 5]])
        };
        let (keel, ridge) = (at(roof(3.0 * DVec3::X, 1.0), 0.2, 0.1, 7.0), roof(3.0 * DVec3::Y, -1.0));
        assert!((height_above(&keel, &ridge).unwrap() - 7.0).abs() < 1e-12);
    }
}
