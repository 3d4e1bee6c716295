//! The material a fillet adds or takes, where Pappus gives it.

use super::cases::Pair::PlateCylinder;
use super::cases::{COARSE, Case, RADIUS};
use super::measure::run;
use mesh_core::volume;
use std::f64::consts::{PI, TAU};
use tri_intersect::Operation::{self, Difference, Intersection, Union};

/// Of the square of side r between plate and cylinder, less the quarter disc, turned around the axis; `out` is 1 where
/// the ball is outside the cylinder and −1 where inside.
fn exact(out: f64) -> f64 {
    let (r, ball) = (RADIUS, 1.0 + out * RADIUS);
    TAU * (r * r * (1.0 + out * 0.5 * r) - 0.25 * PI * r * r * (ball - out * 4.0 * r / (3.0 * PI)))
}

/// The change must be of the right sign and amount at every resolution. The blend's own chords along the rail are a
/// fifth of the radius at most and no shorter than a tenth, which leaves out a share of the volume that does not vanish
/// with the input's edges: chords c stand c²/8ρ off a circle of radius ρ, over an area of about V/0.14·r.
fn changes_by(operation: Operation, added: f64) {
    for k in [1, 2, 4] {
        let case = Case::new(PlateCylinder, operation, k * COARSE, RADIUS);
        let run = run(&case, |p| p.tolerance = 1e-5).expect("clean cases blend");
        let change = volume(&run.blended.mesh) - volume(run.joined.mesh());
        let error = (change - added) / added;
        println!("{operation:?} {}: {change} against {added}, {error:+.2e}", k * COARSE);
        assert!(error.abs() < 0.01, "{error}");
    }
}

#[test]
fn a_valley_is_filled() {
    changes_by(Union, exact(1.0));
}

#[test]
fn the_rim_of_a_hole_is_rounded_off() {
    changes_by(Difference, -exact(1.0));
}

#[test]
fn the_rim_of_a_disc_is_rounded_off() {
    changes_by(Intersection, -exact(-1.0));
}
