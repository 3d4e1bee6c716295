//! Bumpy blobs, and the placing of shapes.

use super::solids::icosphere;
use crate::mesh::TriMesh;
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// A bumpy blob around the origin: a subdivided sphere of `20·4^levels` triangles whose radius swings by up to
/// `roughness` (clamped to [0, 0.9]) of `radius`, smoothly, differently for every `seed`.
///
/// Every ray from the origin meets it once, so it never crosses itself. Bumps are about half a radius wide.
pub fn blob(radius: f64, levels: u32, roughness: f64, seed: u64) -> TriMesh {
    const WAVES: usize = 12;
    let mut state = seed;
    let mut random = || {
        // SplitMix64 ([Steele2014]): any seed serves, zero included.
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ state >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
    };
    let waves: [(DVec3, f64); WAVES] = std::array::from_fn(|_| {
        let direction = DVec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize_or(DVec3::X);
        ((2.0 + 4.0 * random()) * direction, TAU * random())
    });
    let mut mesh = icosphere(1.0, levels);
    for p in &mut mesh.positions {
        let swing: f64 = waves.iter().map(|(k, phase)| (k.dot(*p) + phase).sin()).sum();
        // Waves rarely agree: tanh uses the whole range and still keeps it.
        *p *= radius * (1.0 + roughness.clamp(0.0, 0.9) * (swing / (WAVES as f64).sqrt()).tanh());
    }
    mesh
}

/// The mesh turned about the origin, then moved.
#[must_use]
pub fn posed(mut mesh: TriMesh, rotation: DQuat, translation: DVec3) -> TriMesh {
    for p in &mut mesh.positions {
        *p = rotation * *p + translation;
    }
    mesh
}
