//! Maps held against formulas, against slower twins, and against themselves.

use glam::{DQuat, DVec2, DVec3};
use mesh_core::{
    Adjacency, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, VertexId, boundary_loops, shapes,
};
use mesh_operators::{cotangent_weight, cotangents};
use param_conformal::{
    CutRing, Distortion, Error, Harmonic, Outline, RelaxParams, Ring, RingMap, Seam, Weights, map_fixed, map_free,
    map_ring, map_ring_with, relax,
};
use proptest::prelude::*;
use std::f64::consts::TAU;

type Mesh = Connected<TriMesh>;

fn connected(mesh: TriMesh) -> Mesh {
    Connected::new(mesh).unwrap()
}

/// A flat annulus of the radii 1 and `outer`, rings at even ratios shifted by `warp`.
fn annulus(outer: f64, segments: u32, rows: u32, warp: f64) -> Mesh {
    let mut mesh = shapes::open_cylinder(1.0, 1.0, segments, rows);
    for p in &mut mesh.positions {
        let s = p.z + 0.5;
        let r = outer.powf(s + warp * s * (1.0 - s));
        *p = DVec3::new(r * p.x, r * p.y, 0.0);
    }
    connected(mesh)
}

/// Cut from the bottom's k-th vertex to the top's nearest, the bottom being the loop that `below` holds of.
fn opened(mesh: &Mesh, k: usize, below: impl Fn(DVec3) -> bool) -> CutRing {
    let mut ring = Ring::new(mesh).unwrap();
    if !below(mesh.position(mesh.tail(ring.loops()[0][0]))) {
        ring = ring.turned();
    }
    let from = mesh.tail(ring.loops()[0][k % ring.loops()[0].len()]);
    let gap = |v: VertexId| mesh.position(v).distance(mesh.position(from));
    let to = ring.loops()[1].iter().map(|&h| mesh.tail(h)).min_by(|&a, &b| gap(a).total_cmp(&gap(b))).unwrap();
    ring.cut(mesh, ring.seam(mesh, from, to).unwrap()).unwrap()
}

/// How far two periodic maps are apart at the worst vertex.
fn apart(mesh: &Mesh, a: &RingMap, b: &RingMap, shift: f64) -> f64 {
    let gap = |v: VertexId| {
        let d = a.points[v] - b.points[v] - DVec2::new(shift, 0.0);
        let turns = (d.x / a.period).round();
        DVec2::new(d.x - turns * a.period, d.y).length()
    };
    mesh.vertex_ids().map(gap).fold(0.0, f64::max)
}

/// A flat annulus is mapped by the logarithm. With boundary values taken from it, the error falls as the square of the
/// edge length.
#[test]
fn a_flat_annulus_maps_by_the_logarithm() {
    let outer = 5.0f64;
    let error = |n: u32| {
        let mesh = annulus(outer, 4 * n, n, 0.4);
        let cut = opened(&mesh, 3, |p| p.length() < 2.0);
        // A tube made flat by spreading its top has its normals down, so that angles rise with the surface on the left.
        let angle = |v: VertexId| mesh.position(v).y.atan2(mesh.position(v).x);
        let from = angle(cut.bottom()[0]);
        let rising = |chain: &[VertexId]| chain.iter().map(|&v| (angle(v) - from + 1e-9).rem_euclid(TAU)).collect();
        let outline = Outline { bottom: rising(cut.bottom()), top: rising(cut.top()), period: TAU, height: outer.ln() };
        let map = map_ring(&mesh, &cut, &outline, Seam::Periodic).unwrap();
        let distortion = map.distortion(&mesh);
        assert!(distortion.angle_mean < 1.0 + 4.0 / f64::from(n), "{distortion:?}");
        let gap = |v: VertexId| {
            let truth = DVec2::new((angle(v) - from + 1e-9).rem_euclid(TAU), mesh.position(v).length().ln());
            let d = map.points[v] - truth;
            DVec2::new(d.x - (d.x / TAU).round() * TAU, d.y).length()
        };
        mesh.vertex_ids().map(gap).fold(0.0, f64::max)
    };
    let errors = [8, 16, 32].map(error);
    assert!(errors[0] < 0.05 && errors[0] / errors[1] > 3.4 && errors[1] / errors[2] > 3.4, "{errors:?}");
}

