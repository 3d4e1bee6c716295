//! Isotropic remeshing against shapes whose truth is known, and its promises on random surfaces.

use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, EditObserver, FaceOrigin, Faces, TriMesh, VertexId, VertexMap, VertexOrigin, Watch, area,
    bounds, dihedral_angle, shapes, topology, volume,
};
use proptest::prelude::*;
use remesh::{Error, Frozen, Params, Projection, Remeshed, Sizing, graded_sizes, remesh, remesh_observed};

fn run(mesh: &TriMesh, params: &Params) -> Remeshed {
    let mesh = Connected::new(mesh).unwrap();
    remesh(&mesh, &Frozen::default(), Sizing::Uniform, params, Projection::Input, &Watch::default()).unwrap()
}

/// 2√3 r/l of each triangle, r its inscribed radius and l its longest side: 1 when equilateral.
fn qualities(mesh: &TriMesh) -> Vec<f64> {
    let quality = |[a, b, c]: [DVec3; 3]| {
        let (x, y, z) = (a.distance(b), b.distance(c), c.distance(a));
        let inradius = (b - a).cross(c - a).length() / (x + y + z);
        2.0 * 3f64.sqrt() * inradius / x.max(y).max(z)
    };
    mesh.face_ids().map(|f| quality(mesh.triangle(f))).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn a_sphere_stays_within_its_sagitta_and_is_evenly_covered() {
    let ball = shapes::blob(1.0, 4, 0.0, 1);
    for length in [0.06, 0.12, 0.25] {
        let fine = run(&ball, &Params::new(length));
        let mesh = Connected::new(&fine.mesh).unwrap();
        assert_eq!(topology(&mesh).genus(), 0);
        let quality = qualities(&fine.mesh);
        assert!(mean(&quality) > 0.89, "{length}: {}", mean(&quality));
        assert!(quality.iter().all(|&q| q > 0.3), "{length}");
        // Every vertex is on the input, whose facets lie below the sphere by their own sagitta.
        let depth = fine.mesh.positions.iter().map(|p| 1.0 - p.length()).fold(0.0, f64::max);
        assert!(depth < 2e-3, "{length}: {depth}");
        let expected = 4.0 * std::f64::consts::PI / (3f64.sqrt() / 4.0 * length * length);
        let count = fine.mesh.faces.len() as f64 / expected;
        assert!((0.75..1.3).contains(&count), "{length}: {count}");
        let six = mesh.vertex_ids().filter(|&v| mesh.ring(v).count() == 6).count();
        assert!(six * 10 > 7 * mesh.vertex_count(), "{length}: {six} of {}", mesh.vertex_count());
    }
}

#[test]
fn a_box_keeps_its_edges_and_corners_exactly() {
    let size = DVec3::new(1.0, 2.0, 0.5);
    let cuboid = shapes::cuboid(size);
    let fine = run(&cuboid, &Params::new(0.09));
    let mesh = Connected::new(&fine.mesh).unwrap();
    assert!((volume(&fine.mesh) - volume(&cuboid)).abs() < 1e-12);
    assert!((area(&fine.mesh) - area(&cuboid)).abs() < 1e-12);
    let sharp: f64 = mesh
        .halfedge_ids()
        .filter(|&h| dihedral_angle(&mesh, h).unwrap().abs() > 1.0)
        .map(|h| fine.mesh.positions[mesh.tail(h).index()].distance(fine.mesh.positions[mesh.head(h).index()]))
        .sum();
    assert!((sharp - 2.0 * 4.0 * (1.0 + 2.0 + 0.5)).abs() < 1e-12, "{sharp}");
    assert!(cuboid.positions.iter().all(|p| fine.mesh.positions.contains(p)));
    assert!(mean(&qualities(&fine.mesh)) > 0.85);
}

#[test]
fn the_boundary_and_what_is_frozen_keep_their_bits() {
    let tube = shapes::open_cylinder(1.0, 3.0, 40, 12);
    let mesh = Connected::new(&tube).unwrap();
    let low = |f| tube.triangle(f).iter().all(|p| p.z < 0.0);
    let frozen = Frozen { faces: mesh.face_ids().map(low).collect::<Vec<_>>().into(), ..Frozen::default() };
    let params = Params::new(0.12);
    let fine = remesh(&mesh, &frozen, Sizing::Uniform, &params, Projection::Input, &Watch::default()).unwrap();
    let out = Connected::new(&fine.mesh).unwrap();
    assert_eq!(topology(&out).boundary_loops, 2);
    let kept = fine.origins.faces.as_slice().iter().filter_map(|o| match o {
        FaceOrigin::Input { face, .. } => Some(*face),
        _ => None,
    });
    let kept: std::collections::BTreeSet<_> = kept.collect();
    assert!(mesh.face_ids().filter(|&f| low(f)).all(|f| kept.contains(&f)));
    for v in mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_none_or(|h| mesh.twin(h).is_none())) {
        assert!(fine.mesh.positions.contains(&tube.positions[v.index()]));
    }
    for (f, origin) in fine.mesh.face_ids().zip(fine.origins.faces.as_slice()) {
        if let FaceOrigin::Input { face, .. } = origin {
            assert_eq!(fine.mesh.triangle(f), tube.triangle(*face));
        }
    }
}

