//! Smoothing and fairing against flows and surfaces that are known in closed form.

use glam::DVec3;
use mesh_core::{Connected, Faces, TriMesh, VertexId, VertexMap, Watch, shapes, volume};
use proptest::prelude::*;
use remesh::{Error, Fairing, Fairness, Flow, Frozen, Taubin, curvature_flow, fair, taubin};
use std::f64::consts::{PI, TAU};

fn connect(mesh: TriMesh) -> Connected<TriMesh> {
    Connected::new(mesh).unwrap()
}

fn hold(mesh: &Connected<TriMesh>, held: impl Fn(DVec3) -> bool) -> Frozen {
    let held: Vec<bool> = mesh.mesh().positions.iter().map(|&p| held(p)).collect();
    Frozen { vertices: held.into(), ..Frozen::default() }
}

/// One implicit step of a ball: R' (1 + 2t/R²) = R exactly, up to the mesh; many steps: R² − 4t.
#[test]
fn balls_shrink_at_the_rate_of_the_flow() {
    for radius in [1.0, 1e-9, 3e7] {
        let error = [3, 4].map(|levels| {
            let ball = connect(shapes::icosphere(radius, levels));
            let flow = Flow { time: 0.3 * radius * radius, steps: 1 };
            let points = curvature_flow(&ball, &Frozen::default(), &flow, &Watch::default()).unwrap();
            points.iter().map(|p| (p.length() / radius - 1.0 / 1.6).abs()).fold(0.0, f64::max)
        });
        assert!(error[1] < 2e-3 && error[0] / error[1] > 3.0, "{error:?}");
    }
    let ball = connect(shapes::icosphere(1.0, 4));
    let flow = Flow { time: 0.15, steps: 200 };
    let points = curvature_flow(&ball, &Frozen::default(), &flow, &Watch::default()).unwrap();
    let worst = points.iter().map(|p| (p.length() - 0.4f64.sqrt()).abs()).fold(0.0, f64::max);
    assert!(worst < 3e-3, "{worst}");
}

/// A wave on a plane keeps 1 / (1 + t k²) of its height.
#[test]
fn waves_decay_by_their_length() {
    let (n, wavelength) = (120, 0.5);
    let mut plane = shapes::grid(2.0, 2.0, n, n);
    let height = |p: &DVec3| 1e-4 * (TAU * p.x / wavelength).sin() * (TAU * p.y / wavelength).sin();
    plane.positions.iter_mut().for_each(|p| p.z = height(p));
    let plane = connect(plane);
    // Two equal waves crossed have k² twice as large as one.
    let flow = Flow::halving(wavelength);
    let points = curvature_flow(&plane, &Frozen::default(), &flow, &Watch::default()).unwrap();
    for (p, q) in plane.mesh().positions.iter().zip(&points).filter(|(p, _)| p.truncate().abs().max_element() < 0.5) {
        assert!((q.z - p.z / 3.0).abs() < 5e-3 * 1e-4, "{p} {q}");
    }
}

/// The heights of waves after Taubin's steps, from the eigenvalues of the mean of six neighbours on a regular grid.
#[test]
fn taubin_keeps_long_waves_and_kills_short_ones() {
    let (n, rounds) = (96u32, 12i32);
    let params = Taubin { rounds: 12, ..Taubin::default() };
    let mu = 1.0 / (params.pass - 1.0 / params.lambda);
    for cycles in [2.0, 6.0, 16.0, 40.0] {
        let mut plane = shapes::grid(1.0, 1.0, n, n);
        // One direction for all diagonals, so that every inner vertex has six neighbours.
        plane.faces = (0..n * n)
            .flat_map(|c| {
                let a = c / n * (n + 1) + c % n;
                [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]].map(|f| f.map(VertexId))
            })
            .collect();
        let cell = 1.0 / f64::from(n);
        let wave = |p: &DVec3| 1e-3 * (TAU * cycles * p.x).cos();
        plane.positions.iter_mut().for_each(|p| p.z = wave(p));
        let plane = connect(plane);
        let points = taubin(&plane, &Frozen::default(), &params, &Watch::default()).unwrap();
        // Four of six neighbours are a column away, two in the same column.
        let k = 4.0 / 6.0 * (1.0 - (TAU * cycles * cell).cos());
        let kept = ((1.0 - params.lambda * k) * (1.0 - mu * k)).powi(rounds);
        let middle = |p: &DVec3| p.truncate().abs().max_element() < 0.5 - f64::from(2 * rounds + 2) * cell;
        let inside: Vec<_> = plane.mesh().positions.iter().zip(&points).filter(|(p, _)| middle(p)).collect();
        assert!(inside.len() > 1000);
        for (p, q) in inside {
            assert!((q.z - kept * p.z).abs() < 1e-12, "{cycles}: {} {} {kept}", p.z, q.z);
        }
    }
}

