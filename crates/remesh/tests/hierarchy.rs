//! Decimation and details, against motions whose effect is known.

use glam::{DQuat, DVec3};
use mesh_core::{Connected, Faces, Positions, TriMesh, VertexId, VertexMap, Watch, bounds, shapes, topology, volume};
use proptest::prelude::*;
use remesh::{Error, Hierarchy};

fn build(mesh: &TriMesh, levels: usize) -> Hierarchy {
    Hierarchy::build(&Connected::new(mesh).unwrap(), &VertexMap::default(), levels, &Watch::default()).unwrap()
}

#[test]
fn a_ball_keeps_its_shape_and_comes_back_bit_for_bit() {
    let ball = shapes::icosphere(1.0, 5);
    let levels = build(&ball, 6);
    let coarse = levels.coarsest();
    let mesh = Connected::new(coarse).unwrap();
    assert_eq!((topology(&mesh).genus(), levels.levels()), (0, 6));
    assert!(coarse.faces.len() * 5 < ball.faces.len(), "{}", coarse.faces.len());
    // As even as a ball of as many triangles is: its volume falls short by about 12/F.
    let short = 1.0 - volume(coarse) / volume(&ball);
    assert!(short < 20.0 / coarse.faces.len() as f64, "{short} {}", coarse.faces.len());
    assert!(levels.survivors().iter().zip(&coarse.positions).all(|(v, p)| ball.position(*v) == *p));
    assert_eq!(levels.restore(&coarse.positions).unwrap(), ball);
}

/// Bending a rough tube through its coarsest surface bends its roughness along.
#[test]
fn details_follow_a_bend() {
    let rough = |p: DVec3| 1.0 + 0.01 * (23.0 * p.z).sin() * (8.0 * p.y.atan2(p.x)).cos();
    let mut tube = shapes::open_cylinder(0.5, 4.0, 96, 128);
    tube.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x * rough(*p), p.y * rough(*p), p.z));
    // Along a circle of radius 4: a quarter turn at most.
    let bend = |p: DVec3| {
        let angle = p.z / 4.0;
        DVec3::new((4.0 + p.x) * angle.cos() - 4.0, p.y, (4.0 + p.x) * angle.sin())
    };
    let levels = build(&tube, 5);
    assert!(levels.coarsest().faces.len() * 3 < tube.faces.len());
    let moved: Vec<DVec3> = levels.coarsest().positions.iter().map(|&p| bend(p)).collect();
    let back = levels.restore(&moved).unwrap();
    let errors = tube.positions.iter().zip(&back.positions).map(|(&p, q)| bend(p).distance(*q));
    let mean = errors.clone().sum::<f64>() / tube.positions.len() as f64;
    let worst = errors.fold(0.0, f64::max);
    assert!(mean < 2e-3 && worst < 2e-2, "{mean} {worst}");
}

#[test]
fn what_is_protected_or_on_the_boundary_stays() {
    let tube = shapes::open_cylinder(1.0, 3.0, 40, 30);
    let protected: Vec<bool> = tube.positions.iter().map(|p| p.z.abs() < 0.3).collect();
    let mesh = Connected::new(&tube).unwrap();
    let levels = Hierarchy::build(&mesh, &protected.clone().into(), 8, &Watch::default()).unwrap();
    let survived = |v: usize| levels.survivors().binary_search(&VertexId::from(v)).is_ok();
    assert!((0..protected.len()).filter(|&v| protected[v]).all(survived));
    assert!((0..protected.len()).filter(|&v| tube.positions[v].z.abs() > 1.4999).all(survived));
    assert!(levels.survivors().len() * 2 < protected.len());
}

/// Moving one coarse vertex changes what is around it and no more.
#[test]
fn changes_stay_local() {
    let blob = shapes::blob(1.0, 5, 0.2, 3);
    let levels = build(&blob, 4);
    let mut moved = levels.coarsest().positions.clone();
    moved[5] *= 1.1;
    let at = levels.coarsest().positions[5];
    let back = levels.restore(&moved).unwrap();
    let changed: Vec<f64> =
        blob.positions.iter().zip(&back.positions).filter(|(p, q)| p != q).map(|(p, _)| p.distance(at)).collect();
    assert!(changed.len() > 5 && changed.len() * 20 < blob.positions.len(), "{}", changed.len());
    assert!(changed.iter().all(|&d| d < 0.6));
}

#[test]
fn impossible_jobs_are_refused() {
    let ball = shapes::icosphere(1.0, 2);
    let mesh = Connected::new(&ball).unwrap();
    let short = VertexMap::filled(3, true);
    assert!(matches!(Hierarchy::build(&mesh, &short, 2, &Watch::default()), Err(Error::Count { found: 3, .. })));
    let levels = build(&ball, 2);
    assert!(matches!(levels.restore(&[]), Err(Error::Count { found: 0, .. })));
    let wild = vec![DVec3::NAN; levels.survivors().len()];
    assert!(matches!(levels.restore(&wild), Err(Error::NotFinite { .. })));
    let mut broken = ball.clone();
    broken.positions[3].x = f64::INFINITY;
    let broken = Connected::new(&broken).unwrap();
    let error = Hierarchy::build(&broken, &VertexMap::default(), 2, &Watch::default());
    assert!(matches!(error, Err(Error::NotFinite { vertex: VertexId(3), .. })));
    let watch = Watch::default();
    watch.cancel();
    assert!(matches!(Hierarchy::build(&mesh, &VertexMap::default(), 2, &watch), Err(Error::Cancelled(_))));
    // A tetrahedron cannot lose a vertex; an empty mesh has none.
    assert_eq!(build(&TriMesh::default(), 3).levels(), 0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// Any blob, torn or whole: the coarsest surface is a manifold of the same topology, unmoved it gives the input's bits, and
    /// a rigid motion of it moves the input.
    #[test]
    fn motions_are_followed(
        seed in 0u64..1000, bumps in 0.0f64..0.8, count in 1usize..12, holes in prop::collection::vec(0usize..1280, 0..6),
    ) {
        let mut blob = shapes::blob(1.0, 3, bumps, seed);
        let mut f = 0;
        blob.faces.retain(|_| { f += 1; !holes.contains(&(f - 1)) });
        let Ok(mesh) = Connected::new(&blob) else { return Ok(()) };
        let levels = build(&blob, count);
        let coarse = Connected::new(levels.coarsest()).unwrap();
        prop_assert_eq!(topology(&coarse).euler_characteristic() , topology(&mesh).euler_characteristic());
        prop_assert_eq!(topology(&coarse).boundary_loops, topology(&mesh).boundary_loops);
        prop_assert!(coarse.face_count() < mesh.face_count());
        prop_assert_eq!(&levels.restore(&levels.coarsest().positions).unwrap(), &blob);
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, seed as f64, 2.0);
        let motion = |p: &DVec3| turn * *p + DVec3::new(1.0, -2.0, 3.0);
        let moved: Vec<DVec3> = levels.coarsest().positions.iter().map(motion).collect();
        let back = levels.restore(&moved).unwrap();
        let size = bounds(&blob).diagonal();
        for (p, q) in blob.positions.iter().zip(&back.positions) {
            prop_assert!(motion(p).distance(*q) < 1e-9 * size);
        }
    }
}
