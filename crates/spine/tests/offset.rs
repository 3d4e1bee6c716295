//! The offset solver against analytic spines and against the contact solver.

use glam::{DQuat, DVec3};
use mesh_core::{Connected, Positions, TriMesh, VertexId, Watch, shapes};
use spine::{BlendCurve, Convexity, Error, OffsetKeep, OffsetParams, Params, Rail, Solver, roll};
use tri_intersect::{Operation, boolean};

const KEEPS: [OffsetKeep; 2] = [OffsetKeep::Vertices, OffsetKeep::Faces];
const BALL: f64 = 0.25;

struct Joint {
    mesh: Connected<TriMesh>,
    curve: BlendCurve,
}

impl Joint {
    /// Two solids and their longest seam.
    fn of(a: TriMesh, b: TriMesh, operation: Operation) -> Self {
        let (a, b) = (Connected::new(a).unwrap(), Connected::new(b).unwrap());
        let joined = boolean(&a, &b, operation, &tri_intersect::Params::default(), &Watch::default()).unwrap();
        let mesh = Connected::new(joined.mesh).unwrap();
        let curves = joined.seams.iter().map(|s| BlendCurve::from_vertices(&mesh, &s.vertices).unwrap());
        let curve = curves.max_by(|a, b| a.length(&mesh).total_cmp(&b.length(&mesh))).unwrap();
        Self { mesh, curve }
    }

    /// The contact solver's spine, its steps short enough for its chords to be as good as the mesh.
    fn exact(&self, n: u32) -> Rail {
        let params = Params { step: 0.4 / f64::from(n), ..Params::new(BALL) };
        roll(&self.mesh, &self.curve, std::slice::from_ref(&self.curve), &params).unwrap()
    }

    fn roll(&self, solver: Solver, radius: f64) -> Result<Rail, Error> {
        let params = Params { solver, ..Params::new(radius) };
        roll(&self.mesh, &self.curve, std::slice::from_ref(&self.curve), &params)
    }

    fn offset(&self, keep: OffsetKeep) -> Rail {
        self.roll(Solver::Offset(OffsetParams { keep, ..OffsetParams::default() }), BALL).unwrap()
    }
}

/// Top face in the plane z = 0.
fn plate() -> TriMesh {
    shapes::posed(shapes::cuboid_grid(DVec3::new(6.0, 6.0, 2.0), [6, 6, 2]), DQuat::IDENTITY, -DVec3::Z)
}

/// A unit sphere, its centre 0.3 above the plate, turned so that nothing is symmetric.
fn ball(n: u32) -> TriMesh {
    shapes::posed(shapes::geodesic_sphere(1.0, n), DQuat::from_rotation_x(0.4), 0.3 * DVec3::Z)
}

/// A unit cylinder upright through the plate's top.
fn post(n: u32) -> TriMesh {
    shapes::posed(shapes::cylinder(1.0, 3.0, n, n / 4), DQuat::from_rotation_z(0.1), 0.8 * DVec3::Z)
}

/// Largest distance of the centres from a circle around the z axis.
fn off_circle(rail: &Rail, radius: f64, height: f64) -> f64 {
    let miss = |c: DVec3| (c.truncate().length() - radius).hypot(c.z - height);
    rail.samples.iter().map(|s| miss(s.center)).fold(0.0, f64::max)
}

/// Largest distance of the centres from the polygon of another rail's.
fn apart(rail: &Rail, other: &Rail) -> f64 {
    let n = other.samples.len();
    let to_segment = |p: DVec3, i: usize| {
        let (a, b) = (other.samples[i].center, other.samples[(i + 1) % n].center);
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, t))
    };
    let to_rail = |p: DVec3| (0..n).map(|i| to_segment(p, i)).fold(f64::INFINITY, f64::min);
    rail.samples.iter().map(|s| to_rail(s.center)).fold(0.0, f64::max)
}

