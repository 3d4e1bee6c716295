//! What the curvature of the profiles' plane does at the linkages: an arc's jumps, that of `g2` fades with the chords.

use super::cases::Pair::{self, PlateCylinder, PlateSphere, Spheres};
use super::cases::{COARSE, Case, RADIUS};
use super::measure::run;
use super::truth::Shape;
use fusion::blend::{Drawing, Sketch};
use glam::DVec3;
use profile_nurbs::Profile;
use tri_intersect::Operation::{self, Difference, Intersection, Union};

/// Mean and largest of the jump at the linkage on each part, and the mean chord: the curvature of the circle
/// through the first three points of each profile, towards the ball, less the part's own.
fn jumps(case: &Case, profile: &Profile, tolerance: f64) -> ([[f64; 2]; 2], f64) {
    let sketch = Sketch::new();
    let done = run(case, |p| {
        p.profile = profile.clone();
        p.tolerance = tolerance;
        p.snap = 0.0;
        p.sketch = sketch.clone();
    })
    .expect("clean cases blend");
    let sewn = &done.blended.mesh.positions;
    let Drawing::Lines(profiles) = &sketch.drawings()["curve-0-profiles"] else { panic!("profiles are lines") };
    let mut found = [[0.0f64; 2]; 2];
    let (mut chords, mut count) = (0.0, 0.0);
    for (points, _) in profiles {
        let n = points.len();
        let middle = points[n / 2];
        assert!(sewn.iter().any(|p| p.distance(middle) < 1e-9), "what is drawn is what is sewn in");
        for three in [[0, 1, 2], [n - 1, n - 2, n - 3]] {
            let [a, b, c] = three.map(|i| points[i]);
            let part = usize::from(case.truth.part_distance(0, a).abs() > case.truth.part_distance(1, a).abs());
            let jump = (bend(a, b, c, points[n - 1 - three[0]]) - case.own_bend(part)).abs();
            found[part] = [found[part][0] + jump, found[part][1].max(jump)];
            chords += a.distance(b) / 2.0;
        }
        count += 1.0;
    }
    (found.map(|[sum, worst]| [sum / count, worst]), chords / count)
}

/// The curvature of the circle through three points, positive where it bends to the side of a fourth.
fn bend(a: DVec3, b: DVec3, c: DVec3, inside: DVec3) -> f64 {
    let (u, v) = (b - a, c - b);
    let size = 2.0 * u.cross(v).length() / (u.length() * v.length() * a.distance(c));
    size.copysign(v.reject_from(u).dot(inside - a))
}

#[test]
fn g2_takes_over_the_curvature_of_flat_straight_and_round_sides() {
    let cases: [(Pair, Operation); 4] =
        [(PlateCylinder, Union), (PlateSphere, Union), (PlateSphere, Intersection), (Spheres, Difference)];
    for (pair, operation) in cases {
        let case = Case::new(pair, operation, 2 * COARSE, RADIUS);
        let name = format!("{pair:?} {operation:?}");
        let arc = jumps(&case, &Profile::Arc, 1e-4);
        let [coarse, fine] = [1e-4, 2e-5].map(|tolerance| jumps(&case, &Profile::G2, tolerance));
        println!("{name}: arc {arc:?}, g2 {coarse:?} {fine:?}");
        for part in 0..2 {
            let known = 1.0 / RADIUS - case.own_bend(part);
            assert!((arc.0[part][1] / known - 1.0).abs() < 0.05, "{name}: {arc:?}, known {known}");
            let limit = (fine.0[part][0] * coarse.1 - coarse.0[part][0] * fine.1) / (coarse.1 - fine.1);
            assert!(limit.abs() < 0.06 * known && fine.0[part][1] < 0.2 * known, "{name}: {limit} {coarse:?} {fine:?}");
        }
    }
}

impl Case {
    /// The curvature of a part's exact surface towards the ball, in the plane through the axis.
    fn own_bend(&self, part: usize) -> f64 {
        match self.truth.shapes[part] {
            Shape::Sphere { radius, .. } => -self.truth.sides[part] / radius,
            Shape::Plane | Shape::Cylinder { .. } => 0.0,
        }
    }
}
