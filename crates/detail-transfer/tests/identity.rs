//! Taking apart and putting together.

use detail_transfer::{BaseParams, Error, Reconstruction, Relief, roughness};
use glam::{DQuat, DVec3};
use mesh_core::{Connected, FaceMap, Faces, TriMesh, Watch, bounds, centroid, shapes};
use proptest::prelude::*;

fn rough_ball() -> Connected<TriMesh> {
    let mut ball = shapes::icosphere(1.0, 4);
    for p in &mut ball.positions {
        let wave = (17.0 * p.x).sin() + (23.0 * p.y + 1.0).sin() + (19.0 * p.z).cos();
        *p += 0.02 * wave * *p + 0.005 * DVec3::new((15.0 * p.y).sin(), (16.0 * p.z).cos(), 0.0);
    }
    Connected::new(ball).unwrap()
}

fn cap(mesh: &Connected<TriMesh>, height: f64) -> FaceMap<bool> {
    let middle = |f| centroid(mesh.mesh().triangle(f));
    mesh.face_ids().map(|f| middle(f).normalize().z > height).collect::<Vec<_>>().into()
}

fn encode(mesh: &Connected<TriMesh>, inside: &FaceMap<bool>, wavelength: f64) -> Relief {
    Relief::encode(mesh, inside, &BaseParams::new(wavelength), &Watch::default()).unwrap()
}

#[test]
fn what_is_taken_apart_goes_together_again() {
    let mesh = rough_ball();
    for (height, wavelength) in [(-2.0, 0.5), (0.2, 0.4), (0.2, 2.0)] {
        let relief = encode(&mesh, &cap(&mesh, height), wavelength);
        let places = Reconstruction::new(&relief, &relief.interior()).unwrap().solve(relief.details());
        let size = bounds(mesh.mesh()).diagonal();
        for (p, v) in places.iter().zip(relief.vertices()) {
            let error = p.distance(mesh.mesh().positions[v.index()]);
            assert!(error <= 1e-8 * size, "{error:e} at wavelength {wavelength}");
        }
    }
}

/// Without its detail the ball is nearly a ball again, and hardly a smaller one. (Around the poles of a wave its length is that of the ball.)
#[test]
fn the_base_of_a_rough_ball_is_a_ball() {
    let mesh = rough_ball();
    let relief = encode(&mesh, &cap(&mesh, -2.0), 1.0);
    let spread = |points: &[DVec3]| {
        let radii: Vec<f64> = points.iter().map(|p| p.length()).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        (mean, (radii.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / radii.len() as f64).sqrt())
    };
    let ((was, rough), (is, smooth)) = (spread(&mesh.mesh().positions), spread(&relief.base().mesh().positions));
    assert!((is / was - 1.0).abs() < 0.01 && smooth < 0.4 * rough, "{was} {rough} {is} {smooth}");
    assert!(relief.folded().is_none());
}

/// A sine wave's bend is its height over the squared wavelength, times (2π)².
#[test]
fn the_bend_of_a_wave_is_its_second_derivative() {
    let (height, wavelength) = (0.01, 0.5);
    let wave = |x: f64| height * (std::f64::consts::TAU * x / wavelength).sin();
    let mut plane = shapes::grid(4.0, 2.0, 128, 64);
    plane.positions.iter_mut().for_each(|p| p.z = wave(p.x));
    let mesh = Connected::new(plane).unwrap();
    let relief = encode(&mesh, &FaceMap::filled(mesh.face_count(), true), 3.0);
    let scale = (std::f64::consts::TAU / wavelength).powi(2);
    for (i, d) in relief.details().iter().enumerate() {
        let p = mesh.mesh().positions[i];
        if p.x.abs() < 1.2 && p.y.abs() < 0.5 {
            assert!((d.bend.z - scale * wave(p.x)).abs() < 0.05 * scale * height, "{} {}", d.bend.z, scale * wave(p.x));
            assert!((d.offset.z - wave(p.x)).abs() < 0.05 * height);
        }
    }
}

/// Details are numbers in local frames: a turned surface has the same ones.
#[test]
fn details_turn_with_the_surface() {
    let mesh = rough_ball();
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -2.0);
    let turned = Connected::new(shapes::posed(mesh.mesh().clone(), turn, DVec3::new(3.0, -1.0, 2.0))).unwrap();
    let inside = cap(&mesh, 0.2);
    let (a, b) = (encode(&mesh, &inside, 0.5), encode(&turned, &inside, 0.5));
    for (x, y) in a.details().iter().zip(b.details()) {
        assert!(x.bend.distance(y.bend) < 1e-8 && x.offset.distance(y.offset) < 1e-10, "{x:?} {y:?}");
    }
}

