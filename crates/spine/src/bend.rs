//! How each side bends across the curve at a foot: the curvature that a curvature-continuous profile takes over.

use crate::Rail;
use crate::curve::face_normal;
use crate::fair::{Sample, pairs};
use crate::patch::Patch;
use glam::DVec3;
use mesh_core::{Adjacency, FaceId, HalfedgeId, Positions};
use mesh_query::ClosestPoint;
use rayon::prelude::*;

/// How far the surface is followed to each side of a foot, in radii: the first, or to the second where the facets are so
/// wide that fewer than [`FOLDS`] have been met.
const WAY: [f64; 2] = [0.5, 2.0];
const FOLDS: usize = 3;
/// An edge that turns less than this, in radians, lies within a flat face.
const FLAT: f64 = 1e-3;
/// An edge that turns more than this (40°), in radians, ends the side.
const CREASE: f64 = 0.7;
/// What is measured over less than this, in radii, counts for nothing.
const LEAST: f64 = 0.25;
/// Half the width of the kernel along the linkage, in radii.
const ALONG: f64 = 0.5;
/// The bends allowed, times the radius: a side that bends like the ball leaves nothing to blend, and one that bends away
/// much more sharply than the ball would be followed over its horizon.
const BENDS: [f64; 2] = [-2.0, 0.95];

impl Rail {
    /// Measures every sample's [`Sample::bends`] on the mesh that was rolled on.
    ///
    /// Each foot's side is followed in the plane of ball and feet, half a radius both ways, and a line is fitted to its
    /// direction over its length: on a circle of any radius, off by a share of the square of facet over window. The
    /// values are averaged half a radius along the linkage. Time: linear in the facets met.
    pub fn measure_bends<M: Adjacency + Positions + Sync>(&mut self, mesh: &M) {
        let patches = &self.patches;
        let measured: Vec<[Option<f64>; 2]> = self
            .samples
            .par_iter()
            .map(|s| [0, 1].map(|side| Slice::of(mesh, &patches[side], s, side).and_then(Slice::bend)))
            .collect();
        let mut at = vec![0.0];
        for (here, next) in pairs(&self.samples, self.closed) {
            at.push(at[at.len() - 1] + here.advance(next));
        }
        for (i, sample) in self.samples.iter_mut().enumerate() {
            let near = neighbours(&at, self.closed, i, ALONG * sample.radius);
            let [least, most] = BENDS.map(|b| b / sample.radius);
            sample.bends = [0, 1].map(|side: usize| {
                let known = near.iter().filter_map(|&(k, weight)| Some((measured[k][side]?, weight)));
                let (sum, weight) = known.fold((0.0, 0.0), |(s, w), (bend, weight)| (s + weight * bend, w + weight));
                if weight > 0.0 { (sum / weight).clamp(least, most) } else { 0.0 }
            });
        }
    }
}

/// The samples within `reach` of the `i`-th, with weights that fall evenly with the distance. `at` holds the lengths up to
/// each sample, and of a closed rail the whole length last.
fn neighbours(at: &[f64], closed: bool, i: usize, reach: f64) -> Vec<(usize, f64)> {
    let n = if closed { at.len() - 1 } else { at.len() };
    let mut near = vec![(i, reach)];
    for forwards in [true, false] {
        for j in 1..n {
            let k = if forwards { i + j } else { n + i - j } % n;
            let beyond_end = (k < i) == forwards;
            if beyond_end && !closed {
                break;
            }
            let way = (at[k] - at[i]).abs();
            let distance = if beyond_end { at[n] - way } else { way };
            if distance >= reach {
                break;
            }
            near.push((k, reach - distance));
        }
    }
    near
}

/// The section of a side by the plane of a ball and its feet: straight pieces with their directions.
struct Slice {
    /// Where along the section a piece begins and ends, from the foot, and its angle to the tangent there: positive where
    /// the section rises towards the ball along its way.
    pieces: Vec<([f64; 2], f64)>,
    radius: f64,
}

