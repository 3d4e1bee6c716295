//! Every shape is what it says: closed, oriented, of the right topology, and as large as analysis has it.

use glam::{DQuat, DVec3};
use mesh_core::{Connected, Positions, TriMesh, area, bounds, shapes, topology, validate, volume};
use std::f64::consts::{PI, SQRT_2};

fn check(name: &str, mesh: &TriMesh, genus: i64) {
    let report = validate(mesh);
    assert!(report.is_clean() && report.is_closed() && report.duplicate_positions == 0, "{name}: {report}");
    let counts = topology(&Connected::new(mesh).unwrap());
    assert_eq!((counts.genus(), counts.components, counts.euler_characteristic()), (genus, 1, 2 - 2 * genus), "{name}");
    assert!(volume(mesh) > 0.0, "{name}");
}

/// Volume and area at three resolutions: closed each time, and the error a quarter each time.
fn converges(name: &str, make: impl Fn(u32) -> TriMesh, genus: i64, true_volume: f64, true_area: f64) {
    let errors = [8, 16, 32].map(|n| {
        let mesh = make(n);
        check(name, &mesh, genus);
        [true_volume - volume(&mesh), true_area - area(&mesh)]
    });
    for k in 0..2 {
        for pair in errors.windows(2) {
            assert!((3.5..4.6).contains(&(pair[0][k] / pair[1][k])), "{name}: {errors:?}");
        }
    }
}

#[test]
fn round_shapes_converge_to_their_formulas() {
    let (r, h) = (1.5, 4.0);
    let ball = [4.0 / 3.0 * PI * r * r * r, 4.0 * PI * r * r];
    converges("uv sphere", |n| shapes::uv_sphere(r, 2 * n, n), 0, ball[0], ball[1]);
    converges("geodesic sphere", |n| shapes::geodesic_sphere(r, n), 0, ball[0], ball[1]);
    converges("torus", |n| shapes::torus(3.0, 1.0, 2 * n, n), 1, 6.0 * PI * PI, 12.0 * PI * PI);
    converges("cylinder", |n| shapes::cylinder(r, h, 2 * n, n), 0, PI * r * r * h, 2.0 * PI * r * (r + h));
    let slant = r.hypot(h);
    converges("cone", |n| shapes::cone(r, h, 2 * n, n), 0, PI * r * r * h / 3.0, PI * r * (r + slant));
    let (a, b) = (2.0, 0.5);
    let frustum = [PI * h / 3.0 * (a * a + a * b + b * b), PI * (a * a + b * b + (a + b) * (a - b).hypot(h))];
    converges("frustum", |n| shapes::truncated_cone([a, b], h, 2 * n, n), 0, frustum[0], frustum[1]);
    converges(
        "inverted cone",
        |n| shapes::truncated_cone([0.0, r], h, 2 * n, 1),
        0,
        PI * r * r * h / 3.0,
        PI * r * (r + slant),
    );
    let pipe = [PI * h * (a * a - b * b), 2.0 * PI * (a + b) * h + 2.0 * PI * (a * a - b * b)];
    converges("tube", |n| shapes::tube(b, a, h, 2 * n, n), 1, pipe[0], pipe[1]);
    converges(
        "capsule",
        |n| shapes::capsule(r, h, 2 * n, n / 2, n),
        0,
        ball[0] + PI * r * r * h,
        ball[1] + 2.0 * PI * r * h,
    );
}

#[test]
fn flat_shapes_are_exact() {
    let size = DVec3::new(1.0, 2.0, 3.0);
    let boxes = [shapes::cuboid(size), shapes::cuboid_grid(size, [3, 4, 5])];
    for mesh in &boxes {
        check("box", mesh, 0);
        assert!((volume(mesh) - 6.0).abs() < 1e-13 && (area(mesh) - 22.0).abs() < 1e-13);
        assert_eq!(bounds(mesh).max, 0.5 * size);
    }
    assert_eq!(boxes[1].faces.len(), 4 * (12 + 20 + 15));
    let bracket = shapes::bracket(DVec3::new(4.0, 2.0, 3.0), 1.0, [4, 2, 3]);
    check("bracket", &bracket, 0);
    assert!((volume(&bracket) - 2.0 * (4.0 + 2.0)).abs() < 1e-13);
    assert!((area(&bracket) - (2.0 * 6.0 + 2.0 * (4.0 + 3.0 + 4.0 + 3.0))).abs() < 1e-13);
    let plane = shapes::grid(3.0, 2.0, 5, 4);
    let counts = topology(&Connected::new(&plane).unwrap());
    assert_eq!((counts.faces, counts.boundary_loops, counts.euler_characteristic()), (40, 1, 1));
    assert!((area(&plane) - 6.0).abs() < 1e-13);
}

