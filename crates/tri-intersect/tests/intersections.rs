//! Triangle tests and curves against independent truth.

use glam::DVec3;
use mesh_core::{Connected, FaceId, Faces, TriMesh, Watch, shapes};
use proptest::prelude::*;
use tri_intersect::{intersection_curves, self_intersections, self_intersections_among, triangles_intersect};

type I3 = [i64; 3];

fn sub(a: I3, b: I3) -> I3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: I3, b: I3) -> I3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Closed convex sets in whole numbers are disjoint exactly if one of these axes separates them strictly.
fn separated(p: [I3; 3], q: [I3; 3]) -> bool {
    let edges = |t: [I3; 3]| [sub(t[1], t[0]), sub(t[2], t[1]), sub(t[0], t[2])];
    let normal = |t: [I3; 3]| cross(sub(t[1], t[0]), sub(t[2], t[0]));
    let mut axes = vec![normal(p), normal(q)];
    for e in edges(p) {
        axes.push(cross(normal(p), e));
        axes.extend(edges(q).map(|f| cross(e, f)));
    }
    axes.extend(edges(q).map(|f| cross(normal(q), f)));
    let span = |t: [I3; 3], n: I3| {
        let d = t.map(|v| v[0] * n[0] + v[1] * n[1] + v[2] * n[2]);
        (d.into_iter().min(), d.into_iter().max())
    };
    axes.into_iter().any(|n| {
        let ((a, b), (c, d)) = (span(p, n), span(q, n));
        n != [0; 3] && (b < c || d < a)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn triangles_meet_unless_an_axis_separates_them(c in proptest::collection::vec(-3i64..=3, 18), flat in any::<bool>()) {
        let point = |i: usize| [c[3 * i], c[3 * i + 1], if flat { 0 } else { c[3 * i + 2] }];
        let (p, q) = ([point(0), point(1), point(2)], [point(3), point(4), point(5)]);
        let area = |t: [I3; 3]| cross(sub(t[1], t[0]), sub(t[2], t[0])) != [0; 3];
        prop_assume!(area(p) && area(q));
        let f = |t: [I3; 3]| t.map(|v| DVec3::new(v[0] as f64, v[1] as f64, v[2] as f64));
        prop_assert_eq!(triangles_intersect(f(p), f(q)), !separated(p, q));
        prop_assert_eq!(triangles_intersect(f(q), f(p)), !separated(p, q));
        // The same far from the origin's scale.
        let tiny = |t: [I3; 3]| f(t).map(|v| v * 1e-200);
        prop_assert_eq!(triangles_intersect(tiny(p), tiny(q)), !separated(p, q));
    }
}

/// Two spheres in one mesh: exactly the crossing faces are listed, as brute force over triangle pairs finds them.
#[test]
fn self_intersections_match_brute_force() {
    let mut mesh = shapes::icosphere(1.0, 2);
    let other = shapes::icosphere(0.9, 2);
    let n = mesh.positions.len() as u32;
    mesh.positions.extend(other.positions.iter().map(|p| *p + DVec3::new(0.4, 0.3, 0.2)));
    mesh.faces.extend(other.faces.iter().map(|f| f.map(|v| mesh_core::VertexId(v.0 + n))));
    let found = self_intersections(&mesh, &Watch::default()).unwrap();
    let half = mesh.faces.len() as u32 / 2;
    let mut brute = vec![];
    for f in 0..half {
        for g in half..2 * half {
            let pair = [FaceId(f), FaceId(g)];
            if triangles_intersect(mesh.triangle(pair[0]), mesh.triangle(pair[1])) {
                brute.push(pair);
            }
        }
    }
    assert_eq!(found, brute);
    assert!(found.len() > 50);
    let some: Vec<FaceId> = mesh.face_ids().filter(|f| f.0 % 7 == 0).collect();
    let among = self_intersections_among(&mesh, &some, &Watch::default()).unwrap();
    let expected: Vec<_> = found.iter().copied().filter(|p| p.iter().any(|f| f.0 % 7 == 0)).collect();
    assert_eq!(among, expected);
}

/// Faces that share an edge or a corner and still overlap, and faces without area.
#[test]
fn folds_needles_and_duplicates_are_found() {
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let points = vec![
        p(0., 0., 0.),
        p(1., 0., 0.),
        p(0., 1., 0.),
        p(1., 1., 0.),
        p(0.5, 0., 0.),
        p(0.3, 0.3, 1.0),
        p(0.2, 0.2, -1.0),
    ];
    let found = |faces: &[[u32; 3]]| {
        let mesh = TriMesh::from_arrays(points.clone(), faces.iter().copied());
        self_intersections(&mesh, &Watch::default()).unwrap().iter().map(|f| f.map(|f| f.0)).collect::<Vec<_>>()
    };
    assert_eq!(found(&[[0, 1, 2], [1, 0, 3]]), [[0, 1]]); // folded over a common edge
    assert_eq!(found(&[[0, 1, 2], [1, 3, 2]]), [[0u32; 2]; 0]); // flat side by side
    assert_eq!(found(&[[0, 1, 2], [0, 5, 6]]), [[0, 1]]); // pierced, sharing a corner
    assert_eq!(found(&[[0, 1, 4]]), [[0, 0]]); // no area
    assert_eq!(found(&[[0, 1, 2], [0, 1, 2]]), [[0, 1]]);
}

/// Two spheres cross in a circle; a sphere and an open sheet likewise; a sheet that ends inside gives an open curve.
#[test]
fn curves_of_spheres_and_sheets() {
    let connect = |m: TriMesh| Connected::new(m).unwrap();
    let ball = connect(shapes::icosphere(1.0, 3));
    let mut other = shapes::icosphere(1.0, 3);
    other.positions.iter_mut().for_each(|p| *p += DVec3::new(1.0, 0.001, 0.002));
    let other = connect(other);
    let curves = intersection_curves(&ball, &other, &Watch::default()).unwrap();
    assert_eq!(curves.len(), 1);
    assert!(curves[0].closed);
    let radius = |p: DVec3| p.y.hypot(p.z);
    for c in &curves[0].points {
        assert!((c.position.x - 0.5).abs() < 0.02 && (radius(c.position) - 0.75f64.sqrt()).abs() < 0.02);
        assert!(c.on_a.position(&ball).distance(c.position) < 1e-14);
        assert!(c.on_b.position(&other).distance(c.position) < 1e-14);
    }
    let sheet = |end: f64| {
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.1);
        connect(TriMesh::from_arrays(vec![p(-2., -2.), p(end, -2.), p(end, 2.), p(-2., 2.)], [[0, 1, 2], [0, 2, 3]]))
    };
    let whole = intersection_curves(&ball, &sheet(2.0), &Watch::default()).unwrap();
    assert_eq!((whole.len(), whole[0].closed), (1, true));
    let part = intersection_curves(&ball, &sheet(0.3), &Watch::default()).unwrap();
    assert_eq!((part.len(), part[0].closed), (1, false));
    let ends = [part[0].points.first(), part[0].points.last()].map(|p| p.unwrap().position);
    assert!(ends.iter().all(|p| (p.x - 0.3).abs() < 1e-15));
}
