//! Ambient occlusion, interleaved and filtered.
//!
//! The pixels of each 4×4 tile share one low-discrepancy set of directions, a few each; a filter that stops at edges
//! then gives every pixel the light of all. No grain is left, at a sixteenth of the rays.

use crate::scene::{Place, REACH, Scene, Sight};
use glam::{DVec3, Vec3A};
use mesh_core::{Cancelled, Watch};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Pixels along a tile.
const TILE: usize = 4;

/// Start of a ray above its surface, likewise.
const LIFT: f64 = 1e-5;

/// Pixels that the filter looks to either side.
const RADIUS: usize = 4;

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

/// Cosine-weighted directions about +z with their lengths: the R3 sequence \[Roberts2018\], an additive recurrence.
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

/// A place in single precision: the filter reads each pixel's many times.
#[derive(Clone, Copy)]
struct Spot {
    point: Vec3A,
    normal: Vec3A,
    open: f32,
}

/// Each pixel averaged with those around it that lie on the same piece of surface.
fn filtered(raw: &[f32], sights: &[Sight], width: usize) -> Vec<f32> {
    let height = sights.len() / width;
    // Points may leave each other's planes by four pixels' worth before they count as apart.
    let apart = 0.125 * height as f32;
    let spot = |(sight, &open): (&Sight, &f32)| {
        sight.place().map(|p| Spot { point: p.point.as_vec3a(), normal: p.normal.as_vec3a(), open })
    };
    let spots: Vec<Option<Spot>> = sights.iter().zip(raw).map(spot).collect();
    (0..sights.len())
        .into_par_iter()
        .with_min_len(width)
        .map(|i| {
            let Some(here) = spots[i] else { return 1.0 };
            let (x, y) = (i % width, i / width);
            let (mut sum, mut weights) = (0.0, 0.0);
            for v in y.saturating_sub(RADIUS)..height.min(y + RADIUS + 1) {
                for u in x.saturating_sub(RADIUS)..width.min(x + RADIUS + 1) {
                    if let Some(there) = &spots[v * width + u] {
                        let weight = likeness(&here, there, apart) * tent(x, u) * tent(y, v);
                        sum += weight * there.open;
                        weights += weight;
                    }
                }
            }
            sum / weights
        })
        .collect()
}

fn tent(a: usize, b: usize) -> f32 {
    1.0 - a.abs_diff(b) as f32 / (RADIUS + 1) as f32
}

/// 1 for points of one plane, less as normals turn and as points leave each other's planes; never 0.
#[inline]
fn likeness(a: &Spot, b: &Spot, apart: f32) -> f32 {
    let off = (b.point - a.point).dot(a.normal).abs() * apart;
    let turn = a.normal.dot(b.normal).max(0.0);
    turn * turn * turn * turn * (1.0 - off).max(0.0) + 1e-9
}
