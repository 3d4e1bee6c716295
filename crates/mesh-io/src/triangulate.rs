//! Cuts polygons into triangles: quads by the shorter diagonal that does not fold, others by ear clipping.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

/// Polygons up to this size are cut at the shortest ear each time; larger ones at the next ear around.
const CHOOSY: usize = 32;
/// Containment tests allowed per corner, so that a hostile polygon cannot stall the reader.
const TESTS_PER_CORNER: usize = 1000;

/// How a polygon's triangulation went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// Into triangles that all turn the polygon's way.
    Clean,
    /// The polygon crosses itself or has no area: some triangles fold or are flat.
    Folded,
}

/// Appends triangles over the corners of the polygon `points` (at least three), as indices into it. The polygon is
/// cut in the coordinate plane nearest its Newell normal, where every decision is an exact sign. O(n) for convex
/// polygons, O(n²) at worst, cut short for huge ones.
pub(crate) fn triangulate(points: &[DVec3], out: &mut Vec<[u32; 3]>) -> Cut {
    if points.len() == 3 {
        out.push([0, 1, 2]);
        return Cut::Clean;
    }
    let flat = flatten(points);
    if points.len() == 4 { cut_quad(points, &flat, out) } else { clip_ears(&flat, out) }
}

/// The polygon in the coordinate plane that its Newell normal is nearest to, counter-clockwise. Scaling is by a power
/// of two and dropping a coordinate is exact, so signs there are those of the input.
fn flatten(points: &[DVec3]) -> Vec<DVec2> {
    let largest = points.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    let scale = power_of_two_below(largest);
    let scaled = |p: DVec3| p * scale;
    let origin = scaled(points[0]);
    let mut normal = DVec3::ZERO;
    for (k, &p) in points.iter().enumerate() {
        let q = points[(k + 1) % points.len()];
        normal += (scaled(p) - origin).cross(scaled(q) - origin);
    }
    let size = normal.abs();
    let project: fn(DVec3) -> DVec2 = if size.z >= size.x && size.z >= size.y {
        if normal.z < 0.0 { |p| DVec2::new(p.y, p.x) } else { |p| DVec2::new(p.x, p.y) }
    } else if size.y >= size.x {
        if normal.y < 0.0 { |p| DVec2::new(p.x, p.z) } else { |p| DVec2::new(p.z, p.x) }
    } else if normal.x < 0.0 {
        |p| DVec2::new(p.z, p.y)
    } else {
        |p| DVec2::new(p.y, p.z)
    };
    points.iter().map(|&p| project(scaled(p))).collect()
}

/// 2^-k with 2^k next to `x`, so that products of three scaled coordinates neither overflow nor vanish.
fn power_of_two_below(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() {
        return 1.0;
    }
    let exponent = ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    2.0f64.powi((-exponent).clamp(-1022, 1022))
}

fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

fn cut_quad(points: &[DVec3], flat: &[DVec2], out: &mut Vec<[u32; 3]>) -> Cut {
    let positive = |i: usize, j: usize, k: usize| turn(flat[i], flat[j], flat[k]) > 0.0;
    let first = positive(0, 1, 2) && positive(0, 2, 3);
    let second = positive(1, 2, 3) && positive(1, 3, 0);
    let length = |i: usize, j: usize| {
        // Halved first, so that the difference of huge coordinates stays finite.
        let d = (0.5 * points[i] - 0.5 * points[j]).abs();
        let largest = d.max_element();
        if largest == 0.0 { 0.0 } else { largest * (d / largest).length() }
    };
    if second && (!first || length(1, 3) < length(0, 2)) {
        out.extend([[0, 1, 3], [1, 2, 3]]);
    } else {
        out.extend([[0, 1, 2], [0, 2, 3]]);
    }
    if first || second { Cut::Clean } else { Cut::Folded }
}

/// The polygon that is left: a ring of corners in a doubly linked list.
struct Ring<'a> {
    flat: &'a [DVec2],
    next: Vec<u32>,
    prev: Vec<u32>,
    reflex: Vec<bool>,
    tests: usize,
}

