//! Build and queries on spheres of 82k, 328k and 1.3M triangles.

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use mesh_core::{Faces, shapes};
use mesh_query::TriBvh;
use std::hint::black_box;

/// Directions spread over the sphere.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let turn = f64::from(i) * 2.399_963_229_728_653;
        DVec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z)
    })
}

fn queries(c: &mut Criterion) {
    for level in [6, 7, 8] {
        let a = shapes::icosphere(1.0, level);
        let mut b = a.clone();
        b.positions.iter_mut().for_each(|p| *p += DVec3::new(1.3, 0.2, 0.1));
        let (ta, tb) = (TriBvh::build(&a).unwrap(), TriBvh::build(&b).unwrap());
        let mut group = c.benchmark_group(format!("{} triangles", a.face_count()));
        group.sample_size(10);
        group.bench_function("build", |bench| bench.iter(|| TriBvh::build(black_box(&a))));
        group.bench_function("pairs", |bench| bench.iter(|| ta.overlapping_pairs(&a, &tb, &b)));
        for height in [0.001, 0.1] {
            group.bench_function(BenchmarkId::new("10k closest points, height", height), |bench| {
                bench.iter_batched(
                    || directions(10_000).map(|d| (1.0 + height) * d),
                    |points| points.map(|p| ta.closest_point(&a, p).unwrap().distance).sum::<f64>(),
                    BatchSize::SmallInput,
                );
            });
        }
        group.bench_function("10k rays", |bench| {
            bench.iter(|| directions(10_000).filter(|&d| ta.ray_occluded(&a, 3.0 * d, -d, 5.0)).count());
        });
        group.finish();
    }
}

criterion_group!(benches, queries);
criterion_main!(benches);
