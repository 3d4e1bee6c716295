//! Each step on meshes whose repair is known.

use glam::{DQuat, DVec3};
use mesh_core::{Connected, FaceOrigin, Faces, TriMesh, VertexId, Watch, area, orient, shapes, validate, volume};
use mesh_repair::{Why, close_cracks, drop_duplicates, drop_flat, drop_unusable, drop_unused_vertices, fill_holes};
use proptest::prelude::*;

/// Every triangle with corners of its own, each moved by up to `by`.
fn shattered(mesh: &TriMesh, by: f64, random: &mut fastrand::Rng) -> TriMesh {
    let mut move_by = || by * (2.0 * random.f64() - 1.0) / 3f64.sqrt();
    let points =
        mesh.face_ids().flat_map(|f| mesh.triangle(f)).map(|p| p + DVec3::new(move_by(), move_by(), move_by()));
    TriMesh::from_arrays(points.collect(), (0..mesh.face_count() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// A ball in pieces, with turned, repeated and flat faces among them, comes back with its volume.
    #[test]
    fn a_broken_ball_is_whole_again(seed in 0u64..1 << 32, by in 0.0f64..1e-6, repeats in 0usize..20, turned in 0usize..40) {
        let ball = shapes::icosphere(1.0, 2);
        let mut random = fastrand::Rng::with_seed(seed);
        let mut soup = shattered(&ball, by, &mut random);
        // First, since two copies that face opposite ways bound nothing.
        for _ in 0..turned {
            let f = random.usize(..soup.faces.len());
            soup.faces[f].swap(1, 2);
        }
        for _ in 0..repeats {
            let face = soup.faces[random.usize(..ball.faces.len())];
            soup.faces.push(face);
            soup.faces.push([face[0], face[1], face[1]]);
        }
        random.shuffle(&mut soup.faces);
        let usable = drop_unusable(&soup);
        prop_assert_eq!(usable.count, repeats);
        let unique = drop_duplicates(&usable.mesh);
        let closed = close_cracks(&unique.mesh, 2.1e-6, &Watch::default()).unwrap();
        let (oriented, _) = orient(&closed.mesh);
        let whole = drop_unused_vertices(&oriented).mesh;
        prop_assert!(validate(&whole).is_closed(), "{}", validate(&whole));
        prop_assert_eq!((whole.positions.len(), whole.faces.len()), (ball.positions.len(), ball.faces.len()));
        prop_assert!((volume(&whole) - volume(&ball)).abs() < 2e-5);
    }

    /// A box whose sides are cut into different numbers of triangles along shared edges is closed by splitting them.
    #[test]
    fn sides_of_different_fineness_are_sewn(cells in prop::array::uniform3(1u32..6), more in 1u32..4) {
        let size = DVec3::new(1.0, 1.3, 0.7);
        let coarse = shapes::cuboid_grid(size, cells);
        let fine = shapes::cuboid_grid(size, cells.map(|n| n * more));
        let upper = |m: &TriMesh, f: mesh_core::FaceId| m.triangle(f).iter().all(|p| (p.z - 0.35).abs() < 1e-12);
        let top = fine.face_ids().filter(|&f| upper(&fine, f)).map(|f| fine.corners(f)).collect();
        let rest = coarse.face_ids().filter(|&f| !upper(&coarse, f)).map(|f| coarse.corners(f)).collect();
        let both = TriMesh::merged(&[
            TriMesh { positions: fine.positions, faces: top },
            TriMesh { positions: coarse.positions, faces: rest },
        ]);
        let closed = close_cracks(&both, 1e-9, &Watch::default()).unwrap();
        prop_assert!(validate(&closed.mesh).is_closed(), "{}", validate(&closed.mesh));
        prop_assert!((volume(&closed.mesh) - size.x * size.y * size.z).abs() < 1e-12);
    }

    /// Points put onto edges on one side, with flat faces to close the gap, are taken up by the other side.
    #[test]
    fn flat_faces_go_and_no_gap_is_left(places in prop::collection::vec((0usize..12, 1u32..4), 1..6)) {
        let mut mesh = shapes::cuboid(DVec3::ONE);
        let mut added = 0;
        for (face, corner) in places {
            let [a, b, c] = mesh.faces[face];
            let [p, q] = [a, b].map(|v| mesh.positions[v.index()]);
            // Halves of halves lie on the line exactly.
            let middle = VertexId::from(mesh.positions.len());
            mesh.positions.push(p + (q - p) * f64::from(corner) / 4.0);
            mesh.faces[face] = [a, middle, c];
            mesh.faces.extend([[middle, b, c], [a, b, middle]]);
            added += 1;
        }
        prop_assert!(validate(&mesh).is_closed() && validate(&mesh).zero_area.len() == added);
        let mended = drop_flat(&mesh);
        prop_assert!(validate(&mended.mesh).is_closed() && validate(&mended.mesh).zero_area.is_empty());
        prop_assert!((volume(&mended.mesh) - 1.0).abs() < 1e-12 && (area(&mended.mesh) - 6.0).abs() < 1e-12);
        prop_assert!(mended.count >= added);
    }
}

#[test]
fn a_surface_given_twice_stays_once_and_inner_walls_go() {
    let cube = shapes::cuboid(DVec3::ONE);
    let turned: Vec<_> = cube.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let twice = TriMesh { faces: [cube.faces.clone(), turned].concat(), ..cube.clone() };
    assert_eq!(drop_duplicates(&twice).mesh, cube);
    assert_eq!(
        drop_duplicates(&TriMesh { faces: [&cube.faces[..], &cube.faces[..4]].concat(), ..cube.clone() }).mesh,
        cube
    );
    // Two boxes on one wall, which both have: united, they have none there.
    let grid = shapes::cuboid_grid(DVec3::ONE, [3, 3, 3]);
    let beside = shapes::posed(grid.clone(), DQuat::IDENTITY, DVec3::X);
    let mut both = TriMesh::merged(&[grid, beside]);
    both.positions.iter_mut().for_each(|p| *p = (*p * 6.0).round() / 6.0);
    let closed = close_cracks(&TriMesh { faces: both.faces.clone(), ..both.clone() }, 0.0, &Watch::default()).unwrap();
    assert_eq!(closed.count, 0);
    let first = |v: VertexId| both.positions.iter().position(|p| *p == both.positions[v.index()]).unwrap();
    both.faces = both.faces.iter().map(|f| f.map(|v| VertexId::from(first(v)))).collect();
    let united = drop_duplicates(&both);
    // Both walls have 18 triangles; diagonals of both run alike or the walls do not match.
    if united.count > 0 {
        assert_eq!(united.count, 36);
        assert!(validate(&united.mesh).is_closed() && (volume(&united.mesh) - 2.0).abs() < 1e-12);
    }
}

/// A ball with holes all over: each is filled, and the surface is the ball's again.
#[test]
fn holes_in_a_ball_are_filled_smoothly() {
    let mut ball = shapes::icosphere(1.0, 4);
    let before = volume(&ball);
    let poles = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let open = |f: &[VertexId; 3]| f.iter().any(|v| poles.iter().any(|p| p.distance(ball.positions[v.index()]) < 0.3));
    ball.faces = ball.faces.iter().filter(|f| !open(f)).copied().collect();
    let sound = drop_unused_vertices(&ball).mesh;
    let connected = Connected::new(sound.clone()).unwrap();
    let filled = fill_holes(&connected, &Watch::default()).unwrap();
    assert_eq!((filled.count, filled.left.len()), (6, 0));
    assert!(validate(&filled.mesh).is_closed() && (volume(&filled.mesh) / before - 1.0).abs() < 1e-3);
    assert!(filled.mesh.positions.iter().all(|p| (p.length() - 1.0).abs() < 0.01));
    assert_eq!(filled.mesh.positions[..sound.positions.len()], sound.positions);
    let new = filled.origins.faces.as_slice().iter().filter(|o| matches!(o, FaceOrigin::New { .. })).count();
    assert_eq!(new, filled.mesh.faces.len() - sound.faces.len());
}

/// A rod through a hole: no surface can fill it, and the holes beside it are filled all the same.
#[test]
fn a_hole_that_cannot_be_filled_does_not_fail_the_others() {
    let mut ball = shapes::icosphere(1.0, 3);
    let open = |f: &[VertexId; 3]| f.iter().any(|v| ball.positions[v.index()].z.abs() > 0.95);
    ball.faces = ball.faces.iter().filter(|f| !open(f)).copied().collect();
    let rod = shapes::posed(shapes::cylinder(0.05, 1.0, 12, 4), DQuat::IDENTITY, DVec3::Z);
    let sound = drop_unused_vertices(&TriMesh::merged(&[ball, rod])).mesh;
    let filled = fill_holes(&Connected::new(sound).unwrap(), &Watch::default()).unwrap();
    assert_eq!((filled.count, filled.left.len(), filled.left[0].why), (1, 1, Why::Crosses));
    assert!(filled.left[0].at.z > 0.9);
}

#[test]
fn nothing_at_all_is_survived() {
    let none = TriMesh::default();
    for mended in [drop_unusable(&none), drop_unused_vertices(&none), drop_flat(&none), drop_duplicates(&none)] {
        assert_eq!((mended.count, mended.mesh), (0, TriMesh::default()));
    }
    assert_eq!(close_cracks(&none, 1.0, &Watch::default()).unwrap().count, 0);
    let one = TriMesh::from_arrays(vec![DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]]);
    for gap in [0.0, 0.1, 10.0, f64::INFINITY, f64::NAN] {
        assert_eq!(close_cracks(&one, gap, &Watch::default()).unwrap().mesh, one);
    }
    // Filled, a triangle would be the same face twice.
    let filled = fill_holes(&Connected::new(one.clone()).unwrap(), &Watch::default()).unwrap();
    assert_eq!((filled.count, filled.mesh), (0, one));
}
