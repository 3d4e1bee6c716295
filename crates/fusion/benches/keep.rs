//! The blend stage alone, connectivity kept, on the teapot's body and spout at the sizes that \[Liu2005\] §6.3 times.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use fusion::blend::{Params, Surface, blend, keep};
use fusion::{Profile, profile_from_text};
use glam::DVec3;
use mesh_core::{Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, Watch, shapes, shortest_path};
use remesh::{Frozen, Projection, Sizing, remesh};
use spine::BlendCurve;
use std::hint::black_box;
use tri_intersect::{Operation, boolean};

type Mesh = Connected<TriMesh>;

/// Body and spout joined and remeshed, with edges of length `near` around the seam and `far` away from it.
fn teapot(near: f64, far: f64) -> (Mesh, BlendCurve) {
    let pot = shapes::closed_teapot(40);
    let [body, spout] = [pot.body, pot.spout].map(|m| Connected::new(m).expect("a closed part is a manifold"));
    let joined = boolean(&body, &spout, Operation::Union, &tri_intersect::Params::default(), &Watch::default())
        .expect("body and spout overlap");
    let seam: Vec<DVec3> = joined.seams[0].vertices.iter().map(|v| joined.mesh.positions[v.index()]).collect();
    let away = |p: DVec3| seam.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
    let mesh = Connected::new(joined.mesh).expect("a boolean is a manifold");
    let size = |p: DVec3| near + (far - near) * (2.0 * away(p) - 1.0).clamp(0.0, 1.0);
    let wanted = remesh::Params { feature_angle: 25.0, shortest_feature: 8.0, ..remesh::Params::new(near) };
    let even = remesh(&mesh, &Frozen::default(), Sizing::Field(&size), &wanted, Projection::Input, &Watch::default());
    let mesh = Connected::new(even.expect("a remeshed teapot").mesh).expect("a manifold");
    // The seam is a feature and still among the edges: three points of it, and the paths that hug it.
    let nearest = |p: DVec3| {
        let gap = |v: &VertexId| mesh.position(*v).distance_squared(p);
        mesh.vertex_ids().min_by(|a, b| gap(a).total_cmp(&gap(b))).expect("a mesh has vertices")
    };
    let picks = [0, 1, 2].map(|k| nearest(seam[k * seam.len() / 3]));
    let cost = |h: HalfedgeId| {
        let [a, b] = mesh.ends(h);
        a.distance(b) * (1e-3 + away(a) + away(a.midpoint(b)))
    };
    let paths = (0..3).map(|k| shortest_path(&mesh, picks[k], picks[(k + 1) % 3], cost).expect("a path"));
    let cycle: Vec<VertexId> = paths.collect::<Vec<_>>().concat().into_iter().map(|h| mesh.tail(h)).collect();
    let curve = BlendCurve::from_vertices(&mesh, &cycle).expect("the paths run along edges");
    (mesh, curve)
}

fn stages(c: &mut Criterion) {
    let mut group = c.benchmark_group("keep");
    let custom = |text| profile_from_text(text).expect("a profile");
    let profiles = [
        ("arc", Profile::Arc, None),
        ("conic, reach 2.4", Profile::Conic(2.0), Some(2.4)),
        ("general", custom(include_str!("../../../docs/profiles/general.toml")), None),
        ("ornate", custom(include_str!("../../../docs/profiles/ornate.json")), None),
    ];
    for (near, far, radius) in [(0.111, 0.111, 0.35), (0.16, 0.284, 0.3)] {
        let (mesh, curve) = teapot(near, far);
        for (name, profile, reach) in profiles.clone() {
            let surface = Surface::Keep(keep::Params::default());
            let params = Params { surface, profile, reach, ..Params::new(radius) };
            let name = format!("teapot, {name}");
            group.bench_function(BenchmarkId::new(name, mesh.face_count()), |b| {
                b.iter(|| blend(black_box(&mesh), std::slice::from_ref(&curve), &params, &Watch::default()));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, stages);
criterion_main!(benches);
