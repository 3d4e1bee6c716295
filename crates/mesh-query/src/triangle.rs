//! Closest point on one triangle, degenerate ones included.

use crate::frame::inverse_power_of_two;
use glam::DVec3;

/// Below this share of (longest edge)⁴, the squared double area is so small that the signs of a region walk are noise.
const SLIVER: f64 = 1e-8;

/// The point of a triangle closest to `p`, and its barycentric coordinates: none negative, summing to 1 up to
/// rounding, exactly 0 (and 1) on edges and at vertices.
///
/// Needles, and triangles that are really a segment or a point, are fine; so are lengths from 1e-300 to 1e300. NaN in,
/// NaN out. The regions of the plane are walked as in \[Ericson2005\] §5.1.5.
pub fn closest_point_on_triangle(p: DVec3, triangle: [DVec3; 3]) -> (DVec3, [f64; 3]) {
    let relative = triangle.map(|v| v - p);
    let size = relative.iter().fold(0.0f64, |m, v| m.max(v.abs().max_element()));
    let scale = inverse_power_of_two(size);
    let nearest = nearest_to_origin(relative.map(|v| v * scale));
    (at_barycentric(triangle, nearest.barycentric), nearest.barycentric)
}

/// The point with the given barycentric coordinates; exactly a vertex when one of them is 1.
pub(crate) fn at_barycentric(triangle: [DVec3; 3], barycentric: [f64; 3]) -> DVec3 {
    if let Some(k) = barycentric.iter().position(|&w| w == 1.0) {
        return triangle[k];
    }
    let [a, b, c] = triangle;
    let [_, v, w] = barycentric;
    // From a corner by differences: exact in a plane of constant coordinate, and accurate far from the origin.
    a + v * (b - a) + w * (c - a)
}

#[derive(Clone, Copy)]
pub(crate) struct Nearest {
    pub(crate) distance_squared: f64,
    pub(crate) barycentric: [f64; 3],
}

impl Nearest {
    #[inline]
    fn or(self, other: Self) -> Self {
        if other.distance_squared < self.distance_squared { other } else { self }
    }
}

/// The point of a triangle closest to the origin. Coordinates should be around 1 or smaller, so that fourth powers
/// neither overflow nor, for triangles that matter, underflow.
#[inline]
pub(crate) fn nearest_to_origin(triangle: [DVec3; 3]) -> Nearest {
    let [a, b, c] = triangle;
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return corner(triangle, 0);
    }
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    if d3 >= 0.0 && d4 <= d3 {
        return corner(triangle, 1);
    }
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    if d6 >= 0.0 && d5 <= d6 {
        return corner(triangle, 2);
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let area = va + vb + vc;
    let longest = ab.length_squared().max(ac.length_squared());
    if area.is_nan() || area <= SLIVER * longest * longest {
        return nearest_of_sliver(triangle, [va, vb, vc]);
    }
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return on_edge(triangle, 0);
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return on_edge(triangle, 1);
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return on_edge(triangle, 2);
    }
    inside(triangle, [va, vb, vc])
}

#[inline]
fn corner(triangle: [DVec3; 3], k: usize) -> Nearest {
    let mut barycentric = [0.0; 3];
    barycentric[k] = 1.0;
    Nearest { distance_squared: triangle[k].length_squared(), barycentric }
}

/// Closest on the edge from corner `k` to the next. Both faces of an edge must get the same bits, so that ties go to
/// the lower face: the ends are ordered by coordinates, not by the direction in which this triangle runs.
#[inline]
fn on_edge(triangle: [DVec3; 3], k: usize) -> Nearest {
    let (mut i, mut j) = (k, (k + 1) % 3);
    if triangle[j].to_array() < triangle[i].to_array() {
        (i, j) = (j, i);
    }
    let (a, along) = (triangle[i], triangle[j] - triangle[i]);
    let length_squared = along.length_squared();
    let t = if length_squared > 0.0 { (-a.dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    let mut barycentric = [0.0; 3];
    barycentric[i] = 1.0 - t;
    barycentric[j] = t;
    Nearest { distance_squared: (a + t * along).length_squared(), barycentric }
}

#[inline]
fn inside(triangle: [DVec3; 3], weights: [f64; 3]) -> Nearest {
    let [a, b, c] = triangle;
    let [u, v, w] = weights.map(|x| x.max(0.0));
    let sum = u + v + w;
    let (v, w) = (v / sum, w / sum);
    let q = a + v * (b - a) + w * (c - a);
    Nearest { distance_squared: q.length_squared(), barycentric: [(1.0 - v - w).max(0.0), v, w] }
}

/// The best of the three edges and, if it is one, of the inner point that the rounded weights name: whichever it is,
/// it lies on the triangle, and nothing is missed by more than the noise in the weights.
#[cold]
fn nearest_of_sliver(triangle: [DVec3; 3], weights: [f64; 3]) -> Nearest {
    let edges = on_edge(triangle, 0).or(on_edge(triangle, 1)).or(on_edge(triangle, 2));
    if weights.iter().any(|&w| w > 0.0) { edges.or(inside(triangle, weights)) } else { edges }
}
