//! Shapes of revolution: tori, uv-spheres, cylinders, cones, tubes, capsules.

use crate::ids::VertexId;
use crate::mesh::TriMesh;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Turns the profile (radius, height) around the z axis in `segments` steps; points with zero radius become one vertex.
///
/// The profile runs with the solid on its left, seen with the radius to the right and the height up. `Ends::Joined`
/// leads its last point to its first.
fn lathe(profile: &[DVec2], segments: u32, ends: Ends) -> TriMesh {
    let n = segments.max(3);
    let row = |p: &DVec2| {
        let count = if p.x == 0.0 { 1 } else { n };
        let angle = |i: u32| TAU * f64::from(i) / f64::from(n);
        (0..count).map(|i| (p.x * DVec2::from_angle(angle(i))).extend(p.y)).collect()
    };
    weave(&profile.iter().map(row).collect::<Vec<_>>(), ends)
}

/// What becomes of the first and last row of a weave.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ends {
    /// They stay boundaries, unless they are points.
    Free,
    /// The last row is joined to the first.
    Joined,
}

/// Triangles between consecutive closed rows of points, seen from outside counter-clockwise with rows going up. All
/// rows have the same number of points, or one: a pole.
pub(super) fn weave(rows: &[Vec<DVec3>], ends: Ends) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut starts = vec![];
    for row in rows {
        starts.push(mesh.positions.len() as u32);
        mesh.positions.extend(row);
    }
    let n = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let at = |row: usize, i: u32| VertexId(starts[row] + i % rows[row].len() as u32);
    for row in 0..if ends == Ends::Joined { rows.len() } else { rows.len().saturating_sub(1) } {
        let up = (row + 1) % rows.len();
        for i in 0..n {
            let [a, b, c, d] = [at(row, i), at(row, i + 1), at(up, i + 1), at(up, i)];
            // Beside a pole one of the two has shrunk to nothing.
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
    lathe(&profile, around, Ends::Joined)
}

/// A sphere around the origin with poles on the z axis: `segments` meridians (3 at least), `rings` bands (2 at least).
pub fn uv_sphere(radius: f64, segments: u32, rings: u32) -> TriMesh {
    lathe(&arc_profile(radius, 0.0, -0.5 * PI, 0.5 * PI, rings.max(2)), segments, Ends::Free)
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
    lathe(&side([radius, radius], height, rows).collect::<Vec<_>>(), segments, Ends::Free)
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
    lathe(&profile, segments, Ends::Free)
}

/// A closed pipe around the z axis, centred on the origin, with its inner and outer radius. Genus 1.
pub fn tube(inner: f64, outer: f64, height: f64, segments: u32, rows: u32) -> TriMesh {
    let mut profile: Vec<DVec2> = side([outer, outer], height, rows).collect();
    let inside: Vec<DVec2> = side([inner, inner], height, rows).collect();
    profile.extend(inside.into_iter().rev());
    lathe(&profile, segments, Ends::Joined)
}

/// A cylinder of the given height with half spheres on both ends, around the z axis, centred on the origin. `rings`
/// bands on each half sphere, `rows` on the side.
pub fn capsule(radius: f64, height: f64, segments: u32, rings: u32, rows: u32) -> TriMesh {
    let rings = rings.max(1);
    let mut profile = arc_profile(radius, -0.5 * height, -0.5 * PI, 0.0, rings);
    profile.extend(side([radius, radius], height, rows).skip(1).take(rows.max(1) as usize - 1));
    profile.extend(arc_profile(radius, 0.5 * height, 0.0, 0.5 * PI, rings));
    lathe(&profile, segments, Ends::Free)
}