fn clip_ears(flat: &[DVec2], out: &mut Vec<[u32; 3]>) -> Cut {
    let n = flat.len();
    let mut ring = Ring {
        flat,
        next: (0..n).map(|i| ((i + 1) % n) as u32).collect(),
        prev: (0..n).map(|i| ((i + n - 1) % n) as u32).collect(),
        reflex: vec![false; n],
        tests: TESTS_PER_CORNER * n,
    };
    for i in 0..n {
        ring.reflex[i] = ring.turn_at(i) <= 0.0;
    }
    let (mut at, mut cut) = (0, Cut::Clean);
    for left in (3..=n).rev() {
        let ear = if left == 3 {
            at
        } else {
            ring.find_ear(at, left).unwrap_or_else(|| {
                cut = Cut::Folded;
                ring.least_bad(at, left)
            })
        };
        if left == 3 && ring.turn_at(ear) <= 0.0 {
            cut = Cut::Folded;
        }
        let (before, after) = (ring.prev[ear] as usize, ring.next[ear] as usize);
        out.push([before as u32, ear as u32, after as u32]);
        ring.next[before] = after as u32;
        ring.prev[after] = before as u32;
        for i in [before, after] {
            ring.reflex[i] = ring.turn_at(i) <= 0.0;
        }
        // Going on behind the next corner keeps neighbouring ears from forming a fan of slivers.
        at = ring.next[after] as usize;
    }
    cut
}