#[test]
fn origins_find_every_vertex_on_the_input() {
    let blob = shapes::blob(1.0, 3, 0.4, 3);
    let fine = run(&blob, &Params { feature_angle: 180.0, ..Params::new(0.2) });
    for (p, origin) in fine.mesh.positions.iter().zip(fine.origins.vertices.as_slice()) {
        let place = origin.position(std::slice::from_ref(&blob)).unwrap();
        assert!(p.distance(place) < 1e-12, "{origin:?}");
    }
}

#[test]
fn a_field_takes_vertices_onto_its_zero_set() {
    let coarse = shapes::icosphere(1.0, 2);
    let mesh = Connected::new(&coarse).unwrap();
    let onto = |points: &mut [DVec3]| points.iter_mut().for_each(|p| *p = p.normalize());
    let params = Params { feature_angle: 180.0, ..Params::new(0.1) };
    let fine = remesh(&mesh, &Frozen::default(), Sizing::Uniform, &params, Projection::Field(&onto), &Watch::default())
        .unwrap();
    assert!(fine.mesh.positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-15));
    assert!(mean(&qualities(&fine.mesh)) > 0.9);
}

#[test]
fn graded_sizes_join_a_fine_boundary_to_a_coarse_one() {
    // A disc with a fine hole: ring k of the cone below has edges in proportion to its radius.
    let mut ring = shapes::open_cylinder(1.0, 1.0, 96, 6);
    for p in &mut ring.positions {
        let radius = 1.0 + 8.0 * (p.z + 0.5);
        *p = DVec3::new(p.x * radius, p.y * radius, 0.0);
    }
    let mesh = Connected::new(&ring).unwrap();
    let sizes = graded_sizes(&mesh, 0.3, 0.3).unwrap();
    for v in mesh.vertex_ids() {
        for h in mesh.ring(v) {
            let far = ring.positions[v.index()].distance(ring.positions[mesh.head(h).index()]);
            assert!((sizes[v] - sizes[mesh.head(h)]).abs() <= 0.3 * far + 1e-12);
        }
    }
    let params = Params::new(0.3);
    let fine =
        remesh(&mesh, &Frozen::default(), Sizing::PerVertex(&sizes), &params, Projection::Input, &Watch::default());
    assert!(mean(&qualities(&fine.unwrap().mesh)) > 0.88);
}

/// Counts edits and forbids those that touch one vertex.
#[derive(Default)]
struct Tally {
    splits: usize,
    collapses: usize,
    flips: usize,
}

impl EditObserver for Tally {
    fn may_edit(&self, a: VertexId, b: VertexId) -> bool {
        a != VertexId(5) && b != VertexId(5)
    }
    fn split(&mut self, a: VertexId, b: VertexId, t: f64, _: VertexId) {
        assert!(a != b && t == 0.5);
        self.splits += 1;
    }
    fn collapse(&mut self, gone: VertexId, kept: VertexId) {
        assert!(gone != kept && gone != VertexId(5));
        self.collapses += 1;
    }
    fn flip(&mut self, a: VertexId, b: VertexId, c: VertexId, d: VertexId) {
        assert!(a != b && c != d && c != VertexId(5));
        self.flips += 1;
    }
}

#[test]
fn an_observer_hears_all_and_forbids_some() {
    let blob = shapes::blob(1.0, 3, 0.4, 3);
    let mesh = Connected::new(&blob).unwrap();
    let mut tally = Tally::default();
    let params = Params { feature_angle: 180.0, ..Params::new(0.15) };
    let (frozen, watch) = (Frozen::default(), Watch::default());
    let fine =
        remesh_observed(&mesh, &frozen, Sizing::Uniform, &params, Projection::Input, &mut tally, &watch).unwrap();
    assert_eq!(fine.mesh.positions.len() + tally.collapses, blob.positions.len() + tally.splits);
    assert!(tally.flips > 0);
    assert!(fine.edit_ids.as_slice().contains(&VertexId(5)));
}