/// Three resolutions: the spine must approach the circle as h², agree with the contact solver as h², run as the blend
/// curve does, and own up to its residual.
fn converges(name: &str, convexity: Convexity, radius: f64, height: f64, joint: impl Fn(u32) -> Joint) {
    for keep in KEEPS {
        let levels = [16, 32, 64].map(|n| {
            let joint = joint(n);
            let rail = joint.offset(keep);
            let exact = joint.exact(n);
            assert_eq!(rail.convexity, convexity);
            assert!(rail.samples.len() >= 40);
            assert!(winding(&rail) * curve_winding(&joint) > 0.0, "{name} {keep:?} {n} runs backwards");
            (off_circle(&rail, radius, height), apart(&rail, &exact), rail.residual, feet_off_plate(&rail, convexity))
        });
        assert!(levels[0].0 / levels[2].0 > 12.0, "{name} {keep:?} circle {levels:?}");
        assert!(levels[0].1 / levels[2].1 > 9.0, "{name} {keep:?} contact {levels:?}");
        let h = 1.0 / 16.0;
        for (k, level) in levels.iter().enumerate() {
            let h = h / f64::from(1u32 << k);
            assert!(level.0 < 6.0 * h * h && level.2 < 6.0 * h * h && level.3 < 1e-9, "{name} {keep:?} {level:?}");
        }
    }
}

/// Feet on the plate lie straight below (or above) the centre: the images of a plane are exact.
fn feet_off_plate(rail: &Rail, convexity: Convexity) -> f64 {
    let sign = if convexity == Convexity::Concave { 1.0 } else { -1.0 };
    let on_plate = |s: &spine::Sample| {
        let miss = |k: usize| s.feet[k].point.z.abs() + ((s.center.z - s.feet[k].point.z) - sign * BALL).abs();
        miss(0).min(miss(1))
    };
    rail.samples.iter().map(on_plate).fold(0.0, f64::max)
}

fn winding(rail: &Rail) -> f64 {
    turns(&rail.samples.iter().map(|s| s.center).collect::<Vec<_>>())
}

fn curve_winding(joint: &Joint) -> f64 {
    turns(&joint.curve.points(&joint.mesh))
}

/// Twice the area enclosed in the plane of x and y, its sign the sense.
fn turns(points: &[DVec3]) -> f64 {
    (0..points.len()).map(|i| points[i].truncate().perp_dot(points[(i + 1) % points.len()].truncate())).sum()
}

#[test]
fn sphere_on_plate() {
    let radius = ((1.0 + BALL).powi(2) - (0.3 - BALL).powi(2)).sqrt();
    converges("sphere on plate", Convexity::Concave, radius, BALL, |n| Joint::of(plate(), ball(n), Operation::Union));
}

#[test]
fn cylinder_on_plate() {
    converges("cylinder on plate", Convexity::Concave, 1.0 + BALL, BALL, |n| {
        Joint::of(plate(), post(2 * n), Operation::Union)
    });
}

/// The rim of a dent: the ball rolls in the solid, outside the sphere.
#[test]
fn sphere_from_plate() {
    let radius = ((1.0 + BALL).powi(2) - (0.3 + BALL).powi(2)).sqrt();
    converges("sphere from plate", Convexity::Convex, radius, -BALL, |n| {
        Joint::of(plate(), ball(n), Operation::Difference)
    });
}

#[test]
fn cylinder_from_plate() {
    converges("cylinder from plate", Convexity::Convex, 1.0 + BALL, -BALL, |n| {
        Joint::of(plate(), post(2 * n), Operation::Difference)
    });
}

/// The rim of a sphere cut flat, with the ball inside the sphere.
#[test]
fn plate_from_sphere() {
    let radius = ((1.0 - BALL).powi(2) - (0.3 - BALL).powi(2)).sqrt();
    for keep in KEEPS {
        let errors = [16, 32, 64].map(|n| {
            let joint = Joint::of(ball(n), plate(), Operation::Difference);
            off_circle(&joint.offset(keep), radius, BALL)
        });
        assert!(errors[0] / errors[2] > 12.0, "{keep:?} {errors:?}");
    }
}

/// Two equal icospheres: the spine lies in the plane between them, feet at equal distance.
#[test]
fn two_icospheres() {
    let turn = |angle| DQuat::from_axis_angle(DVec3::new(0.3, 0.5, 0.8).normalize(), angle);
    let radius = ((1.0 + BALL).powi(2) - 0.36f64).sqrt();
    for keep in KEEPS {
        let errors = [3, 4, 5].map(|level| {
            let sphere = |z: f64, angle| shapes::posed(shapes::icosphere(1.0, level), turn(angle), z * DVec3::Z);
            let joint = Joint::of(sphere(-0.6, 0.2), sphere(0.6, 1.1), Operation::Union);
            let rail = joint.offset(keep);
            let exact = joint.exact(4 << level);
            (off_circle(&rail, radius, 0.0), apart(&rail, &exact), rail.residual)
        });
        assert!(errors[0].0 / errors[2].0 > 12.0 && errors[0].1 / errors[2].1 > 9.0, "{keep:?} {errors:?}");
    }
}