/// Twice the detail is twice as far from the base, inside; none leaves the base.
#[test]
fn intensity_scales_the_detail() {
    let mesh = rough_ball();
    let relief = encode(&mesh, &cap(&mesh, -2.0), 0.5);
    let prepared = Reconstruction::new(&relief, &relief.interior()).unwrap();
    for factor in [-1.0, 0.0, 2.0] {
        let details: Vec<_> = relief.details().iter().map(|d| d.scaled(factor)).collect();
        for ((p, b), v) in prepared.solve(&details).iter().zip(&relief.base().mesh().positions).zip(relief.vertices()) {
            let own = mesh.mesh().positions[v.index()] - *b;
            assert!((*p - *b).distance(factor * own) < 1e-9);
        }
    }
}

/// Waves that lean over are no displacement of the plane.
#[test]
fn overhangs_are_noticed() {
    let lean = |slope: f64| {
        let mut plane = shapes::grid(3.0, 2.0, 120, 80);
        for p in &mut plane.positions {
            p.z = 0.1 * (std::f64::consts::TAU * p.x / 0.5).sin() * (1.0 - p.x * p.x / 2.25) * (1.0 - p.y * p.y);
            p.x += slope * p.z;
        }
        let mesh = Connected::new(plane).unwrap();
        encode(&mesh, &FaceMap::filled(mesh.face_count(), true), 1.5).folded()
    };
    assert_eq!(lean(0.5), None);
    assert!(
        lean(1.5).is_some_and(|(share, _, handles)| (0.05..0.4).contains(&share) && handles == 0),
        "{:?}",
        lean(1.5)
    );
}

#[test]
fn roughness_is_that_of_the_wave() {
    let flat = Connected::new(shapes::grid(2.0, 2.0, 80, 80)).unwrap();
    let all = FaceMap::filled(flat.face_count(), true);
    assert!(roughness(&flat, &all, 0.1).variance < 1e-20);
    let mut wavy = flat.into_mesh();
    let (height, wavelength) = (0.005, 0.4);
    wavy.positions.iter_mut().for_each(|p| p.z = height * (std::f64::consts::TAU * p.x / wavelength).sin());
    let found = roughness(&Connected::new(wavy).unwrap(), &all, 0.1);
    // H = z''/2, so its variance is half of the squared amplitude over four.
    let truth = (height * (std::f64::consts::TAU / wavelength).powi(2)).powi(2) / 8.0;
    assert!((found.variance / truth - 1.0).abs() < 0.05, "{} {truth}", found.variance);
    let most = (0..4).max_by(|&a, &b| found.bands[a].total_cmp(&found.bands[b])).unwrap();
    assert!((1..=2).contains(&most), "{:?}", found.bands);
}

#[test]
fn what_cannot_be_encoded_is_refused() {
    let mesh = rough_ball();
    let watch = Watch::default();
    let none = FaceMap::filled(mesh.face_count(), false);
    let encode = |mesh: &Connected<TriMesh>, inside: &FaceMap<bool>, wavelength: f64| {
        Relief::encode(mesh, inside, &BaseParams::new(wavelength), &watch).unwrap_err()
    };
    assert!(matches!(encode(&mesh, &none, 0.5), Error::Empty { which: "source" }));
    assert!(matches!(encode(&mesh, &FaceMap::default(), 0.5), Error::Empty { .. }));
    let all = cap(&mesh, -2.0);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(encode(&mesh, &all, bad), Error::Length { .. }));
    }
    let mut broken = mesh.mesh().clone();
    broken.positions[7].y = f64::NAN;
    assert!(matches!(encode(&Connected::new(broken).unwrap(), &all, 0.5), Error::NotFinite { .. }));
    watch.cancel();
    assert!(matches!(encode(&mesh, &all, 0.5), Error::Cancelled(_)));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

    /// Any waves on any cap, at any size and place: what is taken apart goes together again.
    #[test]
    fn any_waves_come_back(
        cycles in prop::array::uniform3(3.0f64..20.0),
        height in 0.001f64..0.02,
        above in -0.8f64..0.8,
        wavelength in 0.3f64..2.0,
        size in -6i32..6,
        shift in prop::array::uniform3(-3.0f64..3.0),
    ) {
        let mut ball = shapes::icosphere(1.0, 3);
        for p in &mut ball.positions {
            *p *= 1.0 + height * (DVec3::from(cycles) * *p).to_array().map(f64::sin).iter().sum::<f64>();
        }
        let inside = cap(&Connected::new(ball.clone()).unwrap(), above);
        let size = 10f64.powi(size);
        ball.positions.iter_mut().for_each(|p| *p = size * (*p + DVec3::from(shift)));
        let mesh = Connected::new(ball).unwrap();
        let relief = encode(&mesh, &inside, size * wavelength);
        let places = Reconstruction::new(&relief, &relief.interior()).unwrap().solve(relief.details());
        for (p, v) in places.iter().zip(relief.vertices()) {
            let error = p.distance(mesh.mesh().positions[v.index()]);
            prop_assert!(error <= 1e-8 * bounds(mesh.mesh()).diagonal(), "{error:e}");
        }
    }
}
