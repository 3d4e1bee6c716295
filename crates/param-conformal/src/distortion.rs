//! Angles, areas and flips of a map into the plane.

use crate::error::Error;
use glam::{DVec2, DVec3};
use mesh_core::{FaceId, Faces, Positions, VertexMap, area_vector, centroid};

/// How far a map is from keeping shapes. Areas are shares of the whole, so that scale does not matter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Distortion {
    /// Mean over the area of the ratio of the longest to the shortest axis into which a small circle is mapped, ≥ 1;
    /// 1 where angles are kept. Flipped triangles do not count.
    pub angle_mean: f64,
    /// The largest such ratio.
    pub angle_max: f64,
    /// Mean over the area of max(s, 1/s), s the scale of areas relative to the whole map's; 1 where areas are kept.
    pub area_mean: f64,
    /// The largest such value.
    pub area_max: f64,
    /// Triangles turned over, or flat to working precision, ascending.
    pub flipped: Vec<FaceId>,
}

impl Distortion {
    /// Measures a map given by the corners of each triangle. O(n).
    pub fn of<M: Faces + Positions>(mesh: &M, map: impl Fn(FaceId) -> [DVec2; 3]) -> Self {
        let area = |f: FaceId| area_vector(mesh.triangle(f)).length();
        let (mut whole, mut whole_mapped) = (0.0, 0.0);
        for f in mesh.face_ids() {
            whole += area(f);
            whole_mapped += 0.5 * doubled_area(map(f)).abs();
        }
        let mut found = Self { angle_max: 1.0, area_max: 1.0, ..Self::default() };
        let mut measured = 0.0;
        for f in mesh.face_ids() {
            let (plane, solid) = (map(f), area(f));
            if is_flipped(plane) {
                found.flipped.push(f);
                continue;
            }
            let ratio = axes_ratio(mesh.triangle(f), plane);
            let scale = (0.5 * doubled_area(plane) / whole_mapped) / (solid / whole);
            let scale = scale.max(1.0 / scale);
            if !(ratio.is_finite() && scale.is_finite()) {
                continue;
            }
            measured += solid;
            found.angle_mean += solid * ratio;
            found.area_mean += solid * scale;
            found.angle_max = found.angle_max.max(ratio);
            found.area_max = found.area_max.max(scale);
        }
        found.angle_mean = if measured > 0.0 { found.angle_mean / measured } else { 1.0 };
        found.area_mean = if measured > 0.0 { found.area_mean / measured } else { 1.0 };
        found
    }
}

pub(crate) fn doubled_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether a triangle is clockwise, or flat by more than rounding can tell.
pub(crate) fn is_flipped([a, b, c]: [DVec2; 3]) -> bool {
    let (u, v) = (b - a, c - a);
    let largest = a.abs().max(b.abs()).max(c.abs()).max_element();
    // Rounding of the coordinates themselves, and of the two products.
    let noise = 4.0 * f64::EPSILON * (largest * (u.abs() + v.abs()).element_sum() + u.length() * v.length());
    let area = doubled_area([a, b, c]);
    area.is_nan() || area <= noise
}

/// The ratio of the singular values of the affine map of one triangle.
fn axes_ratio(p: [DVec3; 3], q: [DVec2; 3]) -> f64 {
    let (e, f) = (p[1] - p[0], p[2] - p[0]);
    let x = e.normalize_or_zero();
    let (ex, fx) = (e.length(), f.dot(x));
    let fy = (f - fx * x).length();
    let (u, v) = (q[1] - q[0], q[2] - q[0]);
    let du = u / ex;
    let dv = (v - fx * du) / fy;
    // σ1² + σ2² and σ1·σ2.
    let (sum, product) = (du.length_squared() + dv.length_squared(), du.perp_dot(dv).abs());
    let root = ((sum + 2.0 * product).sqrt(), (sum - 2.0 * product).max(0.0).sqrt());
    (root.0 + root.1) / (root.0 - root.1)
}

/// The corners of a triangle under a map given at the vertices.
pub(crate) fn face_corners<M: Faces>(mesh: &M, map: &VertexMap<DVec2>) -> impl Fn(FaceId) -> [DVec2; 3] {
    move |f| mesh.corners(f).map(|v| map[v])
}

/// Refuses a map with flipped triangles.
pub(crate) fn check<M: Faces + Positions>(mesh: &M, map: impl Fn(FaceId) -> [DVec2; 3]) -> Result<(), Error> {
    let mut flipped = mesh.face_ids().filter(|&f| is_flipped(map(f)));
    let Some(face) = flipped.next() else { return Ok(()) };
    let [a, b, c] = map(face);
    let size = (b - a).abs().max((c - a).abs());
    let pinned = size.min_element() <= 1e-12 * size.max_element();
    let at = centroid(mesh.triangle(face));
    Err(Error::Flipped { face, at, count: 1 + flipped.count(), pinned })
}
