//! Connecting and checking a mesh of 1.3 million triangles.

use criterion::{Criterion, criterion_group, criterion_main};
use mesh_core::{Connected, TriMesh, VertexId, shapes, validate, vertex_normals};
use std::hint::black_box;

/// The same mesh with vertices and faces in an order without locality.
fn shuffled(mesh: &TriMesh) -> TriMesh {
    let n = mesh.positions.len();
    // A multiplier prime to the count visits every vertex once.
    let order = |i: usize| i * 7_368_787 % n;
    let mut positions = mesh.positions.clone();
    (0..n).for_each(|i| positions[order(i)] = mesh.positions[i]);
    let mut faces: Vec<_> = mesh.faces.iter().map(|c| c.map(|v| VertexId::from(order(v.index())))).collect();
    let m = faces.len();
    (0..m).for_each(|i| faces.swap(i, i * 7_368_787 % m));
    TriMesh { positions, faces }
}

fn connect(c: &mut Criterion) {
    let ball = shapes::icosphere(1.0, 8);
    let soup = shuffled(&ball);
    let connected = Connected::new(&ball).unwrap();
    let mut group = c.benchmark_group("1.3M triangles");
    group.sample_size(10);
    group.bench_function("connect", |b| b.iter(|| Connected::new(black_box(&ball)).unwrap()));
    group.bench_function("connect, no locality", |b| b.iter(|| Connected::new(black_box(&soup)).unwrap()));
    group.bench_function("validate", |b| b.iter(|| validate(black_box(&ball))));
    group.bench_function("vertex normals", |b| b.iter(|| vertex_normals(black_box(&connected))));
    group.finish();
}

criterion_group!(benches, connect);
criterion_main!(benches);