#[test]
fn taubin_keeps_the_volume_of_a_noisy_ball_and_the_flow_does_not() {
    let mut ball = shapes::icosphere(1.0, 5);
    let mut rng = fastrand::Rng::with_seed(1);
    let mut random = || rng.f64() - 0.5;
    ball.positions.iter_mut().for_each(|p| *p *= 1.0 + 0.02 * random());
    let before = volume(&ball);
    let roughness = |points: &[DVec3]| points.iter().map(|p| (p.length() - 1.0).powi(2)).sum::<f64>().sqrt();
    let rough = roughness(&ball.positions);
    let ball = connect(ball);
    let params = Taubin { rounds: 40, ..Taubin::default() };
    let smooth = taubin(&ball, &Frozen::default(), &params, &Watch::default()).unwrap();
    assert!(roughness(&smooth) < 0.4 * rough, "{} {rough}", roughness(&smooth));
    let after = volume(&TriMesh { positions: smooth, faces: ball.mesh().faces.clone() });
    assert!((after / before - 1.0).abs() < 5e-3, "{}", after / before);
    let flow = Flow { time: 0.01, steps: 1 };
    let shrunk = curvature_flow(&ball, &Frozen::default(), &flow, &Watch::default()).unwrap();
    let after = volume(&TriMesh { positions: shrunk, faces: ball.mesh().faces.clone() });
    assert!(after / before < 0.96, "{}", after / before);
}

/// On the metric of the unit sphere, what continues z = μ (the cosine from the pole) beyond μ₀ smoothly solves an ordinary
/// equation: Δz = 0 keeps μ₀, Δ²z = 0 gives μ₀ + (1 + μ₀) ln((1 + μ)/(1 + μ₀)), Δ³z = 0 is integrated here.
fn polar(fairness: Fairness, low: f64, mu: f64) -> f64 {
    match fairness {
        Fairness::Harmonic => low,
        Fairness::Biharmonic => low + (1.0 + low) * ((1.0 + mu) / (1.0 + low)).ln(),
        Fairness::Triharmonic => {
            // (1 − μ²) z' = a (μ − 1) − e ((1 + μ) ln(1 + μ) − μ − 2 ln 2 + 1), regular at the pole.
            let g = |m: f64| (1.0 + m) * (1.0 + m).ln() - m - 2.0 * 2f64.ln() + 1.0;
            // z' = a p + e q with z'(μ₀) = 1, z''(μ₀) = 0.
            let p = |m: f64| -1.0 / (1.0 + m);
            let q = |m: f64| -g(m) / (1.0 - m * m);
            let d = |f: &dyn Fn(f64) -> f64| (f(low + 1e-6) - f(low - 1e-6)) / 2e-6;
            let (p0, q0, p1, q1) = (p(low), q(low), d(&p), d(&q));
            let (a, e) = (q1 / (p0 * q1 - q0 * p1), -p1 / (p0 * q1 - q0 * p1));
            let n = 4000;
            let step = (mu - low) / f64::from(n);
            low + (0..n).map(|i| low + (f64::from(i) + 0.5) * step).map(|m| step * (a * p(m) + e * q(m))).sum::<f64>()
        }
    }
}

#[test]
fn a_hole_in_a_ball_is_filled_as_the_theory_says() {
    for (fairness, bound) in [(Fairness::Harmonic, 0.02), (Fairness::Biharmonic, 8e-3), (Fairness::Triharmonic, 8e-3)] {
        let error = [4, 5].map(|levels| {
            let ball = connect(shapes::icosphere(1.0, levels));
            let low = 0.6;
            let frozen = hold(&ball, |p| p.z <= low);
            let fairing = Fairing { fairness, rounds: 1 };
            let points = fair(&ball, &frozen, &fairing, &Watch::default()).unwrap();
            let inside = ball.mesh().positions.iter().zip(&points).filter(|(p, _)| p.z > low);
            inside.map(|(p, q)| (q.z - polar(fairness, low, p.z)).abs()).fold(0.0, f64::max)
        });
        assert!(error[1] < bound && error[1] < 0.75 * error[0], "{fairness:?}: {error:?}");
    }
    // The higher the order, the nearer to the ball itself.
    let height = [Fairness::Harmonic, Fairness::Biharmonic, Fairness::Triharmonic].map(|f| polar(f, 0.6, 1.0));
    assert!(height[0] < height[1] && height[1] < height[2] && height[2] < 1.0 && height[2] > 0.98, "{height:?}");
}

