//! Whether a point lies in a solid, by counting exactly what a ray along +x passes through.

use crate::predicate::{project, side, turn2};
use glam::DVec3;
use mesh_core::{Bounds, FaceId, TriMesh};
use mesh_query::TriBvh;

/// How often the surface winds around `p`, or `None` if `p` is on it. `triangle` gives scaled triangles and `p` is
/// scaled alike; `bounds` is the unscaled ray.
pub(crate) fn winding(
    tree: &TriBvh,
    mesh: &TriMesh,
    ray: &Bounds,
    p: DVec3,
    triangle: impl Fn(FaceId) -> [DVec3; 3],
) -> Option<i32> {
    let mut near = vec![];
    tree.faces_in_box(mesh, ray, &mut near);
    let mut winding = 0;
    for f in near {
        let t = triangle(f);
        let [a, b, c] = t.map(|v| project(0, v));
        let q = project(0, p);
        // Points on an edge's line count as if the ray were shifted by (ε, ε²): every ray then misses all edges.
        let turns = [turn_shifted(a, b, q), turn_shifted(b, c, q), turn_shifted(c, a, q)];
        let way = turn2(a, b, c);
        if way == 0 {
            // Seen edge-on. The ray passes by, but the point may be on the triangle.
            if crate::contact::meet(&t, &[p, p, p]) {
                return None;
            }
            continue;
        }
        match side(&t, p) {
            0 if crate::contact::meet(&t, &[p, p, p]) => return None,
            // Ahead of p if p is behind a triangle that faces +x, or before one that faces −x.
            s if turns == [way; 3] && s * way < 0 => winding += i32::from(way),
            _ => {}
        }
    }
    Some(winding)
}

/// On which side of the line a–b the point q lies, moved by (ε, ε²) if it is on it.
fn turn_shifted(a: [f64; 2], b: [f64; 2], q: [f64; 2]) -> i8 {
    let s = turn2(a, b, q);
    if s != 0 {
        return s;
    }
    // Moving q by (ε, ε²) changes the determinant by −(by − ay)·ε + (bx − ax)·ε².
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    if dy == 0.0 {
        if dx > 0.0 { 1 } else { -1 }
    } else if dy < 0.0 {
        1
    } else {
        -1
    }
}
