//! Curves embedded in meshes: conservation laws, and addresses against places.

use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Positions, SurfacePoint, TraceLimits, TriMesh,
    VertexId, VertexOrigin, Watch, shapes,
};
use proptest::prelude::*;
use tri_intersect::embed::{curve_edges, faces_left_of, flood};
use tri_intersect::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};

type Mesh = Connected<TriMesh>;

fn run(mesh: &Mesh, curves: &[SurfaceCurve]) -> Result<Embedded, EmbedError> {
    embed(mesh, curves, &EmbedParams::default(), &Watch::default())
}

/// Sphere with bumps, and some vertices slid along the surface so that triangles vary.
fn bumpy(levels: u32, depth: f64) -> Mesh {
    let mut mesh = shapes::icosphere(1.0, levels);
    for p in &mut mesh.positions {
        let q = *p + depth * DVec3::new((7.0 * p.y).sin(), (5.0 * p.z).sin(), (6.0 * p.x).sin());
        *p = q * (1.0 + depth * (9.0 * p.x).sin() * (8.0 * p.y).cos());
    }
    Connected::new(mesh).unwrap()
}

/// The point of a star-shaped mesh in a direction, by brute force.
fn shoot(mesh: &Mesh, direction: DVec3) -> SurfacePoint {
    let best = mesh.face_ids().map(|f| {
        let [a, b, c] = mesh.triangle(f);
        let weights = [b.cross(c).dot(direction), c.cross(a).dot(direction), a.cross(b).dot(direction)];
        (weights.iter().copied().fold(f64::INFINITY, f64::min), f, weights)
    });
    let (_, face, weights) = best.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let weights = weights.map(|w| w.max(0.0));
    let sum: f64 = weights.iter().sum();
    SurfacePoint::Face { face, barycentric: weights.map(|w| w / sum) }
}

/// A circle about `axis` at polar angle `polar`, wavy by `wave`, traced over the mesh.
fn circle(mesh: &Mesh, axis: DVec3, polar: f64, wave: f64, samples: usize) -> SurfaceCurve {
    let (u, v) = axis.any_orthonormal_pair();
    let points: Vec<_> = (0..samples)
        .map(|k| {
            let a = std::f64::consts::TAU * k as f64 / samples as f64;
            let p = polar + wave * (5.0 * a).sin();
            let direction = p.cos() * axis + p.sin() * (a.cos() * u + a.sin() * v);
            (shoot(mesh, direction), direction)
        })
        .collect();
    SurfaceCurve::through(mesh, &points, true, &TraceLimits::default()).unwrap().0
}

