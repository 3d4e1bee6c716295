//! Ambient occlusion, interleaved and filtered.
//!
//! The pixels of each 4×4 tile share one low-discrepancy set of directions, a few each; a filter that stops at edges
//! then gives every pixel the light of all. No grain is left, at a sixteenth of the rays.

use crate::scene::{Place, Scene, Sight};
use glam::DVec3;
use mesh_core::{Cancelled, Watch};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Pixels along a tile.
const TILE: usize = 4;

/// How far rays look, in half sizes of the model.
const REACH: f64 = 1.0;

/// Start of a ray above its surface, likewise.
const LIFT: f64 = 1e-5;

/// Pixels that the filter looks to either side.
const RADIUS: usize = 5;

/// The share of the sky that each pixel's point sees, 1 where there is none.
pub(crate) fn openness(
    scene: &Scene,
    sights: &[Sight],
    width: usize,
    samples: u32,
    watch: &Watch,
) -> Result<Vec<f32>, Cancelled> {
    if samples == 0 {
        return Ok(vec![1.0; sights.len()]);
    }
    let directions = directions(samples.min(256) as usize * TILE * TILE);
    let rows = sights.len() / width;
    let raw: Result<Vec<Vec<f32>>, Cancelled> = sights
        .par_chunks(width)
        .enumerate()
        .map(|(y, row)| {
            watch.step("ambient light", y as f64 / rows as f64)?;
            let open = |(x, sight): (usize, &Sight)| {
                let offset = DITHER[y % TILE][x % TILE];
                sight.place().map_or(1.0, |place| seen_from(scene, place, &directions[offset..]))
            };
            Ok(row.iter().enumerate().map(open).collect())
        })
        .collect();
    Ok(filtered(&raw?.concat(), sights, width))
}

/// An order of the tile's pixels in which neighbours are far apart.
const DITHER: [[usize; TILE]; TILE] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];

/// Cosine-weighted directions about +z with their lengths: the R3 sequence [Roberts2018], an additive recurrence.
fn directions(count: usize) -> Vec<DVec3> {
    const STEP: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    (0..count)
        .map(|i| {
            let [u, v, w] = STEP.map(|s| (0.5 + s * i as f64).fract());
            let (radius, turn) = (u.sqrt(), TAU * v);
            // Lengths are spread, so that what is near counts more than what is far.
            let length = REACH * (0.08 + 0.92 * w * w);
            DVec3::new(radius * turn.cos(), radius * turn.sin(), (1.0 - u).sqrt()) * length
        })
        .collect()
}

fn seen_from(scene: &Scene, place: &Place, directions: &[DVec3]) -> f32 {
    let (s, t) = place.normal.any_orthonormal_pair();
    let origin = place.point + LIFT * place.normal;
    let (mut open, mut count) = (0u32, 0u32);
    for d in directions.iter().step_by(TILE * TILE) {
        let ray = d.x * s + d.y * t + d.z * place.normal;
        open += u32::from(!scene.tree.ray_occluded(&scene.mesh, origin, ray, 1.0));
        count += 1;
    }
    open as f32 / count as f32
}

/// Each pixel averaged with those around it that lie on the same piece of surface.
fn filtered(raw: &[f32], sights: &[Sight], width: usize) -> Vec<f32> {
    let height = sights.len() / width;
    let pixel_size = 2.0 / height as f64;
    (0..sights.len())
        .into_par_iter()
        .with_min_len(width)
        .map(|i| {
            let Some(here) = sights[i].place() else { return 1.0 };
            let (x, y) = (i % width, i / width);
            let (mut sum, mut weights) = (0.0, 0.0);
            for v in y.saturating_sub(RADIUS)..height.min(y + RADIUS + 1) {
                for u in x.saturating_sub(RADIUS)..width.min(x + RADIUS + 1) {
                    let j = v * width + u;
                    if let Some(there) = sights[j].place() {
                        let weight = likeness(here, there, pixel_size) * tent(x, u) * tent(y, v);
                        sum += weight * f64::from(raw[j]);
                        weights += weight;
                    }
                }
            }
            (sum / weights) as f32
        })
        .collect()
}

fn tent(a: usize, b: usize) -> f64 {
    1.0 - a.abs_diff(b) as f64 / (RADIUS + 1) as f64
}

/// 1 for points of one plane, less as normals turn and as points leave each other's planes.
fn likeness(a: &Place, b: &Place, pixel_size: f64) -> f64 {
    let off = (b.point - a.point).dot(a.normal).abs() / (4.0 * pixel_size);
    let turn = a.normal.dot(b.normal).max(0.0);
    turn * turn * turn * turn * (1.0 - off).max(0.0) + 1e-9
}