impl Ring<'_> {
    fn turn_at(&self, i: usize) -> f64 {
        turn(self.flat[self.prev[i] as usize], self.flat[i], self.flat[self.next[i] as usize])
    }

    fn find_ear(&mut self, start: usize, left: usize) -> Option<usize> {
        let (mut best, mut at) = (None, start);
        for _ in 0..left {
            if self.tests == 0 {
                return None;
            }
            if !self.reflex[at] && self.is_empty_ear(at) {
                if left > CHOOSY {
                    return Some(at);
                }
                let diagonal = self.flat[self.prev[at] as usize].distance_squared(self.flat[self.next[at] as usize]);
                if best.is_none_or(|(d, _)| diagonal < d) {
                    best = Some((diagonal, at));
                }
            }
            at = self.next[at] as usize;
        }
        best.map(|(_, ear)| ear)
    }

    /// Whether no other corner lies in the closed triangle at `ear`. Corners at the same place as one of the
    /// triangle's own do not count: bridges to holes pass there twice.
    fn is_empty_ear(&mut self, ear: usize) -> bool {
        let (before, after) = (self.prev[ear] as usize, self.next[ear] as usize);
        let (a, b, c) = (self.flat[before], self.flat[ear], self.flat[after]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let mut at = self.next[after] as usize;
        while at != before {
            if self.tests == 0 {
                return false;
            }
            self.tests -= 1;
            let p = self.flat[at];
            if self.reflex[at]
                && p.cmpge(low).all()
                && p.cmple(high).all()
                && p != a
                && p != b
                && p != c
                && turn(a, b, p) >= 0.0
                && turn(b, c, p) >= 0.0
                && turn(c, a, p) >= 0.0
            {
                return false;
            }
            at = self.next[at] as usize;
        }
        true
    }

    /// Some corner to clip where none is an ear: a flat one, so that nothing folds, or else the first.
    fn least_bad(&self, start: usize, left: usize) -> usize {
        if self.tests == 0 {
            return start;
        }
        let mut at = start;
        for _ in 0..left {
            if self.turn_at(at) == 0.0 {
                return at;
            }
            at = self.next[at] as usize;
        }
        start
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area(points: &[DVec3]) -> f64 {
        let fan = |i: usize| (points[i] - points[0]).cross(points[i + 1] - points[0]);
        (1..points.len() - 1).map(fan).sum::<DVec3>().length() / 2.0
    }

    /// Cuts the polygon and checks what any triangulation of a simple polygon has: n − 2 triangles that turn its way
    /// and together have its area.
    fn check(points: &[DVec3]) -> Vec<[u32; 3]> {
        let mut triangles = vec![];
        assert_eq!(triangulate(points, &mut triangles), Cut::Clean);
        assert_eq!(triangles.len(), points.len() - 2);
        let pieces: f64 = triangles.iter().map(|t| area(&t.map(|i| points[i as usize]))).sum();
        assert!((pieces - area(points)).abs() <= 1e-12 * pieces, "{pieces} {}", area(points));
        triangles
    }

    /// Points around the origin at growing angles and any distance: simple, and as concave as can be.
    fn star() -> impl Strategy<Value = Vec<DVec3>> {
        prop::collection::vec(0.1..10.0f64, 4..90).prop_map(|radii| {
            let n = radii.len() as f64;
            let at = |(i, r): (usize, &f64)| {
                let angle = std::f64::consts::TAU * i as f64 / n;
                DVec3::new(r * angle.cos(), r * angle.sin(), 0.0)
            };
            radii.iter().enumerate().map(at).collect()
        })
    }

    proptest! {
        #[test]
        fn stars_are_covered_in_any_plane(star in star(), axis in prop::array::uniform3(-1.0..1.0f64), exponent in -290i32..290) {
            prop_assume!(DVec3::from_array(axis).length() > 0.1);
            let turn = glam::DQuat::from_rotation_arc(DVec3::Z, DVec3::from_array(axis).normalize());
            let turned: Vec<DVec3> = star.iter().map(|&p| turn * p).collect();
            let triangles = check(&turned);
            // Scaling by a power of two changes no decision.
            let scaled: Vec<DVec3> = turned.iter().map(|p| *p * 2.0f64.powi(exponent)).collect();
            let mut same = vec![];
            triangulate(&scaled, &mut same);
            prop_assert_eq!(triangles, same);
        }
    }

    #[test]
    fn quads_take_the_shorter_diagonal_that_does_not_fold() {
        let quad = |points: [[f64; 2]; 4]| check(&points.map(|[x, y]| DVec3::new(x, y, 1.0)));
        assert_eq!(quad([[0., 0.], [4., 0.], [5., 1.], [1., 1.]]), [[0, 1, 3], [1, 2, 3]]);
        assert_eq!(quad([[1., 0.], [5., 0.], [4., 1.], [0., 1.]]), [[0, 1, 2], [0, 2, 3]]);
        // Concave at corner 1, whose diagonal to 3 is the longer one.
        assert_eq!(quad([[0., 0.], [1., 1.], [2., 0.], [1., 9.]]), [[0, 1, 3], [1, 2, 3]]);
    }

    /// A square with a square hole, joined by a bridge that is passed twice.
    #[test]
    fn bridges_to_holes() {
        let outer = [[0., 0.], [4., 0.], [4., 4.], [0., 4.]];
        let hole = [[1., 1.], [1., 3.], [3., 3.], [3., 1.]];
        let ring: Vec<[f64; 2]> = [&outer[..], &outer[..1], &hole[..], &hole[..1]].concat();
        let points: Vec<DVec3> = ring.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
        check(&points);
    }

    #[test]
    fn hopeless_polygons_still_give_triangles() {
        for points in [
            vec![DVec3::ONE; 6],
            (0..7).map(|i| DVec3::splat(f64::from(i))).collect(),
            vec![DVec3::splat(1e308), -DVec3::splat(1e308), DVec3::X, DVec3::Y * 1e308, DVec3::ZERO],
        ] {
            let mut triangles = vec![];
            triangulate(&points, &mut triangles);
            assert_eq!(triangles.len(), points.len() - 2);
        }
    }

    /// A comb with a hundred thousand corners: the work must stay bounded.
    #[test]
    fn huge_polygons_do_not_stall() {
        let n = 100_000;
        let tooth = |i: usize| DVec3::new(i as f64, if i.is_multiple_of(2) { 0.0 } else { 5.0 + (i % 7) as f64 }, 0.0);
        let points: Vec<DVec3> =
            (0..n).map(tooth).chain([DVec3::new(n as f64, 1e6, 0.0), DVec3::new(-1.0, 1e6, 0.0)]).collect();
        let mut triangles = vec![];
        triangulate(&points, &mut triangles);
        assert_eq!(triangles.len(), n);
    }
}
