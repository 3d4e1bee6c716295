//! Shapes of revolution: tori, uv-spheres, cylinders, cones, tubes, capsules.

use crate::ids::VertexId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Turns the profile (radius, height) around the z axis in `segments` steps; points with zero radius become one vertex.
///
/// The profile runs with the solid on its left, seen with the radius to the right and the height up. `closed` joins its
/// last point to its first.
fn lathe(profile: &[DVec2], segments: u32, closed: bool) -> TriMesh {
    let n = segments.max(3);
    let mut mesh = TriMesh::default();
    let starts: Vec<u32> = profile
        .iter()
        .map(|p| {
            let start = mesh.positions.len() as u32;
            let on_axis = p.x == 0.0;
            mesh.positions.extend((0..if on_axis { 1 } else { n }).map(|i| {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(n)).sin_cos();
                DVec3::new(p.x * cos, p.x * sin, p.y)
            }));
            start
        })
        .collect();
    let at = |row: usize, i: u32| VertexId(if profile[row].x == 0.0 { starts[row] } else { starts[row] + i % n });
    let rows = profile.len();
    for row in 0..if closed { rows } else { rows.saturating_sub(1) } {
        let up = (row + 1) % rows;
        for i in 0..n {
            let [a, b, c, d] = [at(row, i), at(row, i + 1), at(up, i + 1), at(up, i)];
            // A side that has shrunk to a point on the axis leaves one triangle.
            mesh.faces
                .extend([[a, b, c], [a, c, d]].into_iter().filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
        }
    }
    mesh
}

/// A torus around the z axis: `major` from the axis to the middle of the tube, `minor` the tube's radius, `around`
/// sections of `across` points (3 at least). `2·around·across` triangles.
pub fn torus(major: f64, minor: f64, around: u32, across: u32) -> TriMesh {
    let k = across.max(3);
    let profile: Vec<DVec2> =
        (0..k).map(|i| DVec2::new(major, 0.0) + minor * DVec2::from_angle(TAU * f64::from(i) / f64::from(k))).collect();
    lathe(&profile, around, true)
}

/// A sphere around the origin with poles on the z axis: `segments` meridians (3 at least), `rings` bands (2 at least).
pub fn uv_sphere(radius: f64, segments: u32, rings: u32) -> TriMesh {
    lathe(&arc_profile(radius, 0.0, -0.5 * PI, 0.5 * PI, rings.max(2)), segments, false)
}

/// An arc around (0, height), with exact zeros where it meets the axis.
fn arc_profile(radius: f64, height: f64, from: f64, to: f64, steps: u32) -> Vec<DVec2> {
    (0..=steps)
        .map(|i| {
            let angle = from + (to - from) * f64::from(i) / f64::from(steps);
            let (sin, cos) = angle.sin_cos();
            DVec2::new(if angle.abs() == 0.5 * PI { 0.0 } else { radius * cos }, height + radius * sin)
        })
        .collect()
}

/// Radii from `radii[0]` at the bottom to `radii[1]` at the top as a profile of `rows` bands.
fn side(radii: [f64; 2], height: f64, rows: u32) -> impl Iterator<Item = DVec2> {
    let rows = rows.max(1);
    (0..=rows).map(move |i| {
        let t = f64::from(i) / f64::from(rows);
        DVec2::new((1.0 - t) * radii[0] + t * radii[1], height * (t - 0.5))
    })
}

/// A closed cylinder around the z axis, centred on the origin, its side in `rows` bands.
pub fn cylinder(radius: f64, height: f64, segments: u32, rows: u32) -> TriMesh {
    truncated_cone([radius, radius], height, segments, rows)
}

/// The side of a cylinder alone: two boundary loops.
pub fn open_cylinder(radius: f64, height: f64, segments: u32, rows: u32) -> TriMesh {
    lathe(&side([radius, radius], height, rows).collect::<Vec<_>>(), segments, false)
}

/// A closed cone around the z axis, apex up, centred on half its height, its side in `rows` bands.
pub fn cone(radius: f64, height: f64, segments: u32, rows: u32) -> TriMesh {
    truncated_cone([radius, 0.0], height, segments, rows)
}

/// A closed truncated cone around the z axis with its bottom and top radius, centred on half its height. A radius of
/// zero makes an apex.
pub fn truncated_cone(radii: [f64; 2], height: f64, segments: u32, rows: u32) -> TriMesh {
    let mut profile: Vec<DVec2> = side(radii, height, rows).collect();
    if radii[0] != 0.0 {
        profile.insert(0, DVec2::new(0.0, -0.5 * height));
    }
    if radii[1] != 0.0 {
        profile.push(DVec2::new(0.0, 0.5 * height));
    }
    lathe(&profile, segments, false)
}

/// A closed pipe around the z axis, centred on the origin, with its inner and outer radius. Genus 1.
pub fn tube(inner: f64, outer: f64, height: f64, segments: u32, rows: u32) -> TriMesh {
    let mut profile: Vec<DVec2> = side([outer, outer], height, rows).collect();
    let inside: Vec<DVec2> = side([inner, inner], height, rows).collect();
    profile.extend(inside.into_iter().rev());
    lathe(&profile, segments, true)
}

/// A cylinder of the given height with half spheres on both ends, around the z axis, centred on the origin. `rings`
/// bands on each half sphere, `rows` on the side.
pub fn capsule(radius: f64, height: f64, segments: u32, rings: u32, rows: u32) -> TriMesh {
    let rings = rings.max(1);
    let mut profile = arc_profile(radius, -0.5 * height, -0.5 * PI, 0.0, rings);
    profile.extend(side([radius, radius], height, rows).skip(1).take(rows.max(1) as usize - 1));
    profile.extend(arc_profile(radius, 0.5 * height, 0.0, 0.5 * PI, rings));
    lathe(&profile, segments, false)
}
