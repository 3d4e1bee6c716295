//! Booleans against what does not share their mistakes: volumes, symmetry, grids, and the exact self-intersection test.

use glam::DVec3;
use mesh_core::{Connected, Faces, TriMesh, VertexOrigin, Watch, shapes};
use proptest::prelude::*;
use tri_intersect::{Boolean, Error, Operation, Params, boolean, self_intersections};

fn moved(mut mesh: TriMesh, by: DVec3) -> TriMesh {
    mesh.positions.iter_mut().for_each(|p| *p += by);
    mesh
}

fn volume(mesh: &TriMesh) -> f64 {
    mesh.faces.iter().map(|c| c.map(|v| mesh.positions[v.index()])).map(|[p, q, r]| p.dot(q.cross(r))).sum::<f64>()
        / 6.0
}

fn run(a: &TriMesh, b: &TriMesh, operation: Operation) -> Result<Boolean, Error> {
    let connect = |m: &TriMesh| Connected::new(m.clone()).expect("manifold input");
    boolean(&connect(a), &connect(b), operation, &Params::default(), &Watch::default())
}

/// Volume of a result, 0 if nothing is left; checks everything that must hold of any result.
fn checked_volume(a: &TriMesh, b: &TriMesh, operation: Operation) -> f64 {
    match run(a, b, operation) {
        Ok(result) => {
            check(a, b, &result);
            volume(&result.mesh)
        }
        Err(Error::Empty(_)) => 0.0,
        Err(e) => panic!("{operation:?}: {e}\n{a:?}\n{b:?}"),
    }
}

fn check(a: &TriMesh, b: &TriMesh, result: &Boolean) {
    let mesh = Connected::new(result.mesh.clone()).unwrap_or_else(|e| panic!("{e}\n{a:?}\n{b:?}"));
    assert!(mesh_core::boundary_loops(&mesh).is_empty(), "open");
    let touches = result.report.warnings.iter().any(|w| matches!(w, tri_intersect::Warning::Contact { .. }));
    if !touches {
        let bad = self_intersections(&result.mesh, &Watch::default()).expect("finite");
        assert!(bad.is_empty(), "{bad:?}\n{a:?}\n{b:?}\n{:?}", result.mesh);
    }
    let parts = [a, b];
    let size = mesh_core::Bounds::of(a.positions.iter().chain(&b.positions).copied()).diagonal();
    for v in result.mesh.vertex_ids() {
        let p = result.mesh.positions[v.index()];
        match result.origins.vertices[v] {
            VertexOrigin::Input { part, vertex } => assert_eq!(parts[part as usize].positions[vertex.index()], p),
            VertexOrigin::Edge { part, ends, t } => {
                let [x, y] = ends.map(|v| parts[part as usize].positions[v.index()]);
                assert!((x + t * (y - x)).distance(p) <= 1e-14 * size);
            }
            VertexOrigin::New { stage: "contact" } => assert!(touches),
            o => panic!("{o:?}"),
        }
    }
    assert!(result.seams.iter().all(|s| s.closed));
}

/// |A∪B| + |A∩B| = |A| + |B|, |A−B| = |A| − |A∩B|, and the same with the parts exchanged.
fn volumes_add_up(a: &TriMesh, b: &TriMesh) {
    let [union, both, a_less_b] =
        [Operation::Union, Operation::Intersection, Operation::Difference].map(|o| checked_volume(a, b, o));
    let (va, vb) = (volume(a), volume(b));
    let close = |x: f64, y: f64| assert!((x - y).abs() <= 1e-12 * (va + vb), "{x} {y}\n{a:?}\n{b:?}");
    close(union + both, va + vb);
    close(a_less_b, va - both);
    close(checked_volume(b, a, Operation::Union), union);
    close(checked_volume(b, a, Operation::Intersection), both);
    close(checked_volume(b, a, Operation::Difference), vb - both);
}

#[test]
fn two_cubes_in_general_position() {
    let a = shapes::cuboid(DVec3::ONE);
    let b = moved(a.clone(), DVec3::new(0.3, 0.25, 0.4));
    volumes_add_up(&a, &b);
    let both = checked_volume(&a, &b, Operation::Intersection);
    assert!((both - 0.7 * 0.75 * 0.6).abs() < 1e-14);
    let seams = run(&a, &b, Operation::Union).unwrap().seams;
    assert_eq!(seams.len(), 1);
}

#[test]
fn two_spheres() {
    let a = shapes::icosphere(1.0, 3);
    let b = moved(shapes::icosphere(0.8, 3), DVec3::new(0.71, 0.13, 0.37));
    volumes_add_up(&a, &b);
}

/// Cubes on a grid: every way of touching, sharing faces, parts of faces, edges and corners.
#[test]
fn cubes_on_a_grid() {
    let a = shapes::cuboid(DVec3::splat(2.0));
    for i in 0..125 {
        let by = DVec3::new(f64::from(i % 5), f64::from(i / 5 % 5), f64::from(i / 25)) - 2.0;
        for size in [1.0, 2.0, 3.0] {
            volumes_add_up(&a, &moved(shapes::cuboid(DVec3::splat(size)), by + 0.5 * (size - 2.0)));
        }
    }
}

/// A mesh with itself.
#[test]
fn same_mesh_twice() {
    let a = shapes::icosphere(1.0, 2);
    volumes_add_up(&a, &a.clone());
    let union = run(&a, &a, Operation::Union).unwrap();
    assert_eq!(union.mesh.positions, a.positions);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Spheres with their vertices snapped to a coarse grid, moved by grid steps: degeneracies of every kind.
    #[test]
    fn snapped_tetrahedra(p in proptest::collection::vec(-3i32..=3, 12), q in proptest::collection::vec(-3i32..=3, 12)) {
        let tetrahedron = |c: &[i32]| {
            let points: Vec<DVec3> =
                c.chunks(3).map(|c| DVec3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]))).collect();
            let mesh = TriMesh::from_arrays(points, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
            match volume(&mesh) {
                0.0 => None,
                v if v > 0.0 => Some(mesh),
                _ => Some(TriMesh { faces: mesh.faces.iter().map(|f| [f[0], f[2], f[1]]).collect(), ..mesh }),
            }
        };
        if let (Some(a), Some(b)) = (tetrahedron(&p), tetrahedron(&q)) {
            volumes_add_up(&a, &b);
        }
    }
}
