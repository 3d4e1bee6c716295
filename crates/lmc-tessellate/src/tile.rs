//! Triangles for the surfaces of a cell.

use crate::bridge::{irregularity, polygon, strip};
use crate::cell::{Contours, axis, contours, low_corner, share_face, signs};
use glam::DVec3;
use std::borrow::Cow;
use std::sync::OnceLock;

/// Triangles over the points on the cell's edges (0–11) and points within it (12 on).
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tiling {
    pub triangles: Vec<[u8; 3]>,
    pub inner: Vec<Inner>,
}

/// A point within a cell: the middle between `near` and the mean of `all`, points on edges.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Inner {
    pub near: Option<u8>,
    pub all: Vec<u8>,
}

/// The tiling of a cell by its corner values. Patterns without ambiguity come from a table made on first use.
pub(crate) fn tiling(values: &[f64; 8]) -> Cow<'static, Tiling> {
    static PLAIN: OnceLock<Vec<Option<Tiling>>> = OnceLock::new();
    let table = PLAIN.get_or_init(|| (0..=255).map(plain).collect());
    match &table[usize::from(signs(values))] {
        Some(known) => Cow::Borrowed(known),
        None => Cow::Owned(tile(&contours(values))),
    }
}

/// The tiling of a sign pattern that allows one topology only: one curve at most, whatever the magnitudes.
fn plain(mask: u8) -> Option<Tiling> {
    let sign = |i: usize| if mask >> i & 1 == 1 { -1.0 } else { 1.0 };
    // One magnitude joins the negatives of every ambiguous face, the other the positives.
    let [wide, narrow] = [2.0, 0.5].map(|m| contours(&std::array::from_fn(|i| if sign(i) < 0.0 { -m } else { 1.0 })));
    (wide == narrow && wide.curves.len() < 2).then(|| tile(&wide))
}

fn tile(found: &Contours) -> Tiling {
    let mut tiling = Tiling::default();
    for (i, curve) in found.curves.iter().enumerate() {
        let label = found.surfaces[i];
        if usize::from(label) != i {
            continue;
        }
        match (i + 1..found.curves.len()).find(|&j| found.surfaces[j] == label) {
            Some(other) => tunnel(curve, &found.curves[other], &mut tiling),
            None => disc(curve, &mut tiling),
        }
    }
    tiling
}

fn nominal(edge: u8) -> DVec3 {
    let low = low_corner(edge as usize);
    let mut p = DVec3::new((low & 1) as f64, (low >> 1 & 1) as f64, (low >> 2 & 1) as f64);
    p[axis(edge as usize)] = 0.5;
    p
}

fn cost(t: [u32; 3]) -> f64 {
    irregularity(t.map(|e| nominal(e as u8)))
}

fn wide(curve: &[u8]) -> Vec<u32> {
    curve.iter().map(|&e| u32::from(e)).collect()
}

/// One curve alone bounds a disc. Diagonals must stay off the cell's faces; a fan around an inner point always does.
fn disc(curve: &[u8], out: &mut Tiling) {
    let apart = |i: usize, j: usize| !share_face(curve[i] as usize, curve[j] as usize);
    if let Some(faces) = polygon(&wide(curve), apart, &cost) {
        out.triangles.extend(faces.into_iter().map(|t| t.map(|v| v as u8)));
        return;
    }
    let center = 12 + out.inner.len() as u8;
    out.inner.push(Inner { near: None, all: curve.to_vec() });
    out.triangles.extend((0..curve.len()).map(|i| [curve[i], curve[(i + 1) % curve.len()], center]));
}

