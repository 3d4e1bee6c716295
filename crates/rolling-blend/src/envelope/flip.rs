//! Edges of nearly flat pairs of faces flipped until opposite angles are no more than two right ones.
//!
//! A piece cut out of a CAD mesh is full of needles; splitting those first would multiply them.

use glam::DVec3;
use mesh_core::{FaceId, TriMesh, VertexId, area_vector, triangle_normal};
use std::collections::HashMap;

/// Pairs of faces that turn by more than this keep their edge: cosine of 20 degrees.
const FLAT: f64 = 0.94;
/// Sweeps over all edges, at most.
const SWEEPS: usize = 60;

/// Flips edges between the faces from `first` on, as [`flip_needles`] does.
pub(super) fn flip_within(mesh: &mut TriMesh, first: FaceId, thin: f64, kept: impl Fn([VertexId; 2]) -> bool) {
    let faces = mesh.faces.split_off(first.index());
    let mut part = TriMesh { positions: std::mem::take(&mut mesh.positions), faces };
    flip_needles(&mut part, thin, kept);
    mesh.positions = part.positions;
    mesh.faces.append(&mut part.faces);
}

/// The ends of an edge, the lower first.
pub(super) fn sorted<T: Ord>([a, b]: [T; 2]) -> [T; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// Flips edges within the mesh; its boundary and vertices stay, and so do edges that are `kept`. Faces lower than `thin`, in
/// model units, may look anywhere, as those without area do. O(n) a sweep.
pub(super) fn flip_needles(mesh: &mut TriMesh, thin: f64, kept: impl Fn([VertexId; 2]) -> bool) {
    let key = |a: u32, b: u32| sorted([a, b]);
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
                if d == c || sides.contains_key(&key(c, d)) || !flatter([at(a), at(b), at(c), at(d)], thin) {
                    continue;
                }
                if kept(key(a, b).map(VertexId)) {
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
        *face = new.map(VertexId);
    }
}

/// Whether the edge a–b between faces abc and bad is better replaced by c–d.
fn flatter([a, b, c, d]: [DVec3; 4], thin: f64) -> bool {
    let angle = |p: DVec3| {
        let (u, v) = (a - p, b - p);
        u.cross(v).length().atan2(u.dot(v))
    };
    if angle(c) + angle(d) <= std::f64::consts::PI + 1e-6 {
        return false;
    }
    // A face without area takes any neighbour's normal.
    let before = [[a, b, c], [b, a, d]].map(|t| (height(t) > thin).then(|| triangle_normal(t)));
    let after = [[c, a, d], [d, b, c]].map(triangle_normal);
    let flat = before[0].zip(before[1]).is_none_or(|(m, n)| m.dot(n) > FLAT);
    flat && !after.contains(&DVec3::ZERO)
        && after[0].dot(after[1]) > FLAT
        && before.iter().flatten().all(|n| after.iter().all(|m| n.dot(*m) > FLAT))
}

/// The least height of a triangle; 0 where it has no area.
fn height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest > 0.0 { 2.0 * area_vector([a, b, c]).length() / longest } else { 0.0 }
}
