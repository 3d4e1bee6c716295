//! Lights, tone and sRGB.

use glam::DVec3;

/// A light at infinity, fixed to the camera: right, up, towards it.
struct Light {
    towards: [f64; 3],
    color: [f64; 3],
    /// How far beyond its horizon it reaches: the larger, the softer.
    wrap: f64,
}

/// From above the left shoulder, a cool fill from the right, and one from behind that draws the outline.
const LIGHTS: [Light; 3] = [
    Light { towards: [-0.45, 0.66, 0.60], color: [1.22, 1.15, 1.04], wrap: 0.12 },
    Light { towards: [0.85, 0.10, 0.52], color: [0.13, 0.16, 0.21], wrap: 0.4 },
    Light { towards: [0.40, 0.52, -0.75], color: [0.30, 0.32, 0.36], wrap: 0.1 },
];

/// Light from everywhere, from above and from below.
const SKY: [f64; 3] = [0.27, 0.30, 0.35];
const EARTH: [f64; 3] = [0.16, 0.145, 0.14];

/// Strength and sharpness of the sheen.
const SHEEN: f64 = 0.07;
const SHARPNESS: f64 = 38.0;

/// The light a matte surface sends to the eye. All directions are in camera axes and of unit length; `open` is the
/// share of the sky that the point sees.
pub(crate) fn shade(color: DVec3, normal: DVec3, towards_eye: DVec3, open: f64) -> DVec3 {
    let sky = 0.5 + 0.5 * normal.y;
    let ambient = DVec3::from(EARTH).lerp(DVec3::from(SKY), sky) * open;
    // What sees little sky sees little of the lamps as well; the root keeps hollows from going black.
    let shadow = 0.35 + 0.65 * open;
    let mut light = ambient;
    let mut sheen = DVec3::ZERO;
    for lamp in &LIGHTS {
        let towards = DVec3::from(lamp.towards).normalize();
        let wrapped = ((normal.dot(towards) + lamp.wrap) / (1.0 + lamp.wrap)).max(0.0);
        light += DVec3::from(lamp.color) * (wrapped * shadow);
        let half = (towards + towards_eye).normalize_or_zero();
        let glint = SHEEN * normal.dot(half).max(0.0).powf(SHARPNESS) * wrapped.sqrt();
        sheen += DVec3::from(lamp.color) * (glint * shadow);
    }
    // Edges seen at a grazing angle pick up a little of the bright surroundings.
    let grazing = (1.0 - normal.dot(towards_eye).clamp(0.0, 1.0)).powi(4) * 0.10 * open;
    compressed(color * light + sheen + DVec3::splat(grazing))
}

/// sRGB in [0, 1] to linear light.
pub(crate) fn linear(color: [f64; 3]) -> DVec3 {
    DVec3::from(color.map(|c| {
        let c = if c.is_finite() { c.clamp(0.0, 1.0) } else { 0.0 };
        if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    }))
}

/// What is too bright runs softly into white.
fn compressed(light: DVec3) -> DVec3 {
    DVec3::from(
        light.to_array().map(
            |c| {
                if c < SHOULDER { c } else { SHOULDER + ROOM * (1.0 - ((SHOULDER - c) / ROOM).exp()) }
            },
        ),
    )
}

/// Where tones begin to be compressed, and what is left above.
const SHOULDER: f64 = 0.7;
const ROOM: f64 = 1.0 - SHOULDER;

/// Linear light to sRGB.
pub(crate) fn display(color: DVec3) -> DVec3 {
    DVec3::from(color.to_array().map(|c| {
        let c = c.clamp(0.0, 1.0);
        if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
    }))
}

/// To the nearest of 256 levels.
pub(crate) fn bytes(color: DVec3) -> [u8; 3] {
    color.to_array().map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8)
}