/// Two curves bound a tunnel. Bridges must stay off the cell's faces; if they cannot, they start at a copy of the
/// first curve within the cell.
fn tunnel(one: &[u8], other: &[u8], out: &mut Tiling) {
    let (p, mut q) = (wide(one), wide(other));
    let flat = |a: u32, b: u32| share_face(a as usize, b as usize);
    let inside = |t: [u32; 3]| {
        let mixed = |a: u32, b: u32| p.contains(&a) != p.contains(&b) && flat(a, b);
        if mixed(t[0], t[1]) || mixed(t[1], t[2]) || mixed(t[2], t[0]) { f64::INFINITY } else { cost(t) }
    };
    let mut best: Option<(f64, Vec<[u32; 3]>)> = None;
    for _ in 0..q.len() {
        q.rotate_left(1);
        if let Some(found) = strip(&p, &q, &inside).filter(|f| best.as_ref().is_none_or(|b| f.0 < b.0)) {
            best = Some(found);
        }
    }
    if let Some((_, faces)) = best {
        out.triangles.extend(faces.into_iter().map(|t| t.map(|v| v as u8)));
        return;
    }
    let first = 12 + out.inner.len() as u8;
    let all = [one, other].concat();
    out.inner.extend(one.iter().map(|&e| Inner { near: Some(e), all: all.clone() }));
    let n = one.len();
    for i in 0..n {
        let (j, a) = ((i + 1) % n, first + i as u8);
        let b = first + j as u8;
        out.triangles.extend([[one[i], one[j], b], [one[i], b, a]]);
    }
    let copy: Vec<u32> = (0..n as u32).map(|i| u32::from(first) + i).collect();
    let at = |v: u32| match p.get((v as usize).wrapping_sub(first as usize)) {
        Some(&e) => nominal(e as u8),
        None => nominal(v as u8),
    };
    let free = |t: [u32; 3]| irregularity(t.map(at));
    for _ in 0..q.len() {
        q.rotate_left(1);
        if let Some(found) = strip(&copy, &q, &free).filter(|f| best.as_ref().is_none_or(|b| f.0 < b.0)) {
            best = Some(found);
        }
    }
    let faces = best.map_or(vec![], |b| b.1);
    out.triangles.extend(faces.into_iter().map(|t| t.map(|v| v as u8)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Every sign pattern with many magnitudes: triangles meet the faces of the cell in the curves alone, every other
    /// edge has its two triangles, and each surface is a disc or a tunnel by its Euler characteristic.
    #[test]
    fn tilings_are_manifold_with_the_right_boundary() {
        let mut rng = fastrand::Rng::with_seed(7);
        let mut random = || rng.f64();
        let (mut tunnels, mut centers) = (0, 0);
        for mask in 0..256 {
            for _ in 0..200 {
                let v: [f64; 8] =
                    std::array::from_fn(|i| (1e-3 + random().powi(3)) * if mask >> i & 1 == 1 { -1.0 } else { 1.0 });
                let found = contours(&v);
                let made = tiling(&v);
                let mut edges: BTreeMap<[u8; 2], i32> = BTreeMap::new();
                for t in &made.triangles {
                    for k in 0..3 {
                        *edges.entry([t[k], t[(k + 1) % 3]]).or_default() += 1;
                    }
                }
                assert!(edges.values().all(|&n| n == 1), "{v:?}: {made:?}");
                let open: Vec<[u8; 2]> = edges.keys().filter(|e| !edges.contains_key(&[e[1], e[0]])).copied().collect();
                let mut want: Vec<[u8; 2]> = vec![];
                for c in &found.curves {
                    want.extend((0..c.len()).map(|i| [c[i], c[(i + 1) % c.len()]]));
                }
                want.sort_unstable();
                assert_eq!(open, want, "{v:?}");
                for e in edges.keys().filter(|e| edges.contains_key(&[e[1], e[0]]) && e[0] < 12 && e[1] < 12) {
                    assert!(!share_face(e[0] as usize, e[1] as usize), "{v:?}: {e:?}");
                }
                // V − E + F: a disc counts one, a tunnel nothing.
                let mut points: Vec<u8> = made.triangles.concat();
                points.sort_unstable();
                points.dedup();
                let alone = |s: u8| found.surfaces.iter().map(|&t| u8::from(t == s)).sum::<u8>() == 1;
                let discs = found.surfaces.iter().map(|&s| usize::from(alone(s))).sum::<usize>();
                let undirected = usize::midpoint(edges.len(), open.len());
                assert_eq!(points.len() + made.triangles.len() - undirected, discs);
                tunnels += usize::from(discs < found.curves.len());
                centers += usize::from(!made.inner.is_empty());
            }
        }
        assert!(tunnels > 100 && centers > 0, "{tunnels} {centers}");
    }
}
