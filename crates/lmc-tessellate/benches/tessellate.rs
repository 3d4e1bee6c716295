//! The band between two caps of a ball, with cells of 1/20 to 1/160 of the radius.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lmc_tessellate::{Params, Rim, isosurface, tessellate};
use mesh_core::{Connected, TriMesh, VertexId, Watch, boundary_loops, shapes};

fn band(c: &mut Criterion) {
    let field = |points: &[DVec3], values: &mut [f64]| {
        values.iter_mut().zip(points).for_each(|(v, p)| *v = p.length() - 1.0);
    };
    let mut group = c.benchmark_group("band of a ball");
    group.sample_size(10);
    for n in [20u32, 40, 80, 160] {
        let ball = shapes::uv_sphere(1.0, 8 * n, 4 * n);
        let height = |f: &[VertexId; 3]| f.iter().map(|v| ball.positions[v.index()].z).sum::<f64>() / 3.0;
        let faces = ball.faces.iter().filter(|f| height(f).abs() > 0.5).copied().collect();
        let caps = Connected::new(TriMesh { positions: ball.positions.clone(), faces }).unwrap();
        let rims: Vec<Rim> = boundary_loops(&caps).iter().map(|walk| Rim::of(&caps, walk)).collect();
        let params = Params { cell: 1.0 / f64::from(n), ..Params::default() };
        group.bench_function(BenchmarkId::from_parameter(n), |b| {
            b.iter(|| tessellate(&rims, &field, &params, &Watch::default()).unwrap());
        });
    }
    group.finish();
}

fn grid(c: &mut Criterion) {
    let n = 128;
    let value = |i: usize| {
        DVec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64).distance(DVec3::splat(64.0)) - 50.0
    };
    let values: Vec<f64> = (0..n * n * n).map(value).collect();
    c.bench_function("isosurface of 128³ samples", |b| b.iter(|| isosurface(&values, [n; 3], DVec3::ZERO, 1.0)));
}

criterion_group!(benches, band, grid);
criterion_main!(benches);