/// A catenoid is minimal: Δx = 0, so harmonic fairing finds it again from a tube, over a few rounds.
#[test]
fn a_soap_film_between_two_rings_is_a_catenoid() {
    let error = [24, 48].map(|n| {
        let neck = |z: f64| z.cosh();
        let mut tube = shapes::open_cylinder(1.0, 1.0, 4 * n, n);
        // A cylinder of the radius of its ends; the film hangs through.
        tube.positions.iter_mut().for_each(|p| *p = DVec3::new(neck(0.5) * p.x, neck(0.5) * p.y, p.z));
        let tube = connect(tube);
        let fairing = Fairing { fairness: Fairness::Harmonic, rounds: 30 };
        let points = fair(&tube, &Frozen::default(), &fairing, &Watch::default()).unwrap();
        points.iter().map(|p| (p.truncate().length() - neck(p.z)).abs()).fold(0.0, f64::max)
    });
    assert!(error[1] < 2e-4 && error[0] / error[1] > 3.0, "{error:?}");
}

/// Within a plane all orders give the plane, however the region was bent, and whatever lies outside keeps its bits.
#[test]
fn a_hole_in_a_plane_is_filled_by_the_plane() {
    let tilt = glam::DQuat::from_rotation_arc(DVec3::Z, DVec3::new(1.0, 2.0, 3.0).normalize());
    let mut plane = shapes::grid(2.0, 2.0, 40, 40);
    let bump = |p: &DVec3| 0.4 * (0.25 - p.length_squared()).max(0.0);
    plane.positions.iter_mut().for_each(|p| *p = tilt * DVec3::new(p.x, p.y, bump(p)) + 100.0);
    let plane = connect(plane);
    let flat = |p: DVec3| (tilt.inverse() * (p - 100.0)).z;
    for fairness in [Fairness::Harmonic, Fairness::Biharmonic, Fairness::Triharmonic] {
        let frozen = hold(&plane, |p| (tilt.inverse() * (p - 100.0)).truncate().length() > 0.55);
        let points = fair(&plane, &frozen, &Fairing { fairness, rounds: 1 }, &Watch::default()).unwrap();
        assert!(points.iter().all(|&p| flat(p).abs() < 1e-9), "{fairness:?}");
        for (v, (p, q)) in plane.mesh().positions.iter().zip(&points).enumerate() {
            assert!(!frozen.vertices[VertexId::from(v)] || p == q);
        }
    }
}

#[test]
fn boundaries_features_and_frozen_faces_keep_their_bits() {
    let tube = connect(shapes::open_cylinder(1.0, 3.0, 40, 12));
    let low = |f| tube.mesh().triangle(f).iter().all(|p| p.z < 0.0);
    let faces: Vec<bool> = tube.face_ids().map(low).collect();
    let frozen = Frozen { faces: faces.into(), ..Frozen::default() };
    let still: Vec<usize> = (0..tube.vertex_count()).filter(|&v| tube.mesh().positions[v].z < 0.2).collect();
    let runs = [
        taubin(&tube, &frozen, &Taubin::default(), &Watch::default()).unwrap(),
        curvature_flow(&tube, &frozen, &Flow { time: 0.1, steps: 2 }, &Watch::default()).unwrap(),
        fair(&tube, &frozen, &Fairing::default(), &Watch::default()).unwrap(),
    ];
    for points in runs {
        let same = |v: usize| points[v] == tube.mesh().positions[v];
        assert!(still.iter().filter(|&&v| tube.mesh().positions[v].z < 0.0).all(|&v| same(v)));
        assert!((0..40).all(same) && (0..points.len()).any(|v| !same(v)));
    }
    let cube = connect(shapes::cuboid(DVec3::ONE));
    let frozen = Frozen::default().with_features(&cube, 40.0);
    assert_eq!(curvature_flow(&cube, &frozen, &Flow::halving(1.0), &Watch::default()).unwrap(), cube.mesh().positions);
    let frozen = Frozen::default().with_features(&cube, 100.0);
    assert!(frozen.vertices.is_empty());
}

