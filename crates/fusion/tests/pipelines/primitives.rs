//! Primitives as anyone makes them, in places where everything coincides.

use fusion::blend::{self, Overlap, Surface};
use fusion::join::{Params, SeamChoice, join};
use glam::{DQuat, DVec3};
use mesh_core::{Watch, shapes, validate};
use mesh_io::{Format, Model};
use tri_intersect::Operation;

/// A plate of twelve triangles and a post with a corner on their diagonal, off it by one bit: seam vertices come to lie
/// nearer to each other than rounding can tell, and what the linkages cut between them had no area.
#[test]
fn a_post_with_an_edge_on_the_plates_diagonal() {
    let plate = Model::from(shapes::cuboid(DVec3::new(3.0, 3.0, 0.6)));
    for segments in [16, 64, 96] {
        let post = Model::from(shapes::cylinder(0.5, 2.0, segments, 4));
        let parts = [post, plate.clone()];
        for operation in [Operation::Union, Operation::Difference, Operation::Intersection] {
            let blend = blend::Params { overlap: Overlap::Error, ..blend::Params::new(0.1) };
            let params = Params { operation, blend: Some(blend), seams: SeamChoice::default(), format: Format::Obj };
            let made = join(&parts, &params, &Watch::default()).unwrap();
            assert!(validate(&made.model.mesh).is_closed());
            assert_eq!(made.report.figures["strips"], 2.0);
        }
    }
}

/// A block less one that leaves films of it a millionth thick: no ball fits between the films' two faces, and pieces as
/// large as the block were drawn many times over to find that out.
#[test]
fn films_far_thinner_than_the_ball_are_refused_at_once() {
    let block = Model::from(shapes::posed(shapes::cuboid(DVec3::ONE), DQuat::IDENTITY, DVec3::splat(0.5)));
    let mut taken = shapes::cuboid(DVec3::splat(2.0));
    for p in &mut taken.positions {
        *p = match p.to_array() {
            [1.0, 1.0, 1.0] => DVec3::new(0.999_999, 1.0, 1.000_001),
            [1.0, 1.0, -1.0] => DVec3::new(1.0, 1.0, -0.999_999),
            _ => *p,
        };
    }
    let blend = blend::Params { surface: Surface::Field, ..blend::Params::new(0.03) };
    let params = Params {
        operation: Operation::Difference,
        blend: Some(blend),
        seams: SeamChoice::default(),
        format: Format::Obj,
    };
    let refusal = join(&[block, taken.into()], &params, &Watch::default()).err().unwrap().to_string();
    assert!(refusal.contains("no ball touches both sides"), "{refusal}");
}
