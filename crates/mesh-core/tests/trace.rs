//! Paths over a surface against the geometry they claim to follow.

use glam::DVec3;
use mesh_core::{
    Connected, FaceId, Faces, HalfedgeId, Positions, SurfacePoint, TraceError, TraceLimits, TriMesh, VertexId, shapes,
    trace,
};
use proptest::prelude::*;

type Mesh = Connected<TriMesh>;

/// `n`·`n` unit squares in the plane z = 0, each cut along its rising diagonal.
fn grid(n: u32) -> Mesh {
    let at = |x: u32, y: u32| y * (n + 1) + x;
    let positions = (0..=n).flat_map(|y| (0..=n).map(move |x| DVec3::new(f64::from(x), f64::from(y), 0.0)));
    let faces = (0..n).flat_map(|y| {
        (0..n).flat_map(move |x| {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            [[a, b, c], [a, c, d]]
        })
    });
    Connected::new(TriMesh::from_arrays(positions.collect(), faces)).unwrap()
}

fn run(mesh: &Mesh, from: SurfacePoint, to: SurfacePoint, normal: DVec3) -> Vec<SurfacePoint> {
    let path = trace(mesh, from, to, normal, &TraceLimits::default()).unwrap();
    let whole: Vec<_> = [from].into_iter().chain(path.iter().copied()).chain([to]).collect();
    for pair in whole.windows(2) {
        assert!(pair[0].faces(mesh).any(|f| pair[1].lies_in(mesh, f)), "{pair:?} share no face");
    }
    path
}

