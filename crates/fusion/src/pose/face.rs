//! Parts moved so that one of their openings faces another: a rigid alignment with soft correspondences (\[Sharf2006\]).

use super::placement::Motion;
use crate::cut::even;
use glam::{DMat3, DQuat, DVec3};

/// Places on each loop.
const SAMPLES: usize = 96;
/// Rounds of alignment, in which correspondences become sharper.
const ROUNDS: usize = 60;

/// The middle of a loop by length, and the unit normal of its area: for a boundary loop, with the part on its left, out of the opening.
pub(crate) fn opening_axis(points: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let even = even(points, SAMPLES);
    let middle = even.iter().sum::<DVec3>() / even.len() as f64;
    let next = |i: usize| even[(i + 1) % even.len()] - middle;
    let area: DVec3 = (0..even.len()).map(|i| next(i).cross(even[i] - middle)).sum();
    Some((middle, area.try_normalize()?))
}

/// The motion that brings the loop `own` to face the loop `target`, `gap` in front of it: first axis to axis by the shortest turn, then to the
/// least squares of soft correspondences. Lengths in model units; `None` for loops without area.
pub(crate) fn face_to_face(own: &[DVec3], target: &[DVec3], gap: f64) -> Option<Motion> {
    let ((from, axis), (to, facing)) = (opening_axis(own)?, opening_axis(target)?);
    let turn = DQuat::from_rotation_arc(axis, -facing);
    let place = to + gap * facing;
    let mut motion = Motion { rotation: turn, translation: place - turn * from };
    let (own, target) = (even(own, SAMPLES), even(target, SAMPLES));
    let target: Vec<DVec3> = target.iter().map(|p| p + gap * facing).collect();
    let radius = target.iter().map(|p| p.distance(place)).sum::<f64>() / SAMPLES as f64;
    for round in 0..ROUNDS {
        let width = radius * 0.5 * 0.03f64.powf(round as f64 / (ROUNDS - 1) as f64);
        let moved: Vec<DVec3> = own.iter().map(|&p| motion.point(p)).collect();
        let wanted: Vec<DVec3> = moved.iter().map(|&p| soft(p, &target, width)).collect();
        let step = small_motion(&moved, &wanted)?;
        motion = step.after(motion);
    }
    (motion.rotation.is_finite() && motion.translation.is_finite()).then_some(motion)
}

/// The mean of the target near a point, the nearer the weightier.
fn soft(p: DVec3, target: &[DVec3], width: f64) -> DVec3 {
    let least = target.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min);
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for &q in target {
        let w = (-0.5 * (q.distance_squared(p) - least) / (width * width)).exp();
        (sum, weights) = (sum + w * q, weights + w);
    }
    sum / weights
}

/// The rigid motion that takes points nearest to where they are wanted, for small turns.
fn small_motion(points: &[DVec3], wanted: &[DVec3]) -> Option<Motion> {
    let mean = |all: &[DVec3]| all.iter().sum::<DVec3>() / all.len() as f64;
    let (from, to) = (mean(points), mean(wanted));
    let (mut inertia, mut torque) = (DMat3::ZERO, DVec3::ZERO);
    for (p, q) in points.iter().zip(wanted) {
        let (p, q) = (p - from, q - to);
        inertia += p.length_squared() * DMat3::IDENTITY - DMat3::from_cols(p.x * p, p.y * p, p.z * p);
        torque += p.cross(q);
    }
    let turn = inertia.inverse() * torque;
    let rotation = turn.is_finite().then(|| DQuat::from_scaled_axis(turn.clamp_length_max(0.5)))?;
    Some(Motion { rotation, translation: to - rotation * from })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An ellipse turned and moved away comes to face its own image.
    #[test]
    fn an_ellipse_finds_its_image() {
        let ellipse = |n: u32| -> Vec<DVec3> {
            let at = |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(n);
            (0..n).map(at).map(|a| DVec3::new(2.0 * a.cos(), a.sin(), 0.2 * (2.0 * a).cos())).collect()
        };
        let target = ellipse(80);
        // A loop with its part on the left, seen along −z from the other side.
        let mut own = ellipse(50);
        own.reverse();
        let away = DQuat::from_euler(glam::EulerRot::XYZ, 0.2, -0.15, 0.4);
        for p in &mut own {
            *p = away * *p + DVec3::new(3.0, -1.0, 2.0);
        }
        let motion = face_to_face(&own, &target, 0.5).unwrap();
        let (_, facing) = opening_axis(&target).unwrap();
        for p in own {
            let p = motion.point(p) - 0.5 * facing;
            let off = target.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
            assert!(off < 0.12, "{off}");
        }
    }
}