fn area(mesh: &TriMesh) -> f64 {
    mesh.face_ids().map(|f| mesh.triangle(f)).map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

/// Everything that must hold after any embedding.
fn check(input: &Mesh, curves: &[SurfaceCurve], out: &Embedded) -> Mesh {
    let mesh = Connected::new(out.mesh.clone()).unwrap();
    let (n, m) = (input.vertex_count(), input.face_count());
    // Euler: every new vertex within a closed surface brings two triangles.
    assert_eq!(mesh.face_count() - m, 2 * (mesh.vertex_count() - n));
    assert!((area(mesh.mesh()) / area(input.mesh()) - 1.0).abs() < 1e-12);
    assert!(out.flattened.is_empty());
    for v in input.vertex_ids() {
        assert_eq!(input.position(v), mesh.position(v));
    }
    for v in mesh.vertex_ids() {
        let place = match out.origins.vertices[v] {
            VertexOrigin::Input { part: 0, vertex } => {
                assert_eq!(vertex, v);
                input.position(vertex)
            }
            VertexOrigin::Edge { part: 0, ends: [a, b], t } => {
                input.position(a) + t * (input.position(b) - input.position(a))
            }
            VertexOrigin::Face { part: 0, face, barycentric } => {
                SurfacePoint::Face { face, barycentric }.position(input)
            }
            other => panic!("{other:?}"),
        };
        assert_eq!(place, mesh.position(v));
    }
    let mut pieces = vec![0; m];
    for f in mesh.face_ids() {
        let (parent, whole) = match out.origins.faces[f] {
            FaceOrigin::Input { part: 0, face } => (face, true),
            FaceOrigin::Piece { part: 0, face } => (face, false),
            other => panic!("{other:?}"),
        };
        pieces[parent.index()] += 1;
        if whole {
            assert_eq!((f, mesh.corners(f)), (parent, input.corners(parent)));
        }
        let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
        let turned = normal(mesh.triangle(f)).dot(normal(input.triangle(parent)));
        assert!(turned > 0.0, "piece {f} of {parent} is folded");
    }
    assert!(pieces.iter().all(|&p| p > 0));
    for ((chain, curve), places) in out.curves.iter().zip(curves).zip(&out.places) {
        for [a, b] in curve_edges(chain, curve.closed) {
            assert!(mesh.ring(a).flat_map(|h| [mesh.head(h), mesh.tail(h.prev())]).any(|v| v == b));
        }
        assert_eq!(places.len(), curve.points.len());
        for (point, &k) in curve.points.iter().zip(places) {
            // Merged runs around a vertex move by several snaps; edges of these meshes are mostly under 0.6 long.
            let moved = point.position(input).distance(mesh.position(chain[k]));
            assert!(moved < 0.04, "{moved}");
        }
    }
    mesh
}

/// How many faces lie between two closed curves, on the left of the first, and whether the rest is the other side.
fn left_part(mesh: &Mesh, out: &Embedded) -> Vec<bool> {
    let walls: Vec<_> = out.curves.iter().flat_map(|c| curve_edges(c, true)).collect();
    let left = faces_left_of(mesh, &out.curves[0], true);
    assert_eq!(left.len(), out.curves[0].len());
    let reached = flood(mesh, walls.iter().copied(), &left[..1]);
    // All faces on the left of one curve are one part.
    assert!(left.iter().all(|&f| reached[f]));
    reached.into_vec()
}

/// An equator halves a sphere; two parallels leave a zone whose area is that of Archimedes.
#[test]
fn zone_between_parallels() {
    let mesh = Connected::new(shapes::icosphere(1.0, 4)).unwrap();
    let axis = DVec3::new(0.3, 0.5, 0.9).normalize();
    let curves = [circle(&mesh, axis, 1.2, 0.0, 200), circle(&mesh, axis, 1.3, 0.0, 200)];
    let out = run(&mesh, &curves).unwrap();
    let cut = check(&mesh, &curves, &out);
    let cap = left_part(&cut, &out);
    let part = |wanted: bool| {
        area(&TriMesh {
            positions: out.mesh.positions.clone(),
            faces: cut.face_ids().filter(|f| cap[f.index()] == wanted).map(|f| cut.corners(f)).collect(),
        })
    };
    let exact = std::f64::consts::TAU * (1.0 - 1.2f64.cos());
    assert!((part(true) / exact - 1.0).abs() < 5e-3, "{} {exact}", part(true));
}

/// Many narrow parallels in each face.
#[test]
fn many_curves_in_one_face() {
    let mesh = Connected::new(shapes::icosphere(1.0, 1)).unwrap();
    let curves: Vec<_> = (0..12).map(|k| circle(&mesh, DVec3::Z, 1.0 + 0.01 * f64::from(k), 0.004, 90)).collect();
    let out = run(&mesh, &curves).unwrap();
    check(&mesh, &curves, &out);
}

/// A circle wholly within one big face: the polygon has a hole.
#[test]
fn circle_inside_one_face() {
    let mesh = Connected::new(shapes::cuboid(DVec3::splat(2.0))).unwrap();
    let points = (0..300).map(|k| {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / 300.0).sin_cos();
        SurfacePoint::Face { face: FaceId(3), barycentric: [0.4 + 0.1 * s, 0.3 + 0.1 * c, 0.3 - 0.1 * (s + c)] }
    });
    let curves = [SurfaceCurve { points: points.collect(), closed: true }];
    let out = run(&mesh, &curves).unwrap();
    let cut = check(&mesh, &curves, &out);
    let left = left_part(&cut, &out);
    assert_eq!(left.iter().filter(|&&l| l).count().min(left.iter().filter(|&&l| !l).count()), 298);
}

/// Through vertices, along edges, and from a vertex across a face: the edges of the mesh themselves need no split.
#[test]
fn along_edges_and_through_vertices() {
    let mesh = Connected::new(shapes::icosphere(1.0, 2)).unwrap();
    // The link of a vertex: all along edges.
    let link: Vec<_> = mesh.ring(VertexId(20)).map(|h| SurfacePoint::Vertex(mesh.head(h))).collect();
    let curves = [SurfaceCurve { points: link.clone(), closed: true }];
    let out = run(&mesh, &curves).unwrap();
    check(&mesh, &curves, &out);
    assert_eq!(out.mesh, *mesh.mesh());
    // Spokes from the vertex, crossing the link at the middle of its edges, on to the vertex beyond.
    let h = mesh.ring(VertexId(20)).next().unwrap().next();
    let beyond = mesh.head(mesh.twin(h).unwrap().next());
    let points = vec![
        SurfacePoint::Vertex(VertexId(20)),
        SurfacePoint::Edge { halfedge: h, t: 0.5 },
        SurfacePoint::Vertex(beyond),
    ];
    let spoke = [SurfaceCurve { points, closed: false }];
    let out = run(&mesh, &spoke).unwrap();
    check(&mesh, &spoke, &out);
    assert_eq!(out.mesh.face_count(), mesh.face_count() + 2);
    // Both at once cross.
    let both = [curves[0].clone(), spoke[0].clone()];
    let Err(EmbedError::Crossings(found)) = run(&mesh, &both) else { panic!() };
    assert_eq!(found[0].curves, [0, 1]);
    // An open curve may end where another passes.
    let spur = SurfaceCurve { points: vec![link[0], SurfacePoint::Vertex(VertexId(20))], closed: false };
    let both = [curves[0].clone(), spur];
    check(&mesh, &both, &run(&mesh, &both).unwrap());
}