fn length(mesh: &Mesh, from: SurfacePoint, path: &[SurfacePoint], to: SurfacePoint) -> f64 {
    let places: Vec<_> = [from].iter().chain(path).chain(&[to]).map(|p| p.position(mesh)).collect();
    places.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn in_face(face: u32, x: f64, y: f64) -> SurfacePoint {
    let (x, y) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
    SurfacePoint::Face { face: FaceId(face), barycentric: [1.0 - x - y, x, y] }
}

#[test]
fn grid_lines_and_diagonals_run_through_vertices() {
    let mesh = grid(8);
    let at = |x: u32, y: u32| SurfacePoint::Vertex(VertexId(9 * y + x));
    assert_eq!(run(&mesh, at(1, 3), at(5, 3), DVec3::Z), [at(2, 3), at(3, 3), at(4, 3)]);
    assert_eq!(run(&mesh, at(5, 3), at(1, 3), DVec3::Z), [at(4, 3), at(3, 3), at(2, 3)]);
    assert_eq!(run(&mesh, at(2, 2), at(5, 5), DVec3::Z), [at(3, 3), at(4, 4)]);
    assert_eq!(run(&mesh, at(4, 1), at(4, 2), DVec3::Z), []);
    // Against the diagonals: over the middle of every one.
    let path = run(&mesh, at(3, 1), at(1, 3), DVec3::Z);
    let places: Vec<_> = path.iter().map(|p| p.position(&mesh)).collect();
    assert_eq!(places, [DVec3::new(2.5, 1.5, 0.0), DVec3::new(2.0, 2.0, 0.0), DVec3::new(1.5, 2.5, 0.0)]);
}

/// Along the common edge of two faces, then on: the start is within rounding of the plane's line.
#[test]
fn starts_and_ends_on_edges() {
    let mesh = grid(6);
    let side = |x: u32, y: u32, t: f64| {
        // The edge from (x, y) to (x + 1, y), first side of its square's lower triangle.
        SurfacePoint::Edge { halfedge: HalfedgeId::new(FaceId(2 * (6 * y + x)), 0), t }
    };
    assert_eq!(run(&mesh, side(1, 2, 0.3), side(4, 2, 0.6), DVec3::Z).len(), 3);
    let path = run(&mesh, side(1, 1, 0.5), side(1, 4, 0.5), DVec3::Z);
    assert_eq!(path.len(), 5);
    assert!(path.iter().all(|p| (p.position(&mesh).x - 1.5).abs() < 1e-15));
}

#[test]
fn goes_over_a_crease() {
    let mesh = Connected::new(shapes::cuboid(DVec3::splat(2.0))).unwrap();
    let near = |p: DVec3| {
        let f = mesh.face_ids().max_by(|&f, &g| {
            let depth = |f: FaceId| {
                let [a, b, c] = mesh.triangle(f);
                let n = (b - a).cross(c - a);
                let w = [(c - b, b), (a - c, c), (b - a, a)]
                    .map(|(e, o)| e.cross(p - o).dot(n))
                    .into_iter()
                    .fold(9.0, f64::min);
                if (p - a).dot(n).abs() > 1e-9 { -9.0 } else { w }
            };
            depth(f).total_cmp(&depth(g))
        });
        let f = f.unwrap();
        let [a, b, c] = mesh.triangle(f);
        let n = (b - a).cross(c - a);
        let w = [(c - b, b), (a - c, c), (b - a, a)].map(|(e, o)| e.cross(p - o).dot(n) / n.length_squared());
        SurfacePoint::Face { face: f, barycentric: w }
    };
    let (from, to) = (near(DVec3::new(0.7, 0.2, 1.0)), near(DVec3::new(1.0, 0.3, 0.6)));
    let path = run(&mesh, from, to, DVec3::new(1.0, 0.0, 1.0));
    // In the plane through both that holds the bisector, the crease is met where the unfolded line meets it or nearly so.
    let crest: Vec<_> = path.iter().map(|p| p.position(&mesh)).filter(|p| p.x == 1.0 && p.z == 1.0).collect();
    assert_eq!(crest.len(), 1);
    assert!((0.2..0.3).contains(&crest[0].y));
}

#[test]
fn holes_and_thin_walls_stop_it() {
    // A grid with its middle columns missing.
    let whole = grid(9);
    let mut mesh = whole.mesh().clone();
    mesh.faces.retain(|c| {
        let x = c.iter().map(|&v| whole.position(v).x).sum::<f64>() / 3.0;
        !(4.0..5.0).contains(&x)
    });
    let mesh = Connected::new(mesh).unwrap();
    let limits = TraceLimits::default();
    let (from, to) = (SurfacePoint::Vertex(VertexId(32)), SurfacePoint::Vertex(VertexId(38)));
    assert!(matches!(trace(&mesh, from, to, DVec3::Z, &limits), Err(TraceError::Lost { .. })));
    let wall = Connected::new(shapes::cuboid(DVec3::new(1.0, 1.0, 1e-3))).unwrap();
    let tight = TraceLimits { slack: 0.0, ..limits };
    let mut pairs = 0;
    for f in wall.face_ids().filter(|&f| wall.corners(f).iter().all(|&v| wall.position(v).z > 0.0)) {
        for g in wall.face_ids().filter(|&g| wall.corners(g).iter().all(|&v| wall.position(v).z < 0.0)) {
            let (p, q) = (in_face(f.0, 0.33, 0.33), in_face(g.0, 0.33, 0.33));
            if p.position(&wall).distance(q.position(&wall)) > 0.1 {
                continue;
            }
            pairs += 1;
            assert!(matches!(trace(&wall, p, q, DVec3::Z, &tight), Err(TraceError::Lost { .. })));
        }
    }
    assert!(pairs > 0);
}

#[test]
fn bad_ends_are_named() {
    let mesh = grid(2);
    let good = SurfacePoint::Vertex(VertexId(0));
    for point in [
        SurfacePoint::Vertex(VertexId(9)),
        SurfacePoint::Edge { halfedge: HalfedgeId(24), t: 0.5 },
        SurfacePoint::Face { face: FaceId(1), barycentric: [f64::INFINITY, 0.5, 0.5] },
    ] {
        assert_eq!(trace(&mesh, good, point, DVec3::Z, &TraceLimits::default()), Err(TraceError::BadPoint { point }));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// On a sphere the section is nearly a great circle: right length, in the plane, and the same both ways.
    #[test]
    fn follows_great_circles(
        faces in prop::array::uniform2(0u32..1280),
        spots in prop::array::uniform4(0.05..0.95f64),
    ) {
        let mesh = Connected::new(shapes::icosphere(1.0, 3)).unwrap();
        let (from, to) = (in_face(faces[0], spots[0], spots[1]), in_face(faces[1], spots[2], spots[3]));
        let (p, q) = (from.position(&mesh), to.position(&mesh));
        let angle = p.angle_between(q);
        prop_assume!(angle < 2.0);
        let path = run(&mesh, from, to, p + q);
        prop_assert!(length(&mesh, from, &path, to) <= angle * 1.001);
        let across = p.cross(q).normalize_or_zero();
        prop_assert!(path.iter().all(|x| x.position(&mesh).dot(across).abs() < 1e-12));
        let mut back = run(&mesh, to, from, p + q);
        back.reverse();
        prop_assert_eq!(back.len(), path.len());
        for (a, b) in path.iter().zip(&back) {
            prop_assert!(a.position(&mesh).distance(b.position(&mesh)) < 1e-12);
        }
        // Which way the normal points does not matter.
        let other = run(&mesh, from, to, -p - q);
        prop_assert_eq!(other.len(), path.len());
        for (a, b) in path.iter().zip(&other) {
            prop_assert!(a.position(&mesh).distance(b.position(&mesh)) < 1e-12);
        }
        // Without a usable plane the strip search finds a path of nearly the same length.
        prop_assume!(angle < 1.0);
        let path = run(&mesh, from, to, q - p);
        prop_assert!(length(&mesh, from, &path, to) <= angle * 1.1 + 0.05);
    }

    /// Needles: a grid squeezed a million times in one direction still joins any two of its points by a straight line.
    #[test]
    fn squeezed_grids_are_crossed(faces in prop::array::uniform2(0u32..512), spots in prop::array::uniform4(0.0..1.0f64)) {
        let mut mesh = grid(16).into_mesh();
        for p in &mut mesh.positions {
            p.y *= 1e-6;
        }
        let mesh = Connected::new(mesh).unwrap();
        let (from, to) = (in_face(faces[0], spots[0], spots[1]), in_face(faces[1], spots[2], spots[3]));
        let path = run(&mesh, from, to, DVec3::Z);
        let straight = from.position(&mesh).distance(to.position(&mesh));
        prop_assert!(length(&mesh, from, &path, to) <= straight * (1.0 + 1e-9) + 1e-12);
    }
}
