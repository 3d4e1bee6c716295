//! Booleans against what does not share their mistakes: volumes, symmetry, grids, and the exact self-intersection test.

use glam::DVec3;
use mesh_core::{Connected, FaceOrigin, Faces, TriMesh, VertexOrigin, Watch, shapes, validate};
use proptest::prelude::*;
use std::collections::HashMap;
use tri_intersect::{Boolean, Error, Operation, Params, Slivers, boolean, boolean_all, self_intersections, union_all};

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

/// Everything that must hold of any result.
fn check(a: &TriMesh, b: &TriMesh, result: &Boolean) {
    check_parts(&[a, b], result);
}

fn check_parts(parts: &[&TriMesh], result: &Boolean) {
    let mesh = Connected::new(result.mesh.clone()).unwrap_or_else(|e| panic!("{e}\n{parts:?}"));
    assert!(mesh_core::boundary_loops(&mesh).is_empty(), "open");
    let touches = result.report.warnings.iter().any(|w| matches!(w, tri_intersect::Warning::Contact { .. }));
    if !touches {
        let bad = self_intersections(&result.mesh, &Watch::default()).expect("finite");
        assert!(bad.is_empty(), "{bad:?}\n{parts:?}\n{:?}", result.mesh);
    }
    let size = mesh_core::Bounds::of(parts.iter().flat_map(|m| &m.positions).copied()).diagonal();
    for v in result.mesh.vertex_ids() {
        let p = result.mesh.positions[v.index()];
        match result.origins.vertices[v] {
            VertexOrigin::Input { part, vertex } => assert_eq!(parts[part as usize].positions[vertex.index()], p),
            VertexOrigin::Edge { part, ends, t } => {
                let [x, y] = ends.map(|v| parts[part as usize].positions[v.index()]);
                assert!((x + t * (y - x)).distance(p) <= 1e-14 * size);
            }
            VertexOrigin::Face { part, face, barycentric: [u, v, w] } => {
                let [x, y, z] = parts[part as usize].triangle(face);
                assert!((u * x + v * y + w * z).distance(p) <= 1e-14 * size);
            }
            VertexOrigin::New { stage: "contact" } => assert!(touches),
            o @ VertexOrigin::New { .. } => panic!("{o:?}"),
        }
    }
    let mut sides = HashMap::new();
    for f in result.mesh.face_ids() {
        let c = result.mesh.corners(f);
        let (FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face }) = result.origins.faces[f] else {
            panic!("a new face")
        };
        (0..3).for_each(|k| assert!(sides.insert((c[k], c[(k + 1) % 3]), part).is_none()));
        // Faces that claim to be whole have the corners they had, to the bit; pieces lie in the plane of their face.
        let triangle = parts[part as usize].triangle(face);
        if let FaceOrigin::Input { .. } = result.origins.faces[f] {
            assert!(result.mesh.triangle(f).iter().all(|p| triangle.contains(p)));
        } else {
            let n = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
            assert!(result.mesh.triangle(f).iter().all(|p| (*p - triangle[0]).dot(n).abs() <= 1e-14 * size));
        }
    }
    // Along a seam the lower part is on the left and another one on the right.
    for seam in &result.seams {
        assert!(seam.closed || parts.len() > 2);
        let n = seam.vertices.len();
        for i in 0..n - usize::from(!seam.closed) {
            let (u, v) = (seam.vertices[i], seam.vertices[(i + 1) % n]);
            assert!(sides[&(u, v)] < sides[&(v, u)]);
        }
    }
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

/// Seven spheres in a chain, each overlapping the next, and a plate through all of them.
#[test]
fn many_parts() {
    let ball = shapes::icosphere(0.6, 2);
    let mut parts: Vec<TriMesh> =
        (0..5).map(|i| moved(ball.clone(), DVec3::new(f64::from(i) * 0.8, 0.01, 0.02))).collect();
    parts.push(moved(shapes::cuboid(DVec3::new(6.0, 3.0, 0.3)), DVec3::new(1.4, 0.0, 0.0)));
    let connected: Vec<_> = parts.iter().map(|m| Connected::new(m.clone()).unwrap()).collect();
    let all: Vec<_> = connected.iter().collect();
    let union = union_all(&all, &Params::default(), &Watch::default()).unwrap();
    check_parts(&parts.iter().collect::<Vec<_>>(), &union);
    // The spheres' common seams are still known: four, each cut in two by the plate, besides the plate's two.
    assert_eq!(union.seams.iter().filter(|s| !s.closed).count(), 8);
    assert_eq!(union.seams.iter().filter(|s| s.closed).count(), 2);
    let reversed: Vec<_> = all.iter().rev().copied().collect();
    let other = union_all(&reversed, &Params::default(), &Watch::default()).unwrap();
    assert!((volume(&union.mesh) - volume(&other.mesh)).abs() < 1e-12);
    let cut = boolean_all(&reversed, Operation::Difference, &Params::default(), &Watch::default()).unwrap();
    let spheres = union_all(&all[..5], &Params::default(), &Watch::default()).unwrap();
    assert!((volume(&cut.mesh) + volume(&spheres.mesh) - volume(&union.mesh)).abs() < 1e-12);
}

