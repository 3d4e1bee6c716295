//! Solids that cross in circles and in the curve of two cylinders, at any resolution, in a generic pose.

use super::truth::{Shape, Spine, Truth};
use glam::{DAffine3, DQuat, DVec3, EulerRot};
use mesh_core::{Adjacency, Connected, FaceId, Faces, Positions, TriMesh, centroid, dihedral_angle, shapes};
use std::f64::consts::{FRAC_PI_2, TAU};
use tri_intersect::Operation::{self, Difference, Intersection, Union};

/// Two parts, what to do with them, and what must come out.
pub struct Case {
    pub parts: [Connected<TriMesh>; 2],
    pub operation: Operation,
    pub truth: Truth,
}

/// What kind of parts cross.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pair {
    PlateSphere,
    PlateCylinder,
    Spheres,
    /// Cylinder a of this radius, about x, ends in cylinder b of radius 1, about z.
    Branch(f64),
    /// The same with a running right through.
    Cross(f64),
}

pub const RADIUS: f64 = 0.25;

/// The smaller radius of a pair: its mesh halves as evenly as that of radius 1.
pub const SMALLER: f64 = 2.0 / 3.0;

/// Segments around a cylinder, and four times those along an icosahedron's edge, at the coarsest.
pub const COARSE: u32 = 24;

impl Case {
    /// `n` segments around a cylinder of radius 1, edges of about that length on spheres, a ball of radius `r`.
    pub fn new(pair: Pair, operation: Operation, n: u32, r: f64) -> Self {
        let sides = match operation {
            Union => [1.0, 1.0],
            Difference => [-1.0, 1.0],
            Intersection => [-1.0, -1.0],
        };
        let sphere = |z: f64, radius: f64, seed: f64| {
            let turn = DQuat::from_euler(EulerRot::XYZ, 0.3 + seed, 0.7 * seed, 1.1);
            let mesh = shapes::geodesic_sphere(radius, (f64::from(n) * radius / 4.0).round() as u32);
            (shapes::posed(mesh, turn, z * DVec3::Z), Shape::Sphere { z, radius })
        };
        let plate = || {
            // The plate's own middle and orientation in its plane mean nothing to the truth.
            let turn = DQuat::from_rotation_z(0.4);
            (shapes::posed(shapes::cuboid(DVec3::new(6.0, 6.5, 3.0)), turn, DVec3::new(0.1, 0.2, -1.5)), Shape::Plane)
        };
        // About z, `spin` in segments.
        let cylinder = |radius: f64, height: f64, spin: f64| {
            let count = (f64::from(n) * radius / 4.0).round() as u32 * 4;
            let rows = (height / (TAU * radius / f64::from(count))).round() as u32;
            let turn = DQuat::from_rotation_z(spin * TAU / f64::from(count));
            shapes::posed(shapes::cylinder(radius, height, count, rows), turn, DVec3::ZERO)
        };
        let ((a, shape_a), (b, shape_b)) = match pair {
            Pair::PlateSphere => (plate(), sphere(0.3, 1.0, 0.2)),
            Pair::PlateCylinder => (
                plate(),
                (
                    shapes::posed(cylinder(1.0, 2.0, 0.3), DQuat::IDENTITY, DVec3::new(0.0, 0.0, 0.1)),
                    Shape::Cylinder { axis: DVec3::Z, radius: 1.0 },
                ),
            ),
            Pair::Spheres => (sphere(0.0, 1.0, 0.2), sphere(1.1, 2.0 / 3.0, 0.5)),
            Pair::Branch(radius) | Pair::Cross(radius) => {
                // Of equal cylinders, the one that ends turns facets, the other an edge to where they are tangent.
                let equal = radius == 1.0;
                let long = matches!(pair, Pair::Cross(_));
                let (length, shift) = if long { (5.0, 0.1) } else { (2.6, 1.3) };
                let a = cylinder(radius, length, if equal { 0.5 } else { 0.3 });
                let a = shapes::posed(a, DQuat::from_rotation_y(FRAC_PI_2), DVec3::new(shift, 0.0, 0.0));
                let b = cylinder(1.0, 4.4, if equal { 0.0 } else { 0.2 });
                ((a, Shape::Cylinder { axis: DVec3::X, radius }), (b, Shape::Cylinder { axis: DVec3::Z, radius: 1.0 }))
            }
        };
        let spine = match (shape_a, shape_b) {
            (Shape::Plane, Shape::Sphere { z, radius }) => {
                let (reach, rise) = (radius + sides[1] * r, z - sides[0] * r);
                Spine::Circle { z: sides[0] * r, radius: (reach * reach - rise * rise).sqrt() }
            }
            (Shape::Plane, Shape::Cylinder { radius, .. }) => {
                Spine::Circle { z: sides[0] * r, radius: radius + sides[1] * r }
            }
            (Shape::Sphere { radius: ra, .. }, Shape::Sphere { z, radius: rb }) => {
                let (da, db) = (ra + sides[0] * r, rb + sides[1] * r);
                let height = (z * z + da * da - db * db) / (2.0 * z);
                Spine::Circle { z: height, radius: (da * da - height * height).sqrt() }
            }
            (Shape::Cylinder { radius: ra, .. }, Shape::Cylinder { radius: rb, .. }) => {
                Spine::Cylinders { a: ra + sides[0] * r, b: rb + sides[1] * r, both: matches!(pair, Pair::Cross(_)) }
            }
            _ => unreachable!("no such pair"),
        };
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.31, -0.47, 0.83);
        let shift = DVec3::new(0.37, -0.22, 0.51);
        let solid = |mesh| Connected::new(shapes::posed(mesh, turn, shift)).expect("procedural shapes are manifold");
        Self {
            parts: [solid(a), solid(b)],
            operation,
            truth: Truth {
                shapes: [shape_a, shape_b],
                sides,
                radius: r,
                spine,
                pose: DAffine3::from_rotation_translation(turn, shift),
            },
        }
    }

    /// Of the facets of `part` that the ball comes near: how far they stand off the exact surface at most, and the
    /// largest angle between two neighbours.
    pub fn coarseness(&self, part: usize) -> (f64, f64) {
        let (mesh, truth) = (&self.parts[part], &self.truth);
        let near = |f: FaceId| {
            let corners = mesh.triangle(f);
            let on_shape = corners.iter().all(|&p| truth.part_distance(part, p).abs() < 1e-9);
            let middle = centroid(corners);
            let touched = corners.iter().chain([&middle]).any(|&p| truth.near(p).distance < 1.1 * truth.radius);
            on_shape && touched
        };
        let used: Vec<bool> = mesh.face_ids().map(near).collect();
        let (mut sagitta, mut angle) = (0.0f64, 0.0f64);
        for f in mesh.face_ids().filter(|f| used[f.index()]) {
            let [a, b, c] = mesh.triangle(f);
            for (i, j) in (0..=6).flat_map(|i| (0..=6 - i).map(move |j| (i, j))) {
                let (u, v) = (f64::from(i) / 6.0, f64::from(j) / 6.0);
                let p = u * a + v * b + (1.0 - u - v) * c;
                sagitta = sagitta.max(truth.part_distance(part, p).abs());
            }
            for h in f.halfedges() {
                if mesh.twin(h).is_some_and(|t| used[t.face().index()]) {
                    angle = angle.max(dihedral_angle(mesh, h).unwrap_or(0.0).abs());
                }
            }
        }
        (sagitta, angle)
    }
}