/// Two great circles cross twice, in places known beforehand.
#[test]
fn crossings_are_reported_where_they_are() {
    let mesh = bumpy(3, 0.02);
    let (a, b) = (DVec3::Z, DVec3::new(0.3, 0.8, 0.4).normalize());
    let curves = [circle(&mesh, a, 1.57, 0.0, 100), circle(&mesh, b, 1.57, 0.0, 100)];
    let Err(EmbedError::Crossings(found)) = run(&mesh, &curves) else { panic!() };
    let pole = a.cross(b).normalize();
    assert_eq!(found.len(), 2, "{found:?}");
    for c in &found {
        assert_eq!(
            {
                let mut s = c.curves;
                s.sort_unstable();
                s
            },
            [0, 1]
        );
        assert!(c.place.normalize().cross(pole).length() < 0.05);
        for k in 0..2 {
            let curve = &curves[c.curves[k]].points;
            let (p, q) = (curve[c.points[k]].position(&mesh), curve[(c.points[k] + 1) % curve.len()].position(&mesh));
            let t = (c.place - p).dot(q - p) / (q - p).length_squared();
            assert!(c.place.distance(p + t.clamp(0.0, 1.0) * (q - p)) < 1e-9, "{c:?}");
        }
    }
}

/// A figure of eight within one face crosses itself.
#[test]
fn figure_of_eight_is_refused() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let points = [[0.2, 0.2, 0.6], [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.5, 0.1, 0.4]];
    let points = points.map(|barycentric| SurfacePoint::Face { face: FaceId(0), barycentric }).to_vec();
    let Err(EmbedError::Crossings(found)) = run(&mesh, &[SurfaceCurve { points, closed: true }]) else { panic!() };
    assert!(found.iter().all(|c| c.curves == [0, 0]));
}

/// Powers of two change no bit but the exponent, so neither may anything else change; and nothing panics where
/// squares overflow or vanish.
#[test]
fn scale_changes_nothing() {
    let mesh = bumpy(2, 0.03);
    let axis = DVec3::new(0.2, -0.4, 0.7).normalize();
    let curves = [circle(&mesh, axis, 1.0, 0.1, 90), circle(&mesh, axis, 1.1, 0.1, 40)];
    let out = run(&mesh, &curves).unwrap();
    let scaled = |exponent: i32| {
        let mut mesh = mesh.mesh().clone();
        mesh.positions.iter_mut().for_each(|p| *p *= 2f64.powi(exponent));
        run(&Connected::new(mesh).unwrap(), &curves).unwrap()
    };
    for exponent in [-100, -30, 30, 100] {
        let other = scaled(exponent);
        assert_eq!((&other.mesh.faces, &other.curves), (&out.mesh.faces, &out.curves));
        for (p, q) in out.mesh.positions.iter().zip(&other.mesh.positions) {
            assert_eq!(*p * 2f64.powi(exponent), *q);
        }
    }
    for exponent in [-1000, 1000] {
        let other = scaled(exponent);
        assert_eq!((other.mesh.faces.len(), &other.curves), (out.mesh.faces.len(), &out.curves));
        assert!(other.flattened.is_empty());
    }
}

