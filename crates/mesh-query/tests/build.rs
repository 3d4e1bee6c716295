//! Building: what is refused, what is not, and that threads change nothing.

use glam::DVec3;
use mesh_core::{FaceId, Faces, Stopwatch, TriMesh, VertexId, shapes};
use mesh_query::{Error, TriBvh};
use std::time::Duration;

/// A row of equal triangles at equal distances: every node has two equally good neighbours.
fn evenly_spaced(count: u32, step: f64) -> TriMesh {
    let positions = (0..count)
        .flat_map(|i| [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]].map(|[x, y]| DVec3::new(x + step * f64::from(i), y, 0.0)))
        .collect();
    TriMesh::from_arrays(positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]))
}

#[test]
fn points_that_are_none_and_corners_that_are_missing_are_refused() {
    let mut mesh = shapes::cuboid(DVec3::ONE);
    mesh.positions.push(DVec3::NAN);
    assert!(TriBvh::build(&mesh).is_ok(), "no face uses it");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut mesh = mesh.clone();
        mesh.positions[3].y = bad;
        let first = mesh.face_ids().find(|&f| mesh.corners(f).contains(&VertexId(3))).unwrap();
        let error = TriBvh::build(&mesh).map(|_| ()).unwrap_err();
        assert!(matches!(error, Error::NotFinite { face, vertex: VertexId(3), .. } if face == first), "{error}");
    }
    mesh.faces[5][2] = VertexId(99);
    let error = TriBvh::build(&mesh).map(|_| ()).unwrap_err();
    assert_eq!(error, Error::MissingVertex { face: FaceId(5), vertex: VertexId(99), count: 9 });
    let error = TriBvh::build_subset(&mesh, &[FaceId(2), FaceId(12)]).map(|_| ()).unwrap_err();
    assert_eq!(error, Error::MissingFace { face: FaceId(12), count: 12 });
}

#[test]
fn an_empty_mesh_answers_nothing() {
    let mesh = TriMesh::default();
    let tree = TriBvh::build(&mesh).unwrap();
    assert_eq!(tree.face_count(), 0);
    assert!(tree.bounds().is_empty());
    assert_eq!(tree.closest_point(&mesh, DVec3::ZERO), None);
    assert_eq!(tree.ray_cast(&mesh, DVec3::ZERO, DVec3::X, 1.0), None);
    assert!(tree.overlapping_pairs(&mesh, &tree, &mesh).is_empty());
    assert!(tree.self_overlapping_pairs(&mesh).is_empty());
}

#[test]
fn queries_that_mean_nothing_find_nothing() {
    let mesh = shapes::cuboid(DVec3::ONE);
    let tree = TriBvh::build(&mesh).unwrap();
    assert_eq!(tree.closest_point(&mesh, DVec3::NAN), None);
    assert_eq!(tree.closest_point_within(&mesh, DVec3::ZERO, f64::NAN), None);
    assert_eq!(tree.ray_cast(&mesh, DVec3::ZERO, DVec3::ZERO, 1.0), None);
    assert_eq!(tree.ray_cast(&mesh, DVec3::ZERO, DVec3::new(0.0, f64::NAN, 1.0), 1.0), None);
}

#[test]
fn equal_and_evenly_spaced_triangles_build_fast() {
    for step in [0.0, 1.0] {
        let mesh = evenly_spaced(100_000, step);
        let start = Stopwatch::start();
        let tree = TriBvh::build(&mesh).unwrap();
        // A millisecond or ten; minutes when the builder pairs off one node per sweep.
        assert!(start.elapsed() < Duration::from_secs(5));
        let p = DVec3::new(0.1 + 500.0 * step, 0.1, 1.0);
        let found = tree.closest_point(&mesh, p).unwrap();
        assert_eq!((found.face, found.distance), (FaceId(if step == 0.0 { 0 } else { 500 }), 1.0));
    }
}

#[test]
fn ties_go_to_the_lowest_face() {
    let mesh = shapes::icosphere(1.0, 3);
    let tree = TriBvh::build(&mesh).unwrap();
    for v in mesh.vertex_ids() {
        let lowest = mesh.face_ids().find(|&f| mesh.corners(f).contains(&v)).unwrap();
        let found = tree.closest_point(&mesh, 1.5 * mesh.positions[v.index()]).unwrap();
        assert_eq!(found.face, lowest);
        assert_eq!(found.surface_point(&mesh), mesh_core::SurfacePoint::Vertex(v));
    }
}

#[test]
fn rays_do_not_slip_through_edges_and_vertices() {
    let mesh = shapes::icosphere(1.0, 3);
    let tree = TriBvh::build(&mesh).unwrap();
    for f in mesh.face_ids() {
        let [a, b, _] = mesh.triangle(f);
        for target in [a, 0.5 * (a + b), 0.3 * a + 0.7 * b] {
            let origin = DVec3::new(0.1, -0.05, 0.02);
            assert!(tree.ray_occluded(&mesh, origin, target - origin, f64::INFINITY));
        }
    }
}

#[test]
fn threads_change_nothing() {
    let a = shapes::icosphere(1.0, 6);
    let mut b = a.clone();
    b.positions.iter_mut().for_each(|p| *p += DVec3::new(1.1, 0.3, 0.2));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (ta, tb) = (TriBvh::build(&a).unwrap(), TriBvh::build(&b).unwrap());
            (format!("{ta:?}"), ta.overlapping_pairs(&a, &tb, &b), ta.self_overlapping_pairs(&a))
        })
    };
    let (one, two) = (run(1), run(2));
    assert!(one == two, "trees or pairs differ");
    assert!(one.1.len() > 100);
}
