//! The blend stage alone, connectivity kept, on the teapot's body and spout at the sizes that [Liu2005] §6.3 times.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use fusion::blend::{Params, Surface, blend, keep};
use mesh_core::{Connected, Faces, TriMesh, Watch, shapes};
use spine::BlendCurve;
use std::hint::black_box;
use tri_intersect::{Operation, boolean};

/// Body and spout joined, patches in `n` × `n` cells, and their seams.
fn teapot(n: u32) -> (Connected<TriMesh>, Vec<BlendCurve>) {
    let pot = shapes::closed_teapot(n);
    let [body, spout] = [pot.body, pot.spout].map(|m| Connected::new(m).expect("a closed part is a manifold"));
    let joined = boolean(&body, &spout, Operation::Union, &tri_intersect::Params::default(), &Watch::default())
        .expect("body and spout overlap");
    let mesh = Connected::new(joined.mesh).expect("a boolean is a manifold");
    let curves = joined.seams.iter().map(|s| BlendCurve::from_vertices(&mesh, &s.vertices));
    let curves = curves.collect::<Result<_, _>>().expect("seams run along edges");
    (mesh, curves)
}

fn stages(c: &mut Criterion) {
    let mut group = c.benchmark_group("keep");
    for (n, radius) in [(15, 0.15), (7, 0.25)] {
        let (mesh, curves) = teapot(n);
        let params = Params { surface: Surface::Keep(keep::Params::default()), ..Params::new(radius) };
        group.bench_function(BenchmarkId::new("teapot", mesh.face_count()), |b| {
            b.iter(|| blend(black_box(&mesh), &curves, &params, &Watch::default()).expect("a blend"));
        });
    }
    group.finish();
}

criterion_group!(benches, stages);
criterion_main!(benches);
