//! The colour of a surface point. Linear light inside, sRGB at the border.

use crate::curvature::{mean_curvature, percentile};
use crate::light::linear;
use crate::params::{Color, Error};
use glam::{DVec3, DVec4};
use mesh_core::{FaceId, TriMesh, VertexId};

/// Plain surfaces, and the inside of surfaces of any colour.
const CLAY: [f64; 3] = [0.64, 0.715, 0.80];
const INSIDE: [f64; 3] = [0.80, 0.44, 0.33];

/// Apart in hue and close in lightness, so that shading reads across them.
const PALETTE: [[f64; 3]; 8] = [
    [0.47, 0.63, 0.80],
    [0.93, 0.73, 0.42],
    [0.90, 0.47, 0.40],
    [0.52, 0.72, 0.55],
    [0.69, 0.58, 0.78],
    [0.55, 0.77, 0.78],
    [0.90, 0.63, 0.72],
    [0.75, 0.72, 0.60],
];

/// Hollow, flat, bulging.
const DIVERGING: [[f64; 3]; 5] =
    [[0.13, 0.32, 0.65], [0.48, 0.66, 0.87], [0.94, 0.94, 0.93], [0.93, 0.57, 0.44], [0.70, 0.12, 0.16]];

/// Needle to equilateral.
const QUALITY: [[f64; 3]; 4] = [[0.64, 0.10, 0.18], [0.94, 0.53, 0.28], [0.95, 0.88, 0.55], [0.25, 0.62, 0.60]];

/// Dark stripes over half a turn of the reflected ray.
const STRIPES: f64 = 9.0;

/// Colours ready to be looked up.
pub(crate) enum Paint {
    One(DVec3),
    /// A value in [−1, 1] per vertex.
    Diverging(Vec<f64>),
    Faces(Vec<DVec3>),
    Vertices(Vec<DVec3>),
    Zebra,
}

impl Paint {
    pub(crate) fn new(mesh: &TriMesh, color: &Color) -> Result<Self, Error> {
        let (faces, vertices) = (mesh.faces.len(), mesh.positions.len());
        let check = |per, found: usize, expected| {
            if found == expected { Ok(()) } else { Err(Error::ColorCount { per, expected, found }) }
        };
        Ok(match color {
            Color::Plain => Self::One(linear(CLAY)),
            Color::Curvature => {
                let curvature = mean_curvature(mesh);
                // Below a tenth of what a ball around the model has, a surface is flat and shows only rounding.
                let scale = percentile(&curvature, 0.95).max(0.1);
                Self::Diverging(curvature.into_iter().map(|h| (h / scale).clamp(-1.0, 1.0)).collect())
            }
            Color::Origin(indices) => {
                check("faces", indices.len(), faces)?;
                Self::Faces(indices.iter().map(|&i| linear(PALETTE[i as usize % PALETTE.len()])).collect())
            }
            Color::Quality => {
                Self::Faces((0..faces).map(|f| ramp(&QUALITY, shape_quality(mesh.triangle(FaceId::from(f))))).collect())
            }
            Color::Zebra => Self::Zebra,
            Color::PerFace(colors) => {
                check("faces", colors.len(), faces)?;
                Self::Faces(colors.iter().map(|&c| linear(c)).collect())
            }
            Color::PerVertex(colors) => {
                check("vertices", colors.len(), vertices)?;
                Self::Vertices(colors.iter().map(|&c| linear(c)).collect())
            }
        })
    }

    /// The colour of a point. `normal` and `towards_eye` are given in camera axes.
    pub(crate) fn at(
        &self,
        mesh: &TriMesh,
        face: FaceId,
        barycentric: [f64; 3],
        normal: DVec3,
        towards_eye: DVec3,
    ) -> DVec3 {
        let corners = mesh.faces[face.index()].map(VertexId::index);
        let mix = |values: &[f64]| (0..3).map(|k| barycentric[k] * values[corners[k]]).sum::<f64>();
        match self {
            Self::One(color) => *color,
            Self::Diverging(values) => ramp(&DIVERGING, 0.5 + 0.5 * mix(values)),
            Self::Faces(colors) => colors[face.index()],
            Self::Vertices(colors) => (0..3).map(|k| barycentric[k] * colors[corners[k]]).sum(),
            Self::Zebra => zebra(normal, towards_eye),
        }
    }

    /// The colour of the back of a face.
    pub(crate) fn inside() -> DVec3 {
        linear(INSIDE)
    }
}

/// Stripes across the vertical of the room that the surface mirrors.
fn zebra(normal: DVec3, towards_eye: DVec3) -> DVec3 {
    let mirrored = 2.0 * normal.dot(towards_eye) * normal - towards_eye;
    let angle = mirrored.x.atan2(mirrored.z.hypot(mirrored.y));
    let wave = (STRIPES * 2.0 * angle).sin();
    let light = smoothstep(-0.12, 0.12, wave);
    linear([0.10, 0.11, 0.14]).lerp(linear([0.93, 0.93, 0.92]), light)
}

pub(crate) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// 2·inradius/circumradius: 1 for equilateral triangles, 0 for degenerate ones.
pub fn shape_quality([a, b, c]: [DVec3; 3]) -> f64 {
    let [x, y, z] = [b.distance(c), c.distance(a), a.distance(b)];
    let double_area = (b - a).cross(c - a).length();
    // r = A/s and R = xyz/(4A), with 2A the double area.
    let quality = 4.0 * double_area * double_area / ((x + y + z) * x * y * z);
    if quality.is_finite() { quality.clamp(0.0, 1.0) } else { 0.0 }
}

/// A colour out of an even ramp, 0 to 1. Mixed as sRGB, where the ramps were chosen by eye.
fn ramp(stops: &[[f64; 3]], t: f64) -> DVec3 {
    let x = t.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let i = (x as usize).min(stops.len() - 2);
    let mixed = DVec3::from(stops[i]).lerp(DVec3::from(stops[i + 1]), x - i as f64);
    linear(mixed.to_array())
}

/// A colour laid over another.
pub(crate) fn over(below: DVec3, above: DVec4) -> DVec3 {
    below.lerp(above.truncate(), above.w)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_quality_knows_the_extremes() {
        let h = 0.75f64.sqrt();
        assert!((shape_quality([DVec3::ZERO, DVec3::X, DVec3::new(0.5, h, 0.0)]) - 1.0).abs() < 1e-12);
        assert_eq!(shape_quality([DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]), 0.0);
        assert_eq!(shape_quality([DVec3::ZERO; 3]), 0.0);
        // 3-4-5: r = 1, R = 2.5.
        assert!((shape_quality([DVec3::ZERO, 3.0 * DVec3::X, 4.0 * DVec3::Y]) - 0.8).abs() < 1e-12);
    }
}
