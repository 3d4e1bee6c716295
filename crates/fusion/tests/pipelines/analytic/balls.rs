//! Every ball of a rail touches both parts, by brute force over all their triangles.

use super::cases::Pair::{self, Branch, Cross, PlateCylinder, PlateSphere, Spheres};
use super::cases::{COARSE, Case, RADIUS, SMALLER};
use super::measure::join;
use mesh_core::Faces;
use mesh_query::closest_point_on_triangle;
use tri_intersect::Operation::{self, Difference, Intersection, Union};

/// The largest | distance to a part − radius | of any ball, as a share of the radius, and how many are off by more
/// than 1e-9, of how many.
fn misses(pair: Pair, operation: Operation) -> (f64, usize, usize) {
    let case = Case::new(pair, operation, 2 * COARSE, RADIUS);
    let (joined, curves) = join(&case);
    let (mut largest, mut off, mut count) = (0.0f64, 0, 0);
    for curve in &curves {
        let params = spine::Params { step: 0.2 * RADIUS, ..spine::Params::new(RADIUS) };
        let rail = spine::roll(&joined, curve, &curves, &params).expect("clean cases roll");
        assert!(rail.residual <= 1e-9 * RADIUS);
        for sample in &rail.samples {
            let miss = case.parts.each_ref().map(|part| {
                let mesh = part.mesh();
                let distance = mesh
                    .face_ids()
                    .map(|f| closest_point_on_triangle(sample.center, mesh.triangle(f)).0.distance(sample.center))
                    .fold(f64::INFINITY, f64::min);
                (distance - RADIUS).abs() / RADIUS
            });
            let miss = miss[0].max(miss[1]);
            largest = largest.max(miss);
            off += usize::from(miss > 1e-9);
            count += 1;
        }
    }
    (largest, off, count)
}

#[test]
fn balls_outside_touch_both_parts() {
    for pair in [PlateSphere, PlateCylinder, Spheres, Branch(SMALLER)] {
        let (largest, off, count) = misses(pair, Union);
        println!("{pair:?} union: {off} of {count} off, by {largest:.1e} of the radius");
        assert!(largest <= 1e-9, "{pair:?}: {off} of {count} balls are off, by up to {largest:e} of the radius");
    }
}

// Inside a curved part the feet outrun the centre, and the balls put in between are interpolated.
#[test]
fn balls_inside_touch_both_parts() {
    for (pair, operation) in [
        (PlateSphere, Difference),
        (PlateCylinder, Difference),
        (PlateSphere, Intersection),
        (PlateCylinder, Intersection),
        (Spheres, Difference),
        (Spheres, Intersection),
        (Cross(SMALLER), Difference),
        (Cross(SMALLER), Intersection),
        (Cross(1.0), Difference),
    ] {
        let (largest, off, count) = misses(pair, operation);
        println!("{pair:?} {operation:?}: {off} of {count} off, by {largest:.1e} of the radius");
        assert!(largest <= 0.02, "{pair:?} {operation:?}: {off} of {count} off, by up to {largest:e} of the radius");
    }
}
