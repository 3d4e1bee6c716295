//! Unions at the sizes other libraries are measured at, from arrays to arrays.
//!
//! Two 50k-triangle meshes, two spheres of 82k, of 328k and of 499k triangles each; all trees and checks included,
//! connectivity not.

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DQuat, DVec3, EulerRot};
use mesh_core::{Connected, TriMesh, Watch, shapes};
use tri_intersect::{Operation, Params, boolean, self_intersections};

fn posed(mut mesh: TriMesh, by: DVec3) -> Connected<TriMesh> {
    let turn = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.2, 0.1);
    mesh.positions.iter_mut().for_each(|p| *p = turn * *p + by);
    Connected::new(mesh).expect("shapes are manifold")
}

fn unions(c: &mut Criterion) {
    let mut group = c.benchmark_group("union");
    group.sample_size(10);
    let pairs = [
        ("50k", shapes::uv_sphere(1.0, 158, 158)),
        ("82k", shapes::icosphere(1.0, 6)),
        ("328k", shapes::icosphere(1.0, 7)),
        ("499k", shapes::uv_sphere(1.0, 500, 500)),
    ];
    for (name, mesh) in pairs {
        let (a, b) = (posed(mesh.clone(), DVec3::ZERO), posed(mesh, DVec3::new(0.7, 0.3, 0.2)));
        let (params, watch) = (Params::default(), Watch::default());
        group.bench_function(name, |r| r.iter(|| boolean(&a, &b, Operation::Union, &params, &watch)));
    }
    group.finish();
    let mesh = shapes::icosphere(1.0, 6);
    c.bench_function("self_intersections 82k", |r| r.iter(|| self_intersections(&mesh, &Watch::default())));
}

criterion_group!(benches, unions);
criterion_main!(benches);
