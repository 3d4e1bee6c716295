//! Triangle edges of constant width on the picture.

use crate::camera::Camera;
use crate::color::smoothstep;
use crate::light::linear;
use crate::params::Wireframe;
use glam::{DVec2, DVec3, DVec4};

/// Triangles lower than the first, in pixels, show no lines; above the second they show them in full.
const FADE: [f64; 2] = [2.0, 6.0];

/// The line's colour and coverage at a place on the picture inside a triangle.
pub(crate) fn line_over(camera: &Camera, wire: &Wireframe, triangle: [DVec3; 3], at: DVec2) -> DVec4 {
    let p = triangle.map(|v| camera.project(v));
    let edges = [0, 1, 2].map(|k| p[(k + 1) % 3] - p[k]);
    let longest = edges.iter().map(|e| e.length()).fold(0.0, f64::max);
    let height = edges[0].perp_dot(edges[1]).abs() / longest.max(1e-9);
    let nearest = [0, 1, 2]
        .map(|k| {
            let t = ((at - p[k]).dot(edges[k]) / edges[k].length_squared().max(1e-18)).clamp(0.0, 1.0);
            (at - p[k] - t * edges[k]).length()
        })
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    // Each side of an edge draws its own half of the line.
    let coverage = (0.5 * wire.width + 0.5 - nearest).clamp(0.0, 1.0);
    let opacity = wire.opacity.clamp(0.0, 1.0) * smoothstep(FADE[0], FADE[1], height);
    linear(wire.color).extend(coverage * opacity)
}
