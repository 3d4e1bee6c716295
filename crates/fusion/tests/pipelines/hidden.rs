//! Seams that no one sees: what happens in a closed pocket must not decide for the rest.

use fusion::blend::{Method, Params, blend};
use glam::DVec3;
use mesh_core::{Connected, TriMesh, Watch, shapes};
use spine::BlendCurve;
use tri_intersect::{Operation, boolean};

fn ball(radius: f64, at: DVec3) -> Connected<TriMesh> {
    let mut mesh = shapes::icosphere(radius, 4);
    mesh.positions.iter_mut().for_each(|p| *p += at);
    Connected::new(mesh).unwrap()
}

/// A ball with a void in it, sunk into a plate that fills the lower half of the void: the seam around the ball is outside, the
/// other in a pocket too small for the ball that rolls.
#[test]
fn a_pocket_under_a_solid_leaves_the_outer_seam_its_full_ball() {
    let how = tri_intersect::Params::default();
    let watch = Watch::default();
    let hollow = boolean(
        &ball(1.0, DVec3::new(0.01, 0.02, 0.3)),
        &ball(0.25, DVec3::new(0.0, 0.0, 0.003)),
        Operation::Difference,
        &how,
        &watch,
    );
    let hollow = Connected::new(hollow.unwrap().mesh).unwrap();
    let mut plate = shapes::cuboid(DVec3::new(6.0, 6.0, 2.0));
    plate.positions.iter_mut().for_each(|p| p.z -= 1.0);
    let joined = boolean(&Connected::new(plate).unwrap(), &hollow, Operation::Union, &how, &watch).unwrap();
    let mesh = Connected::new(joined.mesh).unwrap();
    let seams: Vec<BlendCurve> =
        joined.seams.iter().map(|s| BlendCurve::from_vertices(&mesh, &s.vertices).unwrap()).collect();
    assert_eq!(seams.len(), 2);
    let r = 0.3;
    let done = blend(&mesh, &seams, &Params::new(r), &watch).unwrap_or_else(|e| panic!("{e}"));
    assert!(tri_intersect::self_intersections(&done.mesh, &watch).unwrap().is_empty());
    let outer = (0..2).max_by(|&i, &j| seams[i].length(&mesh).total_cmp(&seams[j].length(&mesh))).unwrap();
    assert!(done.curves[outer].method != Method::Sharp, "{:?}", done.curves);
    // The ball between plate and sphere touches the plate √((1 + r)² − (0.3 − r)²) from the axis.
    let reach = (1.0f64 + r).hypot(0.0);
    let on_plate = |p: &DVec3| p.z.abs() < 1e-9 && p.truncate().length() < 2.0;
    let farthest = done.mesh.positions.iter().filter(|p| on_plate(p)).map(|p| p.truncate().length());
    let farthest = farthest.fold(0.0, f64::max);
    assert!((farthest - reach).abs() < 0.08 * r, "{farthest} beside {reach}");
    let all_round =
        done.mesh.positions.iter().filter(|p| on_plate(p) && p.truncate().length() > reach - 0.1 * r).count();
    assert!(all_round > 24, "{all_round}");
}
