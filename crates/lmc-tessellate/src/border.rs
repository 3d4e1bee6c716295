//! Smoothing of the zigzag in which the wanted part of the zero set ends.

use crate::grid::Field;
use glam::DVec3;
use mesh_core::{TriMesh, area_vector};

const ROUNDS: usize = 5;

/// Unit normals at all vertices, from area vectors.
pub(crate) fn normals(mesh: &TriMesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for face in &mesh.faces {
        let n = area_vector(face.map(|v| mesh.positions[v.index()]));
        for v in face {
            sums[v.index()] += n;
        }
    }
    sums.iter().map(|n| n.normalize_or_zero()).collect()
}

/// Moves the vertices of each curve towards the middle of their neighbours within the tangent plane, then along the
/// normal back onto the zero set.
pub(crate) fn smooth(mesh: &mut TriMesh, borders: &[Vec<u32>], normals: &[DVec3], field: &impl Field, cell: f64) {
    for _ in 0..ROUNDS {
        for curve in borders {
            let old: Vec<DVec3> = curve.iter().map(|&v| mesh.positions[v as usize]).collect();
            let n = curve.len();
            for (i, &v) in curve.iter().enumerate() {
                let middle = 0.5 * (old[(i + n - 1) % n] + old[(i + 1) % n]);
                let step = 0.5 * (middle - old[i]);
                let normal = normals[v as usize];
                mesh.positions[v as usize] += step - step.dot(normal) * normal;
            }
        }
    }
    let all: Vec<u32> = borders.concat();
    let directions: Vec<DVec3> = all.iter().map(|&v| normals[v as usize]).collect();
    let mut points: Vec<DVec3> = all.iter().map(|&v| mesh.positions[v as usize]).collect();
    onto_zero_set(&mut points, &directions, field, cell);
    for (&v, p) in all.iter().zip(points) {
        mesh.positions[v as usize] = p;
    }
}

/// Moves points along given directions onto the zero set by secants, by less than a cell. Those that find none stay.
pub(crate) fn onto_zero_set(points: &mut [DVec3], directions: &[DVec3], field: &impl Field, cell: f64) {
    const STEPS: usize = 4;
    let at = |points: &[DVec3], moved: &[f64]| -> Vec<DVec3> {
        points.iter().zip(directions).zip(moved).map(|((p, d), m)| *p + *m * *d).collect()
    };
    let step = 1e-2 * cell;
    let mut moved = vec![step; points.len()];
    let mut before = vec![0.0; points.len()];
    let mut values = vec![0.0; points.len()];
    field.values(points, &mut before);
    field.values(&at(points, &moved), &mut values);
    let mut slopes: Vec<f64> = before.iter().zip(&values).map(|(u, v)| (v - u) / step).collect();
    moved.fill(0.0);
    for round in 0..STEPS {
        let steps: Vec<f64> = (0..points.len())
            .map(|i| -before[i] / slopes[i])
            .map(|s| if s.is_finite() { s.clamp(-0.5 * cell, 0.5 * cell) } else { 0.0 })
            .collect();
        for (m, s) in moved.iter_mut().zip(&steps) {
            *m += s;
        }
        if round + 1 == STEPS || steps.iter().all(|s| s.abs() < 1e-9 * cell) {
            break;
        }
        field.values(&at(points, &moved), &mut values);
        for i in 0..points.len() {
            let slope = (values[i] - before[i]) / steps[i];
            // Rounding makes the slope of a tiny step worthless.
            if slope.is_finite() && steps[i].abs() > 1e-6 * cell && slope > 0.1 * slopes[i] {
                slopes[i] = slope;
            }
            before[i] = values[i];
        }
    }
    for ((p, d), m) in points.iter_mut().zip(directions).zip(&moved) {
        if m.abs() < cell {
            *p += *m * *d;
        }
    }
}