/// Where the seam runs, and whether it is straight on a symmetric ring, makes no difference.
#[test]
fn the_periodic_map_knows_no_seam() {
    let mesh = annulus(3.0, 24, 9, 0.3);
    let rows = |cut: &CutRing| {
        let angle = |v: &VertexId| (mesh.position(*v).y.atan2(mesh.position(*v).x) + 1e-9).rem_euclid(TAU);
        let base = angle(&cut.bottom()[0]);
        let rise = |chain: &[VertexId]| -> Vec<f64> {
            chain.iter().map(|v| base + (angle(v) - base + 1e-6).rem_euclid(TAU)).collect()
        };
        Outline { bottom: rise(cut.bottom()), top: rise(cut.top()), period: TAU, height: 1.0 }
    };
    let maps: Vec<RingMap> = [0, 7, 19]
        .map(|k| opened(&mesh, k, |p| p.length() < 2.0))
        .iter()
        .map(|cut| map_ring(&mesh, cut, &rows(cut), Seam::Periodic).unwrap())
        .collect();
    assert!(apart(&mesh, &maps[0], &maps[1], 0.0) < 1e-12 && apart(&mesh, &maps[0], &maps[2], 0.0) < 1e-12);
}

/// A tube is developable: its map is an isometry for either treatment of the seam, and for the free map once cut.
#[test]
fn tubes_unroll() {
    let mesh = connected(shapes::open_cylinder(1.0, 2.0, 24, 6));
    let cut = opened(&mesh, 5, |p| p.z < 0.0);
    let outline = Outline::by_length(&mesh, &cut, 2.0);
    for seam in [Seam::Periodic, Seam::Straight] {
        let map = map_ring(&mesh, &cut, &outline, seam).unwrap();
        for f in mesh.face_ids() {
            let (p, q) = (mesh.triangle(f), map.corners(&mesh, f));
            for k in 0..3 {
                let (a, b) = (p[k].distance(p[(k + 1) % 3]), q[k].distance(q[(k + 1) % 3]));
                assert!((a - b).abs() < 1e-12, "{seam:?}: {a} {b}");
            }
        }
    }
    let half = TriMesh {
        faces: mesh.mesh().faces.iter().copied().filter(|c| c.iter().all(|&v| mesh.position(v).y > -0.1)).collect(),
        ..mesh.mesh().clone()
    };
    let half = connected(half);
    let map = map_free(&half).unwrap();
    for f in half.face_ids() {
        let (p, q) = (half.triangle(f), half.corners(f).map(|v| map[v]));
        assert!((0..3).all(|k| (p[k].distance(p[(k + 1) % 3]) - q[k].distance(q[(k + 1) % 3])).abs() < 1e-7));
    }
}

/// A cap of a ball has one conformal map up to similarity, the stereographic one; the free map tends to it.
#[test]
fn a_cap_unfolds_stereographically() {
    let error = |n: u32| {
        let ball = shapes::uv_sphere(1.0, 4 * n, 2 * n);
        let faces = ball.faces.iter().copied().filter(|c| c.iter().all(|&v| ball.positions[v.index()].z > -1e-9));
        let cap = connected(TriMesh { faces: faces.collect(), ..ball.clone() });
        let map = map_free(&cap).unwrap();
        let used: Vec<VertexId> = cap.vertex_ids().filter(|&v| cap.outgoing(v).is_some()).collect();
        let truth = |v: VertexId| {
            let p = cap.position(v);
            p.truncate() / (1.0 + p.z)
        };
        // The best similarity between the two, in complex numbers.
        let n = used.len() as f64;
        let (ma, mb) =
            (used.iter().map(|&v| map[v]).sum::<DVec2>() / n, used.iter().map(|&v| truth(v)).sum::<DVec2>() / n);
        let conj = |p: DVec2| DVec2::new(p.x, -p.y);
        let (mut top, mut bottom) = (DVec2::ZERO, 0.0);
        for &v in &used {
            top += conj(map[v] - ma).rotate(truth(v) - mb);
            bottom += (map[v] - ma).length_squared();
        }
        let turn = top / bottom;
        used.iter().map(|&v| (turn.rotate(map[v] - ma) - (truth(v) - mb)).length()).fold(0.0, f64::max)
    };
    let errors = [4, 8, 16].map(error);
    assert!(errors[0] < 0.1 && errors[0] / errors[1] > 2.5 && errors[1] / errors[2] > 3.0, "{errors:?}");
}