/// A face without area between two sound ones: the curve passes, and the face is reported.
#[test]
fn flat_faces_are_crossed() {
    let mut mesh = shapes::cuboid(DVec3::ONE);
    let cube = Connected::new(mesh.clone()).unwrap();
    let h = cube.face_ids().map(|f| HalfedgeId::new(f, 0)).find(|&h| {
        let [a, b] = cube.ends(h);
        (a - b).abs().element_sum() == 1.0
    });
    let h = h.unwrap();
    // The edge's middle, exact in f64, is put on one side of the edge only.
    let (a, b, c) = (cube.tail(h), cube.head(h), cube.head(h.next()));
    let middle = VertexId::from(mesh.positions.len());
    mesh.positions.push(0.5 * (cube.position(a) + cube.position(b)));
    mesh.faces[h.face().index()] = [a, middle, c];
    mesh.faces.extend([[middle, b, c], [a, b, middle]]);
    let flat = FaceId::from(mesh.faces.len() - 1);
    let mesh = Connected::new(mesh).unwrap();
    let side = HalfedgeId::new(flat, 0);
    let beyond = mesh.twin(side).unwrap().face();
    let points = vec![
        SurfacePoint::Face { face: beyond, barycentric: [0.4, 0.3, 0.3] },
        SurfacePoint::Edge { halfedge: side, t: 0.3 },
        SurfacePoint::Edge { halfedge: HalfedgeId::new(h.face(), 0), t: 0.6 },
        SurfacePoint::Face { face: h.face(), barycentric: [0.4, 0.3, 0.3] },
    ];
    let out = run(&mesh, &[SurfaceCurve { points, closed: false }]).unwrap();
    let cut = Connected::new(out.mesh.clone()).unwrap();
    assert_eq!(out.flattened, [flat]);
    assert_eq!(out.curves[0].len(), 4);
    assert_eq!(cut.face_count() - mesh.face_count(), 2 * (cut.vertex_count() - mesh.vertex_count()));
    assert!((area(cut.mesh()) - 6.0).abs() < 1e-12);
}

/// Nothing moves farther than the reach, however large the triangles; twice, where an edge leads on to a vertex.
#[test]
fn reach_caps_every_move() {
    let mesh = bumpy(1, 0.03);
    let curves = [circle(&mesh, DVec3::new(0.1, 0.5, 0.8).normalize(), 1.0, 0.1, 500)];
    let far = |params: EmbedParams| {
        let out = embed(&mesh, &curves, &params, &Watch::default()).unwrap();
        let moved = curves[0].points.iter().zip(&out.places[0]);
        let moved = moved.map(|(p, &k)| p.position(&mesh).distance(out.mesh.positions[out.curves[0][k].index()]));
        moved.fold(0.0, f64::max)
    };
    assert!(far(EmbedParams { snap: 0.1, ..EmbedParams::default() }) > 0.02);
    assert!(far(EmbedParams { snap: 0.1, reach: 1e-3 }) <= 4e-3);
}

#[test]
fn bad_input_is_named() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let open = |points: Vec<SurfacePoint>| [SurfaceCurve { points, closed: false }];
    let (a, b) = (SurfacePoint::Vertex(VertexId(0)), SurfacePoint::Vertex(VertexId(7)));
    assert!(matches!(run(&mesh, &open(vec![a, b])), Err(EmbedError::Apart { curve: 0, point: 0, .. })));
    for bad in [
        SurfacePoint::Vertex(VertexId(99)),
        SurfacePoint::Edge { halfedge: HalfedgeId(36), t: 0.5 },
        SurfacePoint::Edge { halfedge: HalfedgeId(0), t: f64::NAN },
        SurfacePoint::Edge { halfedge: HalfedgeId(0), t: 1.5 },
        SurfacePoint::Face { face: FaceId(0), barycentric: [0.5, 0.9, -0.4] },
        SurfacePoint::Face { face: FaceId(u32::MAX), barycentric: [0.5, 0.5, 0.0] },
    ] {
        assert_eq!(run(&mesh, &open(vec![a, bad])).unwrap_err(), EmbedError::BadPoint { curve: 0, point: 1 });
    }
    assert_eq!(run(&mesh, &open(vec![a, a])).unwrap_err(), EmbedError::Collapsed { curve: 0 });
    assert_eq!(run(&mesh, &open(vec![])).unwrap_err(), EmbedError::Collapsed { curve: 0 });
    assert_eq!(run(&mesh, &[]).unwrap().mesh, *mesh.mesh());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Nested wavy circles at any pose and density, near enough to share faces.
    #[test]
    fn nested_curves_conserve_everything(
        axis in prop::array::uniform3(-1.0..1.0f64),
        polar in 0.1..2.9f64,
        gap in 0.005..0.1f64,
        wave in 0.0..0.3f64,
        samples in 12usize..300,
        levels in 1u32..4,
        depth in 0.0..0.06f64,
    ) {
        let axis = DVec3::from(axis);
        prop_assume!(axis.length() > 0.1);
        let mesh = bumpy(levels, depth);
        let wave = wave * polar.min(3.0 - polar);
        let curves = [0.0, gap].map(|g| circle(&mesh, axis.normalize(), polar + g, wave, samples));
        match run(&mesh, &curves) {
            Ok(out) => {
                let cut = check(&mesh, &curves, &out);
                left_part(&cut, &out);
                let again = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| run(&mesh, &curves)).unwrap();
                prop_assert_eq!(again.mesh, out.mesh);
            }
            // Coarsely sampled curves do cross.
            Err(EmbedError::Crossings(_)) => {}
            Err(e) => return Err(TestCaseError::fail(e.to_string())),
        }
    }
}