#[test]
fn impossible_jobs_are_refused() {
    let ball = shapes::icosphere(1.0, 1);
    let mesh = Connected::new(&ball).unwrap();
    let watch = Watch::default();
    let job = |params: &Params, frozen: &Frozen| {
        remesh(&mesh, frozen, Sizing::Uniform, params, Projection::Input, &watch).err()
    };
    let none = Frozen::default();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(job(&Params::new(bad), &none), Some(Error::NotPositive { .. })));
    }
    assert!(matches!(job(&Params::new(1e-9), &none), Some(Error::TooFine { .. })));
    let short = Frozen { vertices: VertexMap::filled(3, true), ..Frozen::default() };
    assert!(matches!(job(&Params::new(0.1), &short), Some(Error::Count { found: 3, .. })));
    watch.cancel();
    assert!(matches!(job(&Params::new(0.1), &none), Some(Error::Cancelled(_))));
    let mut broken = ball.clone();
    broken.positions[7].y = f64::NAN;
    let broken = Connected::new(&broken).unwrap();
    let error = remesh(&broken, &none, Sizing::Uniform, &Params::new(0.1), Projection::Input, &Watch::default());
    assert!(matches!(error.err(), Some(Error::NotFinite { vertex: VertexId(7), .. })));
    let empty = Connected::new(TriMesh::default()).unwrap();
    let nothing = remesh(&empty, &none, Sizing::Uniform, &Params::new(0.1), Projection::Input, &Watch::default());
    assert!(nothing.unwrap().mesh.faces.is_empty());
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let blob = shapes::blob(1.0, 4, 0.5, 9);
    let on = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| run(&blob, &Params::new(0.07)))
    };
    let (one, three) = (on(1), on(3));
    assert_eq!(one.mesh, three.mesh);
    assert_eq!(one.origins, three.origins);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// Any blob, torn or whole, at any length: manifold, same genus and boundary, no vertex lost in space.
    #[test]
    fn topology_is_kept(
        seed in 0u64..1000, bumps in 0.0f64..0.8, length in 0.05f64..0.8, holes in prop::collection::vec(0usize..1280, 0..6),
        angle in prop::sample::select(vec![20.0, 40.0, 180.0]),
    ) {
        let mut blob = shapes::blob(1.0, 3, bumps, seed);
        let mut f = 0;
        blob.faces.retain(|_| { f += 1; !holes.contains(&(f - 1)) });
        let Ok(mesh) = Connected::new(&blob) else { return Ok(()) };
        let fine = run(&blob, &Params { feature_angle: angle, ..Params::new(length) });
        let out = Connected::new(&fine.mesh);
        prop_assert!(out.is_ok(), "{:?}", out.err());
        let out = out.unwrap();
        prop_assert_eq!(topology(&out).euler_characteristic(), topology(&mesh).euler_characteristic());
        prop_assert_eq!(topology(&out).boundary_loops, topology(&mesh).boundary_loops);
        let (inner, outer) = (bounds(&fine.mesh), bounds(&blob));
        prop_assert!(inner.max.cmple(outer.max + 1e-9).all() && inner.min.cmpge(outer.min - 1e-9).all());
        let same = |(p, o): (&DVec3, &VertexOrigin)| match o {
            VertexOrigin::Input { vertex, .. } => *p == blob.positions[vertex.index()],
            _ => true,
        };
        prop_assert!(fine.mesh.positions.iter().zip(fine.origins.vertices.as_slice()).all(same));
    }
}

#[test]
fn refining_splits_and_does_nothing_else() {
    let cube = shapes::cuboid(DVec3::ONE);
    let mesh = Connected::new(&cube).unwrap();
    let wanted = |p: DVec3| if p.z > 0.4 { 0.1 } else { 1.0 };
    let (fine, origins) = remesh::refine(&mesh, &wanted, 0.1).unwrap();
    let out = Connected::new(&fine).unwrap();
    assert!(fine.positions.starts_with(&cube.positions));
    assert!((volume(&fine) - 1.0).abs() < 1e-12 && (area(&fine) - 6.0).abs() < 1e-12);
    for (p, origin) in fine.positions.iter().zip(origins.vertices.as_slice()) {
        assert!(p.distance(origin.position(std::slice::from_ref(&cube)).unwrap()) < 1e-15);
    }
    for f in out.face_ids() {
        let corners = fine.triangle(f);
        let longest = (0..3).map(|k| corners[k].distance(corners[(k + 1) % 3])).fold(0.0, f64::max);
        assert!(longest <= 0.1 || corners.iter().any(|p| p.z < 0.4), "{corners:?}");
        let (FaceOrigin::Input { face, .. } | FaceOrigin::Piece { face, .. }) = origins.faces[f] else { panic!() };
        let normal = mesh_core::face_normal(&cube, face);
        assert!(corners.iter().all(|p| (*p - cube.triangle(face)[0]).dot(normal).abs() < 1e-15));
    }
}
