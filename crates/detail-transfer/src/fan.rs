//! Geodesic fans: what the detail around a vertex looks like, branch by branch.

use crate::relief::Relief;
use glam::DVec2;
use mesh_core::{Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, corner_angle};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Branches of a fan, evenly around the vertex.
pub(crate) const BRANCHES: usize = 8;
/// Samples on each branch, evenly spaced.
pub(crate) const STEPS: usize = 3;
/// Samples of a fan.
pub(crate) const SAMPLES: usize = BRANCHES * STEPS;
/// Numbers on a branch: three coordinates a sample, along the branch, across and along the normal.
pub(crate) const BRANCH: usize = 3 * STEPS;
/// Numbers of a fan.
pub(crate) const NUMBERS: usize = 3 * SAMPLES;

/// A point on a branch, as a mean of three vertices' values, each turned from its own frame to that of the branch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub vertices: [u32; 3],
    weights: [f32; 3],
    /// Cosine and sine of the branch's direction in each vertex's frame.
    directions: [[f32; 2]; 3],
}

const NONE: u32 = u32::MAX;

impl Sample {
    const MISSING: Self = Self { vertices: [NONE; 3], weights: [0.0; 3], directions: [[1.0, 0.0]; 3] };

    /// Whether the branch ends before this sample.
    pub fn is_missing(&self) -> bool {
        self.vertices[0] == NONE
    }

    /// The value here of a field given in the vertices' frames.
    pub fn of(&self, field: &[[f32; 3]]) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for k in 0..3 {
            let ([x, y, z], [c, s]) = (field[self.vertices[k] as usize], self.directions[k]);
            sum[0] += self.weights[k] * (c * x + s * y);
            sum[1] += self.weights[k] * (c * y - s * x);
            sum[2] += self.weights[k] * z;
        }
        sum
    }
}

/// The samples of a vertex's fan, branch by branch.
pub(crate) type Fan = [Sample; SAMPLES];

/// Fans of radius `length` on the base of a relief. Time ∝ faces crossed, parallel.
pub(crate) fn fans(relief: &Relief, vertices: &[u32], length: f64) -> Vec<Fan> {
    vertices.par_iter().map(|&v| fan(relief, VertexId(v), length)).collect()
}

fn fan(relief: &Relief, v: VertexId, length: f64) -> Fan {
    let base = relief.base();
    let mut out = [Sample::MISSING; SAMPLES];
    let mut wedges: Vec<(HalfedgeId, f64)> = vec![];
    let mut total = 0.0;
    for h in base.ring(v) {
        wedges.push((h, total));
        total += corner_angle(base.triangle(h.face()), h.corner());
    }
    let Some(&(first, _)) = wedges.first() else { return out };
    if base.twin(first).is_none() || total <= 0.0 {
        return out;
    }
    // Directions count from the frame's tangent, angles around the vertex from its first edge.
    let frame = relief.frames()[v.index()];
    let edge = frame.local(base.position(base.head(first)) - base.position(v));
    let start = -edge.y.atan2(edge.x) * total / TAU;
    for (branch, samples) in out.chunks_exact_mut(STEPS).enumerate() {
        let angle = (start + total * branch as f64 / BRANCHES as f64).rem_euclid(total);
        let k = wedges.partition_point(|w| w.1 <= angle).max(1) - 1;
        let (h, from) = wedges[k];
        walk(relief, h, angle - from, length, samples);
    }
    out
}

/// Follows the straight line that leaves the tail of `h` at `angle` to the left of it, over unfolded faces.
fn walk(relief: &Relief, h: HalfedgeId, angle: f64, length: f64, samples: &mut [Sample]) {
    let base = relief.base();
    let place = |v: VertexId| base.position(v);
    let (o, a, b) = (base.tail(h), base.head(h), base.head(h.next()));
    let wedge = corner_angle(base.triangle(h.face()), h.corner());
    // The line is the x axis; every face is laid beside the one before.
    let turned = |v: VertexId, angle: f64| DVec2::from_angle(angle) * place(v).distance(place(o));
    let mut flat = [DVec2::ZERO, turned(a, -angle), turned(b, wedge - angle)];
    let mut corners = [o, a, b];
    let mut exit = h.next();
    let mut step = 0;
    for _ in 0..MOST_FACES {
        let [right, left] = [flat[1], flat[2]];
        let share = right.y / (right.y - left.y);
        let leaves = right.x + share * (left.x - right.x);
        while step < STEPS {
            let at = length * (step + 1) as f64 / STEPS as f64;
            if at > leaves {
                break;
            }
            samples[step] = sample(relief, corners, flat, DVec2::new(at, 0.0));
            step += 1;
        }
        if step == STEPS || !leaves.is_finite() {
            return;
        }
        let Some(entry) = base.twin(exit) else { return };
        let apex = base.head(entry.next());
        let far = unfold(base, corners[1], corners[2], apex, right, left);
        // `entry` runs from the left end to the right one, seen from behind; the apex takes the place of one of them.
        if far.y > 0.0 {
            (corners, flat, exit) = ([corners[2], corners[1], apex], [left, right, far], entry.next());
        } else {
            (corners, flat, exit) = ([corners[1], apex, corners[2]], [right, far, left], entry.prev());
        }
    }
}

/// More faces than a branch crosses on any mesh worth looking at.
const MOST_FACES: usize = 4096;

/// Where the apex of the triangle behind the edge right–left lies in the plane.
fn unfold(
    base: &Connected<TriMesh>,
    right: VertexId,
    left: VertexId,
    apex: VertexId,
    flat_right: DVec2,
    flat_left: DVec2,
) -> DVec2 {
    let [r, l, p] = [right, left, apex].map(|v| base.position(v));
    let (along, to) = (l - r, p - r);
    let squared = along.length_squared();
    let x = to.dot(along) / squared;
    let y = along.cross(to).length() / squared;
    let flat = flat_left - flat_right;
    // Behind the edge, seen from where the line comes from: to the right of the way from right to left.
    flat_right + x * flat - y * flat.perp()
}

/// The mean of a face's corners at a place of its unfolded plane.
fn sample(relief: &Relief, corners: [VertexId; 3], flat: [DVec2; 3], at: DVec2) -> Sample {
    let [a, b, c] = flat;
    let area = (b - a).perp_dot(c - a);
    let u = (b - at).perp_dot(c - at) / area;
    let v = (c - at).perp_dot(a - at) / area;
    let weights = [u, v, 1.0 - u - v].map(|w| w.clamp(0.0, 1.0));
    let sum: f64 = weights.iter().sum();
    // The line's direction as a combination of two sides.
    let (e, f) = (b - a, c - a);
    let (s, t) = (DVec2::X.perp_dot(f) / area, e.perp_dot(DVec2::X) / area);
    let [p, q, r] = corners.map(|v| relief.base().position(v));
    let ahead = s * (q - p) + t * (r - p);
    let directions = corners.map(|v| {
        let local = relief.frames()[v.index()].local(ahead);
        let unit = DVec2::new(local.x, local.y).try_normalize().unwrap_or(DVec2::X);
        [unit.x as f32, unit.y as f32]
    });
    if !sum.is_finite() {
        return Sample::MISSING;
    }
    Sample { vertices: corners.map(|v| v.0), weights: weights.map(|w| (w / sum) as f32), directions }
}