/// Disjoint, nested, hollow.
#[test]
fn parts_that_do_not_cross() {
    let a = shapes::icosphere(1.0, 2);
    volumes_add_up(&a, &moved(a.clone(), DVec3::new(3.0, 0.0, 0.0)));
    let core = shapes::icosphere(0.5, 2);
    volumes_add_up(&a, &core);
    let hollow = run(&a, &core, Operation::Difference).unwrap().mesh;
    volumes_add_up(&hollow, &shapes::icosphere(0.25, 2));
    volumes_add_up(&hollow, &moved(shapes::icosphere(0.4, 2), DVec3::new(0.3, 0.1, 0.05)));
    assert!(matches!(run(&core, &a, Operation::Difference), Err(Error::Empty(_))));
}

/// One thread and two give the same bits.
#[test]
fn threads_do_not_change_the_result() {
    let a = shapes::icosphere(1.0, 5);
    let b = moved(shapes::torus(1.0, 0.4, 90, 40), DVec3::new(0.5, 0.2, 0.1));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let result = pool.install(|| run(&a, &b, Operation::Union)).unwrap();
        (result.mesh, result.origins, result.seams)
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(3));
}

/// Quarter turns are exact in doubles, so everything must come out the same, only turned.
#[test]
fn quarter_turns_commute() {
    let a = shapes::cuboid(DVec3::new(2.0, 1.0, 1.0));
    let b = moved(shapes::icosphere(0.7, 2), DVec3::new(0.6, 0.35, 0.2));
    let turn = |m: &TriMesh| TriMesh {
        positions: m.positions.iter().map(|p| DVec3::new(-p.y, p.x, p.z)).collect(),
        faces: m.faces.clone(),
    };
    for operation in [Operation::Union, Operation::Difference, Operation::Intersection] {
        let plain = run(&a, &b, operation).unwrap().mesh;
        let turned = run(&turn(&a), &turn(&b), operation).unwrap().mesh;
        assert_eq!(turn(&plain).positions, turned.positions);
        assert!((volume(&plain) - volume(&turned)).abs() < 1e-15);
    }
}

/// Sizes from 1e-300 to 1e300: a power of two changes nothing but the scale.
#[test]
fn any_scale() {
    let a = shapes::icosphere(1.0, 1);
    let b = moved(a.clone(), DVec3::new(0.5, 0.25, 0.125));
    let plain = run(&a, &b, Operation::Union).unwrap().mesh;
    for exponent in [-990, -500, -40, 60, 300, 900] {
        let s = f64::from(exponent).exp2();
        let scaled = |m: &TriMesh| TriMesh { positions: m.positions.iter().map(|p| s * *p).collect(), ..m.clone() };
        let result = run(&scaled(&a), &scaled(&b), Operation::Union).unwrap().mesh;
        assert_eq!(result, scaled(&plain), "{exponent}");
    }
}

/// What cannot be done says where.
/// Beside a solid of 2^100 times its size and more, all places of another are one; inside is inside all the same.
#[test]
fn a_speck_in_a_huge_solid_is_inside() {
    for exponent in [20, 31, 100, 250, 300] {
        let scale = 10f64.powi(exponent);
        let mut huge = shapes::cylinder(1.0, 2.0, 16, 4);
        huge.positions.iter_mut().for_each(|p| *p *= scale);
        let speck = moved(shapes::cylinder(0.4, 3.0, 12, 3), DVec3::Z);
        assert_eq!(run(&huge, &speck, Operation::Union).unwrap().mesh, huge, "{exponent}");
        assert_eq!(run(&speck, &huge, Operation::Intersection).unwrap().mesh, speck, "{exponent}");
        assert!(matches!(run(&speck, &huge, Operation::Difference), Err(Error::Empty(_))), "{exponent}");
        let outside = moved(speck, DVec3::new(0.0, 4.0 * scale, 0.0));
        assert!(matches!(run(&huge, &outside, Operation::Intersection), Err(Error::Empty(_))), "{exponent}");
    }
}