/// Against plain Gauss–Seidel on the same equations, and K columns against K single ones.
#[test]
fn the_factor_solves_what_iteration_solves() {
    let blob = shapes::blob(1.0, 3, 0.5, 7);
    let faces = blob.faces.iter().copied().filter(|c| c.iter().all(|&v| blob.positions[v.index()].z > -0.3));
    let mesh = connected(TriMesh { faces: faces.collect(), ..blob.clone() });
    let rim: Vec<VertexId> = boundary_loops(&mesh)[0].iter().map(|&h| mesh.tail(h)).collect();
    let solver = Harmonic::new(&mesh, &rim).unwrap();
    let values: Vec<[f64; 2]> = (0..rim.len()).map(|i| [(i as f64).sin(), (i as f64 * 0.7).cos()]).collect();
    let both = solver.solve(&values);
    for c in 0..2 {
        let one = solver.solve(&values.iter().map(|v| [v[c]]).collect::<Vec<_>>());
        assert!(mesh.vertex_ids().all(|v| one[v][0] == both[v][c]));
    }
    let cot = cotangents(&mesh);
    let mut x: Vec<f64> = both.as_slice().iter().map(|_| 0.0).collect();
    rim.iter().zip(&values).for_each(|(v, value)| x[v.index()] = value[0]);
    let inner: Vec<VertexId> =
        mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_some_and(|h| mesh.twin(h).is_some())).collect();
    for _ in 0..4000 {
        for &v in &inner {
            let (mut sum, mut total) = (0.0, 0.0);
            for h in mesh.ring(v) {
                let w = cotangent_weight(&mesh, &cot, h);
                sum += w * x[mesh.head(h).index()];
                total += w;
            }
            x[v.index()] = sum / total;
        }
    }
    assert!(inner.iter().all(|&v| (x[v.index()] - both[v][0]).abs() < 1e-10));
}

#[test]
fn threads_do_not_change_bits() {
    let mesh = annulus(4.0, 96, 40, 0.2);
    let cut = opened(&mesh, 0, |p| p.length() < 2.0);
    let outline = Outline::by_length(&mesh, &cut, 1.0);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| map_ring(&mesh, &cut, &outline, Seam::Periodic).unwrap())
    };
    assert_eq!(on(1), on(4));
}

#[test]
fn smoothing_evens_triangles_and_turns_none() {
    // A ring whose rows bunch up at the bottom, laid onto a straight tube.
    let mesh = annulus(6.0, 40, 12, 0.9);
    let cut = opened(&mesh, 0, |p| p.length() < 2.0);
    let mut map = map_ring(&mesh, &cut, &Outline::by_length(&mesh, &cut, 12.0), Seam::Periodic).unwrap();
    let period = map.period;
    let tube = |p: DVec2| {
        let (sin, cos) = (TAU * p.x / period).sin_cos();
        DVec3::new(6.0 * cos, 6.0 * sin, p.y)
    };
    let smallest = |map: &RingMap| {
        let least = |f| {
            let p = map.corners(&mesh, f).map(tube);
            let turn = |k: usize| (p[(k + 1) % 3] - p[k]).angle_between(p[(k + 2) % 3] - p[k]);
            (0..3).map(turn).fold(TAU, f64::min)
        };
        mesh.face_ids().map(least).fold(TAU, f64::min)
    };
    let mut smooth = map.clone();
    relax(&mesh, &mut smooth, tube, &RelaxParams::default());
    assert!(smooth.distortion(&mesh).flipped.is_empty());
    assert!(smallest(&smooth) > 1.1 * smallest(&map), "{} {}", smallest(&smooth), smallest(&map));
    // A vertex thrown across its neighbours is brought back.
    let v = mesh.vertex_ids().find(|&v| mesh.ring(v).all(|h| mesh.ring(mesh.head(h)).count() == 6)).unwrap();
    map.points[v] += DVec2::new(3.0, 1.0);
    assert!(!map.distortion(&mesh).flipped.is_empty());
    relax(&mesh, &mut map, tube, &RelaxParams::default());
    assert!(map.distortion(&mesh).flipped.is_empty());
}

#[test]
fn refusals_name_the_place() {
    let ball = connected(shapes::icosphere(1.0, 2));
    assert!(matches!(Ring::new(&ball), Err(Error::NotARing { loops: 0, pieces: 1, characteristic: 2 })));
    assert!(matches!(map_free(&ball), Err(Error::NotADisc { loops: 0, .. })));
    assert!(matches!(Harmonic::new(&ball, &[]), Err(Error::Loose { vertex: VertexId(0), .. })));
    // A corner triangle whose two outer edges come to lie on one side is flat.
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    let pair = connected(TriMesh::from_arrays(square.to_vec(), [[0, 1, 2], [0, 2, 3]]));
    let flat = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1.0)];
    let outline: Vec<_> = (0..4).map(|i| (VertexId(i), DVec2::from(flat[i as usize]))).collect();
    let refused = map_fixed(&pair, &outline, Weights::Uniform);
    assert!(matches!(refused, Err(Error::Flipped { pinned: true, face: FaceId(0), count: 1, .. })), "{refused:?}");
    let tube = connected(shapes::open_cylinder(1.0, 2.0, 12, 3));
    let ring = Ring::new(&tube).unwrap();
    let from = tube.tail(ring.loops()[0][0]);
    assert!(matches!(ring.seam(&tube, from, from), Err(Error::NoSeam { .. })));
    assert!(matches!(ring.cut(&tube, vec![]), Err(Error::BadSeam { step: 0 })));
    let cut = opened(&tube, 0, |p| p.z < 0.0);
    let mut outline = Outline::by_length(&tube, &cut, 1.0);
    outline.top.swap(4, 5);
    let refused = map_ring(&tube, &cut, &outline, Seam::Periodic);
    assert_eq!(refused, Err(Error::Outline { expected: 12, given: 12, index: 5 }));
    let mut wild = tube.mesh().clone();
    wild.positions[7] = DVec3::new(f64::NAN, 0.0, 0.0);
    assert!(matches!(
        Harmonic::new(&connected(wild), &[VertexId(0)]),
        Err(Error::NotFinite { vertex: VertexId(7), .. })
    ));
}