#[test]
fn impossible_jobs_are_refused() {
    let ball = connect(shapes::icosphere(1.0, 2));
    let (none, watch) = (Frozen::default(), Watch::default());
    assert!(matches!(fair(&ball, &none, &Fairing::default(), &watch), Err(Error::Singular { .. })));
    for time in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let flow = Flow { time, steps: 1 };
        assert!(matches!(curvature_flow(&ball, &none, &flow, &watch), Err(Error::NotPositive { .. })));
    }
    let params = Taubin { lambda: 1.5, ..Taubin::default() };
    assert!(matches!(taubin(&ball, &none, &params, &watch), Err(Error::NotPositive { .. })));
    let short = Frozen { vertices: VertexMap::filled(3, true), ..Frozen::default() };
    assert!(matches!(taubin(&ball, &short, &Taubin::default(), &watch), Err(Error::Count { found: 3, .. })));
    let mut broken = ball.mesh().clone();
    broken.positions[7].y = f64::NAN;
    let broken = connect(broken);
    assert!(matches!(taubin(&broken, &none, &Taubin::default(), &watch), Err(Error::NotFinite { .. })));
    watch.cancel();
    assert!(matches!(taubin(&ball, &none, &Taubin::default(), &watch), Err(Error::Cancelled(_))));
    assert!(matches!(curvature_flow(&ball, &none, &Flow::halving(1.0), &watch), Err(Error::Cancelled(_))));
}

/// Flat triangles, coincident vertices, points alone: nothing may panic or leave the finite numbers.
#[test]
fn degenerate_meshes_are_survived() {
    let watch = Watch::default();
    let mut flat = shapes::icosphere(1.0, 2);
    for (i, p) in flat.positions.iter_mut().enumerate() {
        *p = if i % 3 == 0 { DVec3::ZERO } else { DVec3::new(p.x, 1e-18 * p.y, 0.0) };
    }
    flat.positions.push(DVec3::splat(9.0));
    let flat = connect(flat);
    let half = hold(&flat, |p| p.x < 0.0);
    for run in [
        taubin(&flat, &half, &Taubin::default(), &watch),
        curvature_flow(&flat, &half, &Flow::halving(0.5), &watch),
        fair(&flat, &half, &Fairing { fairness: Fairness::Triharmonic, rounds: 2 }, &watch),
        curvature_flow(&connect(TriMesh::default()), &Frozen::default(), &Flow::halving(0.5), &watch),
    ] {
        match run {
            Ok(points) => assert!(points.iter().all(|p| p.is_finite())),
            Err(e) => assert!(matches!(e, Error::IllConditioned { .. } | Error::Singular { .. }), "{e}"),
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let blob = connect(shapes::blob(1.0, 4, 0.4, 3));
    let half = hold(&blob, |p| p.x < 0.1 * PI);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let watch = Watch::default();
            let fairing = Fairing { fairness: Fairness::Triharmonic, rounds: 2 };
            let flow = Flow { time: 0.01, steps: 2 };
            [fair(&blob, &half, &fairing, &watch), curvature_flow(&blob, &half, &flow, &watch)].map(Result::unwrap)
        })
    };
    assert_eq!(on(1), on(3));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// What is held keeps its bits, and size is no matter: a power of two changes exponents only.
    #[test]
    fn smoothing_commutes_with_scaling_and_keeps_what_is_held(
        roughness in 0.1f64..0.6,
        seed in 0u64..1000,
        power in -100i32..100,
        above in -0.9f64..0.9,
    ) {
        let scale = 2f64.powi(power);
        let blob = shapes::blob(1.0, 2, roughness, seed);
        let mut large = blob.clone();
        large.positions.iter_mut().for_each(|p| *p *= scale);
        let (blob, large) = (connect(blob), connect(large));
        let held = hold(&blob, |p| p.z > above);
        let watch = Watch::default();
        let smooth = |mesh: &Connected<TriMesh>, size: f64| {
            let flow = Flow { time: 0.02 * size * size, steps: 2 };
            let fairing = Fairing { fairness: Fairness::Biharmonic, ..Fairing::default() };
            [
                taubin(mesh, &held, &Taubin::default(), &watch).unwrap(),
                curvature_flow(mesh, &held, &flow, &watch).unwrap(),
                fair(mesh, &held, &fairing, &watch).unwrap(),
            ]
        };
        for (small, large) in smooth(&blob, 1.0).into_iter().zip(smooth(&large, scale)) {
            for ((p, q), at) in small.iter().zip(&large).zip(&blob.mesh().positions) {
                prop_assert!((scale * *p - *q).length() <= 1e-9 * scale, "{} {}", p, q / scale);
                prop_assert!(at.z <= above || p == at);
            }
        }
    }
}