#[test]
fn refusals_have_a_place() {
    let cube = shapes::cuboid(DVec3::ONE);
    let mut open = cube.clone();
    open.faces.pop();
    assert!(matches!(run(&cube, &open, Operation::Union), Err(Error::Open { part: 1, .. })));
    let mut inside_out = cube.clone();
    inside_out.faces.iter_mut().for_each(|f| f.swap(1, 2));
    assert!(matches!(run(&inside_out, &cube, Operation::Union), Err(Error::InsideOut { part: 0, .. })));
    let mut nan = cube.clone();
    nan.positions[3].y = f64::NAN;
    assert!(matches!(run(&nan, &cube, Operation::Union), Err(Error::NotFinite { part: 0, .. })));
    let watch = Watch::default();
    watch.cancel();
    let c = Connected::new(cube).unwrap();
    assert!(matches!(boolean(&c, &c, Operation::Union, &Params::default(), &watch), Err(Error::Cancelled(_))));
}

/// With a coarse tolerance most of the seam's short edges go, the result stays valid, and nothing moves farther.
#[test]
fn short_edges_collapse_within_the_tolerance() {
    let a = shapes::icosphere(1.0, 4);
    let b = moved(a.clone(), DVec3::new(0.513, 0.217, 0.131));
    let connect = |m: &TriMesh| Connected::new(m.clone()).unwrap();
    let with = |slivers| {
        let params = Params { slivers, ..Params::default() };
        boolean(&connect(&a), &connect(&b), Operation::Union, &params, &Watch::default()).unwrap()
    };
    let kept = with(Slivers::Keep);
    let diagonal = mesh_core::Bounds::of(a.positions.iter().chain(&b.positions).copied()).diagonal();
    let tolerance = 2e-3;
    let tidy = with(Slivers::Collapse { tolerance });
    assert!(tidy.mesh.positions.len() < kept.mesh.positions.len());
    let mesh = connect(&tidy.mesh);
    assert!(mesh_core::boundary_loops(&mesh).is_empty());
    assert!(self_intersections(&tidy.mesh, &Watch::default()).unwrap().is_empty());
    assert!((volume(&tidy.mesh) - volume(&kept.mesh)).abs() < tolerance * diagonal);
    assert!(tidy.mesh.positions.iter().all(|p| kept.mesh.positions.contains(p)));
    let short = |m: &TriMesh| {
        let edge = |t: &[mesh_core::VertexId; 3], k: usize| {
            m.positions[t[k].index()].distance(m.positions[t[(k + 1) % 3].index()]) < tolerance * diagonal
        };
        m.faces.iter().map(|t| (0..3).filter(|&k| edge(t, k)).count()).sum::<usize>()
    };
    assert!(3 * short(&tidy.mesh) < short(&kept.mesh), "{} {}", short(&tidy.mesh), short(&kept.mesh));
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

/// A rod through a drum, with the coordinates of a 32-bit file: where diagonals of both cross, rounding folds a sliver, and
/// the result was refused before the sliver could be collapsed.
#[test]
fn slivers_that_meet_are_collapsed_before_the_result_is_judged() {
    let single = |mut mesh: TriMesh| {
        mesh.positions.iter_mut().for_each(|p| *p = p.as_vec3().as_dvec3());
        Connected::new(mesh).unwrap()
    };
    let mut met = 0;
    for (segments, sides) in [(32, 24), (32, 16), (48, 24), (24, 24), (64, 32), (40, 20)] {
        let drum = single(shapes::cylinder(1.0, 1.0, segments, 1));
        let mut rod = shapes::cylinder(0.3, 3.0, sides, 1);
        rod.positions.iter_mut().for_each(|p| *p = DVec3::new(p.z, p.y, -p.x));
        let rod = single(rod);
        for operation in [Operation::Union, Operation::Difference, Operation::Intersection] {
            let made = boolean(&drum, &rod, operation, &Params::default(), &Watch::default());
            let made = made.unwrap_or_else(|e| panic!("{segments} {sides} {operation:?}: {e}"));
            assert!(validate(&made.mesh).is_closed());
            assert!(self_intersections(&made.mesh, &Watch::default()).unwrap().is_empty());
            let with =
                |slivers| boolean(&drum, &rod, operation, &Params { slivers, ..Params::default() }, &Watch::default());
            met += usize::from(with(Slivers::Keep).is_err());
        }
    }
    assert!(met > 0);
}