/// A flat grid with its inner vertices moved about, triangles still upright: by a quarter of an edge they might not be.
fn jittered(jitter: &[(f64, f64)]) -> Mesh {
    let mut mesh = shapes::grid(8.0, 8.0, 8, 8);
    for (p, j) in mesh.positions.iter_mut().zip(jitter) {
        if p.x.abs() < 3.9 && p.y.abs() < 3.9 {
            *p += DVec3::new(0.2 * j.0, 0.2 * j.1, 0.0);
        }
    }
    connected(mesh)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Affine boundary values give the affine map, which reverses nothing and measures as what it is.
    #[test]
    fn affine_maps_are_reproduced(
        jitter in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 81),
        m in prop::array::uniform4(-2.0f64..2.0),
        b in prop::array::uniform2(-9.0f64..9.0),
    ) {
        let mesh = jittered(&jitter);
        let affine = |v: VertexId| {
            let p = mesh.position(v).truncate();
            DVec2::new(m[0] * p.x + m[1] * p.y + b[0], m[2] * p.x + m[3] * p.y + b[1])
        };
        let rim: Vec<_> = boundary_loops(&mesh)[0].iter().map(|&h| mesh.tail(h)).map(|v| (v, affine(v))).collect();
        let det = m[0] * m[3] - m[1] * m[2];
        prop_assume!(det.abs() > 1e-3);
        match map_fixed(&mesh, &rim, Weights::Cotangent) {
            Ok(map) => {
                prop_assert!(det > 0.0);
                prop_assert!(mesh.vertex_ids().all(|v| (map[v] - affine(v)).length() < 1e-10));
                let found = Distortion::of(&mesh, |f| mesh.corners(f).map(|v| map[v]));
                let sum: f64 = m.iter().map(|x| x * x).sum();
                let ratio = ((sum + 2.0 * det).sqrt() + (sum - 2.0 * det).max(0.0).sqrt()).powi(2) / (4.0 * det);
                prop_assert!((found.angle_max / ratio - 1.0).abs() < 1e-6 && (found.angle_mean / ratio - 1.0).abs() < 1e-6);
                prop_assert!((found.area_max - 1.0).abs() < 1e-9);
            }
            Err(Error::Flipped { count, pinned: false, .. }) => {
                prop_assert!(det < 0.0);
                prop_assert_eq!(count, mesh.face_count());
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }

    /// What is flat, wherever it lies, is laid down as it is.
    #[test]
    fn flat_discs_keep_their_lengths(
        jitter in prop::collection::vec((-1.0f64..1.0, -1.0f64..1.0), 81),
        turn in prop::array::uniform3(-3.0f64..3.0),
        scale in 0.01f64..100.0,
    ) {
        let mut posed = jittered(&jitter).into_mesh();
        posed.positions.iter_mut().for_each(|p| *p = scale * (DQuat::from_scaled_axis(turn.into()) * *p + DVec3::ONE));
        let mesh = connected(posed);
        let map = map_free(&mesh).unwrap();
        for h in mesh.face_ids().flat_map(|f| [0, 1, 2].map(|k| HalfedgeId::new(f, k))) {
            let mapped = map[mesh.tail(h)].distance(map[mesh.head(h)]);
            prop_assert!((mapped / mesh.edge_length(h) - 1.0).abs() < 1e-6, "{mapped} {}", mesh.edge_length(h));
        }
    }

    /// Whatever the shape of the triangles, the uniform map of a ring turns none over.
    #[test]
    fn uniform_maps_never_flip(bumps in prop::collection::vec(-0.9f64..3.0, 10 * 6), k in 0usize..10) {
        let mut mesh = shapes::open_cylinder(1.0, 2.0, 10, 5);
        for (p, bump) in mesh.positions.iter_mut().zip(&bumps) {
            *p += *bump * DVec3::new(p.x, p.y, 0.3 * bump);
        }
        let mesh = connected(mesh);
        let cut = opened(&mesh, k, |_| true);
        let map = map_ring_with(&mesh, &cut, &Outline::by_length(&mesh, &cut, 1.0), Seam::Periodic, Weights::Uniform);
        prop_assert!(map.is_ok(), "{:?}", map.err());
    }
}
