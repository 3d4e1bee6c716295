//! Edges of nearly flat pairs of faces flipped until opposite angles are no more than two right ones.
//!
//! A piece cut out of a CAD mesh is full of needles; splitting those first would multiply them.

use glam::DVec3;
use mesh_core::{TriMesh, triangle_normal};
use std::collections::HashMap;

/// Pairs of faces that turn by more than this keep their edge: cosine of 20 degrees.
const FLAT: f64 = 0.94;
/// Sweeps over all edges, at most.
const SWEEPS: usize = 60;

/// Flips edges within the mesh; its boundary and vertices stay. O(n) a sweep.
pub(super) fn flip_needles(mesh: &mut TriMesh) {
    let key = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut faces: Vec<[u32; 3]> = mesh.faces.iter().map(|f| f.map(|v| v.0)).collect();
    let mut sides: HashMap<[u32; 2], [u32; 2]> = HashMap::new();
    for (f, face) in (0u32..).zip(&faces) {
        for k in 0..3 {
            let pair = sides.entry(key(face[k], face[(k + 1) % 3])).or_insert([u32::MAX; 2]);
            let free = usize::from(pair[0] != u32::MAX);
            pair[free] = f;
        }
    }
    let points = &mesh.positions;
    let at = |v: u32| points[v as usize];
    let mut changed = true;
    for _ in 0..SWEEPS {
        if !std::mem::replace(&mut changed, false) {
            break;
        }
        for f in 0..faces.len() {
            for k in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|i| faces[f][(k + i) % 3]);
                let Some(&pair) = sides.get(&key(a, b)).filter(|p| p[1] != u32::MAX) else { continue };
                let g = if pair[0] as usize == f { pair[1] } else { pair[0] } as usize;
                let Some(d) = faces[g].iter().copied().find(|&v| v != a && v != b) else { continue };
                if d == c || sides.contains_key(&key(c, d)) || !flatter([at(a), at(b), at(c), at(d)]) {
                    continue;
                }
                faces[f] = [c, a, d];
                faces[g] = [d, b, c];
                sides.remove(&key(a, b));
                sides.insert(key(c, d), [f as u32, g as u32]);
                for (edge, from, to) in [(key(a, d), g, f), (key(b, c), f, g)] {
                    if let Some(pair) = sides.get_mut(&edge) {
                        pair.iter_mut().filter(|p| **p == from as u32).for_each(|p| *p = to as u32);
                    }
                }
                changed = true;
                break;
            }
        }
    }
    for (face, new) in mesh.faces.iter_mut().zip(faces) {
        *face = new.map(mesh_core::VertexId);
    }
}

/// Whether the edge a–b between faces abc and bad is better replaced by c–d.
fn flatter([a, b, c, d]: [DVec3; 4]) -> bool {
    let angle = |p: DVec3| {
        let (u, v) = (a - p, b - p);
        u.cross(v).length().atan2(u.dot(v))
    };
    if angle(c) + angle(d) <= std::f64::consts::PI + 1e-6 {
        return false;
    }
    let before = [triangle_normal([a, b, c]), triangle_normal([b, a, d])];
    let after = [triangle_normal([c, a, d]), triangle_normal([d, b, c])];
    let zero = |n: &DVec3| *n == DVec3::ZERO;
    // A face without area takes any neighbour's normal.
    let flat = before.iter().any(zero) || before[0].dot(before[1]) > FLAT;
    flat && !after.iter().any(zero)
        && after[0].dot(after[1]) > FLAT
        && before.iter().filter(|n| !zero(n)).all(|n| after.iter().all(|m| n.dot(*m) > FLAT))
}