fn rim(mesh: &Connected<TriMesh>, radius: f64, z: f64) -> BlendCurve {
    let on_rim = |p: DVec3| (p.z - z).abs() < 1e-9 && p.truncate().length() > 0.99 * radius;
    let mut cycle: Vec<VertexId> =
        (0..mesh.mesh().positions.len()).map(VertexId::from).filter(|&v| on_rim(mesh.position(v))).collect();
    let angle = |v: VertexId| mesh.position(v).y.atan2(mesh.position(v).x);
    cycle.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
    BlendCurve::from_vertices(mesh, &cycle).unwrap()
}

/// A ball that is larger than the post it is to round, and one that is higher than a disc.
#[test]
fn too_large_a_radius_is_told_with_its_place() {
    let solver = Solver::Offset(OffsetParams::default());
    let of = |height: f64| {
        let mesh = Connected::new(shapes::cylinder(1.0, height, 48, 6)).unwrap();
        let curve = rim(&mesh, 1.0, mesh_core::bounds(&mesh).max.z);
        Joint { mesh, curve }
    };
    let wide = of(8.0);
    assert!(wide.roll(solver, 0.9).is_ok());
    match wide.roll(solver, 1.2) {
        Err(e @ Error::Folded { at, radius }) => {
            assert!(at.is_finite() && radius == 1.2 && e.place() == Some(at) && e.to_string().contains("smaller"));
        }
        other => panic!("{other:?}"),
    }
    match of(0.2).roll(solver, 0.5) {
        Err(e @ Error::NoLoop { at, radius }) => {
            assert!(at.is_finite() && radius == 0.5 && e.place() == Some(at) && e.to_string().contains("smaller"));
        }
        other => panic!("{other:?}"),
    }
}

/// A dip makes the ball smaller where it is: the offset follows it, as far as the vertices resolve it.
#[test]
fn a_dip_moves_the_spine() {
    let fine = shapes::cuboid_grid(DVec3::new(6.0, 6.0, 2.0), [120, 120, 2]);
    let joint = Joint::of(shapes::posed(fine, DQuat::IDENTITY, -DVec3::Z), ball(32), Operation::Union);
    let at = DVec3::new(1.0 + BALL, 0.0, BALL);
    let mut params = Params { solver: Solver::Offset(OffsetParams::default()), ..Params::new(BALL) };
    params.radius.dips.push(spine::Dip { at, factor: 0.7, extent: 0.8 });
    let rail = roll(&joint.mesh, &joint.curve, std::slice::from_ref(&joint.curve), &params).unwrap();
    let lowest = rail.samples.iter().map(|s| s.radius).fold(f64::INFINITY, f64::min);
    assert!(lowest < 0.8 * BALL && lowest > 0.69 * BALL, "{lowest}");
    assert!(rail.residual < 0.01 * BALL, "{}", rail.residual);
    assert!(rail.samples.iter().all(|s| (s.center.z - s.radius).abs() < 0.01 * BALL));
}

/// Radii far beyond and far below the model end in an answer or an error that names a place, whatever the solver's
/// other numbers are.
#[test]
fn wild_numbers_are_survived() {
    let joint = Joint::of(plate(), ball(6), Operation::Union);
    for radius in [1e300, 1e30, 1e-30, 1e-300] {
        let solver = Solver::Offset(OffsetParams::default());
        if let Err(e) = joint.roll(solver, radius) {
            assert!(e.place().is_some_and(DVec3::is_finite), "{radius} {e}");
        }
    }
    for (step, bend, samples) in [(f64::NAN, f64::NAN, 0), (f64::INFINITY, 0.0, 7), (0.05, -1.0, 1)] {
        let solver = Solver::Offset(OffsetParams { bend, samples, ..OffsetParams::default() });
        let params = Params { solver, step, ..Params::new(BALL) };
        let rail = roll(&joint.mesh, &joint.curve, std::slice::from_ref(&joint.curve), &params).unwrap();
        assert!(rail.samples.len() >= 4 && rail.residual < 0.1 * BALL);
    }
}