/// Newell's pot is about 0.3% out of round; its volumes are our own limit, so only convergence is tested.
#[test]
fn the_teapot_has_its_openings_or_none() {
    let open = shapes::teapot(6);
    for (name, mesh, loops) in
        [("body", &open.body, 1), ("lid", &open.lid, 1), ("handle", &open.handle, 2), ("spout", &open.spout, 2)]
    {
        let report = validate(mesh);
        assert!(report.is_clean() && report.duplicate_positions == 0, "{name}: {report}");
        let counts = topology(&Connected::new(mesh).unwrap());
        assert_eq!((counts.boundary_loops, counts.genus(), counts.components), (loops, 0, 1), "{name}");
    }
    let parts = |n| {
        let pot = shapes::closed_teapot(n);
        [pot.body, pot.lid, pot.handle, pot.spout]
    };
    let volumes = [4, 8, 16, 32].map(|n| {
        parts(n).map(|mesh| {
            check("teapot", &mesh, 0);
            volume(&mesh)
        })
    });
    for k in 0..4 {
        let steps: Vec<f64> = volumes.windows(2).map(|w| w[1][k] - w[0][k]).collect();
        assert!(steps[0] / steps[1] > 3.4 && steps[1] / steps[2] > 3.4, "{k}: {volumes:?}");
    }
    let all = bounds(&open.body).union(bounds(&open.lid)).union(bounds(&open.handle)).union(bounds(&open.spout));
    assert_eq!((all.min.z, all.max.z, all.min.x), (0.0, 3.15, -3.0));
    // The tip of the spout, as every copy of the pot has it.
    assert!((all.max.x - 3.434).abs() < 0.01, "{}", all.max.x);
    // The widest circle of the body, in the middle of a quarter: 0.125·2 + 0.375·2·(0.56 + 1), both coordinates.
    let widest = open.body.positions.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
    assert!((widest - 2.0 * SQRT_2 * (0.125 + 0.375 * 1.56)).abs() < 1e-12, "{widest}");
}

#[test]
fn blobs_are_star_shaped_and_all_different() {
    let mut seen: Vec<f64> = vec![];
    for seed in 0..5 {
        let mesh = shapes::blob(2.0, 4, 0.6, seed);
        check("blob", &mesh, 0);
        // Star-shaped: the origin sees the inside of every face.
        for c in &mesh.faces {
            let [a, b, c] = c.map(|v| mesh.position(v));
            assert!(a.dot(b.cross(c)) > 0.0);
            assert!((0.8..3.2).contains(&a.length()));
        }
        assert!(seen.iter().all(|v| (v - volume(&mesh)).abs() > 1e-3));
        seen.push(volume(&mesh));
    }
}

#[test]
fn posing_keeps_the_size() {
    let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0);
    let mesh = shapes::posed(shapes::torus(2.0, 0.5, 16, 8), turn, DVec3::new(10.0, 0.0, -3.0));
    let there = shapes::torus(2.0, 0.5, 16, 8);
    assert!((volume(&mesh) - volume(&there)).abs() < 1e-12 && (area(&mesh) - area(&there)).abs() < 1e-12);
    assert!(mesh.positions[0].distance(turn * there.positions[0] + DVec3::new(10.0, 0.0, -3.0)) < 1e-14);
}

/// Counts below the least, sizes of zero and worse: no panic, and always a mesh.
#[test]
fn silly_sizes_are_survived() {
    for x in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300] {
        let all = [
            shapes::uv_sphere(x, 0, 0),
            shapes::torus(x, x, 0, 0),
            shapes::capsule(x, x, 0, 0, 0),
            shapes::truncated_cone([x, 0.0], x, 0, 0),
            shapes::tube(x, x, x, 0, 0),
            shapes::grid(x, x, 0, 0),
            shapes::cuboid_grid(DVec3::splat(x), [0; 3]),
            shapes::bracket(DVec3::splat(x), x, [0; 3]),
            shapes::geodesic_sphere(x, 0),
            shapes::blob(x, 0, x, 0),
            shapes::teapot(0).body,
        ];
        // Radius zero leaves nothing but the axis.
        assert!(x == 0.0 || all.iter().all(|mesh| !mesh.faces.is_empty()));
    }
}
