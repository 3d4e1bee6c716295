//! Primitives as anyone makes them, in places where everything coincides.

use fusion::blend::{self, Overlap};
use fusion::join::{Params, join};
use glam::DVec3;
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
            let params = Params { operation, blend: Some(blend), format: Format::Obj };
            let made = join(&parts, &params, &Watch::default()).unwrap();
            assert!(validate(&made.model.mesh).is_closed());
            assert_eq!(made.report.figures["strips"], 2.0);
        }
    }
}
