//! Times of maps: one-shot, prepared, free.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use mesh_core::{Connected, Faces, TriMesh, VertexId, shapes};
use param_conformal::{Harmonic, Outline, Ring, Seam, map_free, map_ring};
use std::hint::black_box;

fn tube(n: u32) -> Connected<TriMesh> {
    let mut mesh = shapes::open_cylinder(1.0, 2.0, 4 * n, n);
    mesh.positions.iter_mut().for_each(|p| *p *= 1.0 + 0.3 * (5.0 * p.z).sin());
    Connected::new(mesh).expect("a tube is a manifold")
}

fn maps(c: &mut Criterion) {
    let mut group = c.benchmark_group("maps");
    for n in [8, 32, 128] {
        let mesh = tube(n);
        let ring = Ring::new(&mesh).expect("a tube is a ring");
        let [from, to] = [0, 1].map(|side: usize| mesh.tail(ring.loops()[side][0]));
        let cut = ring.cut(&mesh, ring.seam(&mesh, from, to).expect("a seam")).expect("a seam");
        let outline = Outline::by_length(&mesh, &cut, 2.0);
        let faces = mesh.face_count();
        group.bench_function(BenchmarkId::new("ring", faces), |b| {
            b.iter(|| map_ring(black_box(&mesh), &cut, &outline, Seam::Periodic).expect("a map"));
        });
        let rim: Vec<VertexId> = cut.bottom().iter().chain(cut.top()).copied().collect();
        let values: Vec<[f64; 2]> = outline.bottom.iter().chain(&outline.top).map(|&x| [x, 0.0]).collect();
        let solver = Harmonic::new(&mesh, &rim).expect("a factor");
        group.bench_function(BenchmarkId::new("prepared", faces), |b| b.iter(|| solver.solve(black_box(&values))));
        let disc = Connected::new(shapes::grid(2.0, 1.0, 2 * n, 2 * n)).expect("a grid is a manifold");
        group.bench_function(BenchmarkId::new("free", disc.face_count()), |b| {
            b.iter(|| map_free(black_box(&disc)).expect("a map"));
        });
    }
    group.finish();
}

criterion_group!(benches, maps);
criterion_main!(benches);