impl Slice {
    fn of<M: Adjacency + Positions>(mesh: &M, patch: &Patch, ball: &Sample, side: usize) -> Option<Self> {
        let (foot, other) = (&ball.feet[side], &ball.feet[1 - side]);
        let up = (ball.center - foot.point).normalize_or_zero();
        // Towards the other foot, along the tangent plane: into the blend.
        let inwards = (other.point - foot.point).reject_from(up).normalize_or_zero();
        if up == DVec3::ZERO || inwards == DVec3::ZERO {
            return None;
        }
        let walk = Walk { mesh, origin: foot.point, square: up.cross(inwards), up, radius: ball.radius };
        let in_patch = |f: FaceId| patch.faces.binary_search(&f).is_ok();
        let mut pieces = walk.along(foot, inwards, in_patch)?;
        let outwards = walk.along(foot, -inwards, |_| true)?;
        pieces.extend(outwards.into_iter().map(|([from, to], angle)| ([-to, -from], -angle)));
        Some(Self { pieces, radius: ball.radius })
    }

    /// The slope of the line that fits the angles best, over the length.
    fn bend(self) -> Option<f64> {
        let length: f64 = self.pieces.iter().map(|([from, to], _)| to - from).sum();
        if length < LEAST * self.radius {
            return None;
        }
        let middle = self.pieces.iter().map(|([from, to], _)| 0.5 * (to * to - from * from)).sum::<f64>() / length;
        let moment: f64 =
            self.pieces.iter().map(|([from, to], angle)| angle * (to - from) * (0.5 * (from + to) - middle)).sum();
        Some(12.0 * moment / length.powi(3))
    }
}

/// A way over the facets in a plane.
struct Walk<'a, M> {
    mesh: &'a M,
    /// A point of the plane, and its normal.
    origin: DVec3,
    square: DVec3,
    /// In the plane, towards the ball.
    up: DVec3,
    radius: f64,
}

impl<M: Adjacency + Positions> Walk<'_, M> {
    /// From `foot` in the direction of `ahead`, over faces of a kind: pieces as of [`Slice`].
    fn along(&self, foot: &ClosestPoint, ahead: DVec3, kind: impl Fn(FaceId) -> bool) -> Option<Vec<([f64; 2], f64)>> {
        let mesh = self.mesh;
        let [usual, longest] = WAY.map(|way| way * self.radius);
        let mut pieces: Vec<([f64; 2], f64)> = Vec::new();
        let (mut face, mut from, mut run, mut folds) = (foot.face, foot.point, 0.0, 0);
        let mut entered = None;
        loop {
            let exit = (0..3)
                .map(|corner| HalfedgeId::new(face, corner))
                .filter(|&h| Some(h) != entered)
                .filter_map(|h| Some((h, self.crossing(h)?)))
                .max_by(|a, b| (a.1 - from).dot(ahead).total_cmp(&(b.1 - from).dot(ahead)));
            // A foot at a corner of its face may lie within rounding of a plane that misses the face.
            let Some((exit, to)) = exit else { return (!pieces.is_empty()).then_some(pieces) };
            let step = self.square.cross(face_normal(mesh, exit)).normalize_or_zero();
            let step = if step.dot(ahead) < 0.0 { -step } else { step };
            let angle = step.dot(self.up).atan2(step.dot(ahead));
            if let Some((_, before)) = pieces.last() {
                let turn = (angle - before).abs();
                if turn > CREASE {
                    return Some(pieces);
                }
                folds += usize::from(turn > FLAT);
            }
            let end = run + to.distance(from);
            let limit = if folds < FOLDS { longest } else { usual };
            pieces.push(([run, end.min(limit.max(run))], angle));
            let onwards = mesh.twin(exit).filter(|t| end < limit && kind(t.face()));
            let Some(next) = onwards else { return Some(pieces) };
            (face, from, run, entered) = (next.face(), to, end, Some(next));
        }
    }

    /// Where the plane crosses an edge. The side of each vertex is one rounded number, and zero counts as positive, so
    /// that a plane that enters a face also leaves it.
    fn crossing(&self, h: HalfedgeId) -> Option<DVec3> {
        let [a, b] = self.mesh.ends(h);
        let [p, q] = [a, b].map(|x| (x - self.origin).dot(self.square));
        ((p < 0.0) != (q < 0.0)).then(|| a.lerp(b, p / (p - q)))
    }
}
