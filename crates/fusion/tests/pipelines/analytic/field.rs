//! The blend as a field against the exact canal surface.

use super::cases::Pair::{self, Branch, Cross, PlateCylinder, PlateSphere, Spheres};
use super::cases::{COARSE, Case, RADIUS, SMALLER};
use super::measure::{measure, run};
use super::{assert_local, assert_valid, row};
use fusion::blend::{Overlap, Surface};
use tri_intersect::Operation::{self, Difference, Intersection, Union};

/// Within a hundredth of the radius, or within what the input's own facets make of it: a ball between them is off by up
/// to twice their sagitta over cos(φ/2), to which the plate adds where the profile is nearly a half circle (the edge of a lens).
fn check(name: &str, pair: Pair, operation: Operation) {
    let case = Case::new(pair, operation, 4 * COARSE, RADIUS);
    let run = run(&case, |p| p.surface = Surface::Field).unwrap_or_else(|e| panic!("{name}: {e}"));
    let m = measure(&case, &run);
    println!("{name} | largest {:.2}% of r | {}", 100.0 * m.inner[0] / RADIUS, row(&m, run.milliseconds));
    assert_valid(&run);
    assert!(assert_local(&case, &run) > 0, "{name}: nothing is out of reach");
    assert!(run.blended.fields > 0 && run.blended.strips == 0 && run.blended.shrunk.is_empty(), "{name}");
    assert!(m.inner[0] <= 0.01 * RADIUS || m.inner_share <= 1.5, "{name}: {m:?}");
    assert!(m.linkage[0] <= 0.01 * RADIUS || m.linkage_share <= 1.0, "{name}: {m:?}");
}

#[test]
fn plates() {
    for operation in [Union, Difference, Intersection] {
        check("plate, sphere", PlateSphere, operation);
        check("plate, cylinder", PlateCylinder, operation);
    }
}

#[test]
fn spheres() {
    for operation in [Union, Difference, Intersection] {
        check("sphere, sphere", Spheres, operation);
    }
}

#[test]
fn cylinders() {
    check("branch", Branch(SMALLER), Union);
    check("smaller - larger cylinder", Cross(SMALLER), Difference);
    check("smaller & larger cylinder", Cross(SMALLER), Intersection);
    check("cylinder - equal cylinder", Cross(1.0), Difference);
}

/// Where two equal cylinders touch, the blend has no width; a sweep folds there.
#[test]
fn equal_cylinders_are_served() {
    for (pair, operation) in [(Branch(1.0), Union), (Cross(1.0), Intersection)] {
        for n in [COARSE, 2 * COARSE] {
            let case = Case::new(pair, operation, n, RADIUS);
            let run = run(&case, |p| p.surface = Surface::Field).unwrap_or_else(|e| panic!("{pair:?} {n}: {e}"));
            let m = measure(&case, &run);
            println!("{pair:?} {n} | largest {:.2}% of r | {}", 100.0 * m.inner[0] / RADIUS, row(&m, run.milliseconds));
            assert_valid(&run);
            assert!(m.inner[0] <= 0.05 * RADIUS + m.sagitta, "{pair:?} {n}: {m:?}");
        }
    }
}

/// Where a sweep of the full ball folds, it is refused, made smaller, or trimmed: then no ball is smaller than asked for.
#[test]
fn a_trimmed_blend_has_the_full_radius() {
    let case = Case::new(Branch(1.0), Union, COARSE, RADIUS);
    assert!(run(&case, |p| p.overlap = Overlap::Error).is_err());
    let trimmed = run(&case, |p| p.overlap = Overlap::Full).unwrap_or_else(|e| panic!("{e}"));
    assert_valid(&trimmed);
    assert!(trimmed.blended.fields > 0 && trimmed.blended.shrunk.is_empty() && trimmed.blended.full_share == 1.0);
    let m = measure(&case, &trimmed);
    assert!(m.inner[0] <= 0.05 * RADIUS + m.sagitta, "{m:?}");
    // Nothing is trimmed where the ball can be swept.
    let clean = Case::new(PlateSphere, Union, COARSE, RADIUS);
    let swept = run(&clean, |p| p.overlap = Overlap::Full).unwrap_or_else(|e| panic!("{e}"));
    assert!(swept.blended.fields == 0 && swept.blended.strips == 1);
}
