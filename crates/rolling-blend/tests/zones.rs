//! Networks on which a plain sweep fails at some places: zones there, strips everywhere else.

use glam::DVec3;
use mesh_core::{Connected, Faces, Positions, TriMesh, Watch, boundary_loops, dihedral_angle, shapes};
use rolling_blend::features::{self, feature_curves};
use rolling_blend::{BlendCurve, Blended, Method, Params, blend, measure};
use tri_intersect::{Operation, boolean};

fn joined(a: TriMesh, b: TriMesh, operation: Operation) -> Connected<TriMesh> {
    let [a, b] = [a, b].map(|m| Connected::new(m).unwrap());
    let made = boolean(&a, &b, operation, &tri_intersect::Params::default(), &Watch::default()).unwrap();
    Connected::new(made.mesh).unwrap()
}

fn cuboid(low: [f64; 3], high: [f64; 3]) -> TriMesh {
    let (low, high) = (DVec3::from(low), DVec3::from(high));
    shapes::posed(shapes::cuboid(high - low), glam::DQuat::IDENTITY, low.midpoint(high))
}

/// All edges blended, checked: closed, free of crossings, and on balls of the radius where that is claimed.
fn blended(mesh: &Connected<TriMesh>, radius: f64) -> (Vec<BlendCurve>, Blended) {
    let curves: Vec<BlendCurve> =
        feature_curves(mesh, &features::Params::default()).into_iter().map(BlendCurve::from).collect();
    let done = blend(mesh, &curves, &Params::new(radius), &Watch::default()).unwrap();
    let connected = Connected::new(&done.mesh).unwrap();
    assert!(boundary_loops(&connected).is_empty());
    assert!(tri_intersect::self_intersections(&done.mesh, &Watch::default()).unwrap().is_empty());
    (curves, done)
}

fn ball_error(mesh: &Connected<TriMesh>, curves: &[BlendCurve], done: &Blended, radius: f64) -> [f64; 3] {
    let asked: Vec<_> = curves.iter().map(|c| measure::Curve { halfedges: &c.halfedges, radius }).collect();
    measure::measure(mesh, &asked, done).1.expect("the blend has vertices of its own")
}

/// A post whose foot is so near to an edge that the two blends overlap: an envelope there, strips on all other edges, and no
/// sharp edge anywhere.
#[test]
fn a_post_near_an_edge_gets_a_zone() {
    for gap in [0.5, 0.6, 0.7] {
        let mesh = joined(
            cuboid([0.0, 0.0, 0.0], [10.0, 8.0, 3.0]),
            cuboid([gap, 3.0, 1.0], [3.0, 5.0, 6.0]),
            Operation::Union,
        );
        let (curves, done) = blended(&mesh, 0.4);
        assert!(done.curves.iter().all(|c| c.full_share > 0.99 && c.left_sharp.is_none()), "{gap}: {:?}", done.curves);
        assert!(done.curves.iter().any(|c| c.method == Method::Strip));
        assert!(done.fields > 0, "{gap}: nothing but strips");
        let [half, _, most] = ball_error(&mesh, &curves, &done, 0.4);
        assert!(half < 0.02 && most < 0.1, "{gap}: {half} {most}");
        let connected = Connected::new(&done.mesh).unwrap();
        let sharp = connected.halfedge_ids().filter(|&h| {
            let [a, b] = connected.ends(h);
            a.distance(b) > 0.02 && dihedral_angle(&connected, h).is_some_and(|t| t.abs() > 95f64.to_radians())
        });
        let sharp: Vec<DVec3> = sharp.map(|h| connected.position(connected.tail(h))).collect();
        assert!(sharp.is_empty(), "{gap}: {} sharp edges, the first at {}", sharp.len(), sharp[0]);
    }
}

/// A wall thinner than the ball: its edges stay sharp, which is told with the place, and all others are round.
#[test]
fn a_thin_wall_stays_sharp_and_nothing_else() {
    let mesh = joined(
        cuboid([0.0, 0.0, 0.0], [12.0, 10.0, 4.0]),
        cuboid([0.6, 2.0, 1.0], [10.0, 8.0, 5.0]),
        Operation::Difference,
    );
    let (curves, done) = blended(&mesh, 0.4);
    assert!(done.full_share > 0.7 && done.full_share < 1.0, "{}", done.full_share);
    for (curve, told) in curves.iter().zip(&done.curves) {
        let at_wall = curve.points(&mesh).iter().all(|p| p.x < 0.7);
        assert!(told.left_sharp.is_none() || at_wall || told.full_share > 0.5, "{told:?}");
        if let Some((at, _)) = told.left_sharp {
            assert!(at.x < 2.0, "{at}");
        }
    }
    assert!(done.curves.iter().any(|c| c.left_sharp.is_some() || c.radius < 0.4));
}
