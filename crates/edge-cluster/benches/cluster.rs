//! A million points of an S-patch, and the flower pot whole at a ten-thousandth of its size.

use criterion::{Criterion, criterion_group, criterion_main};
use edge_cluster::{Blend, Params, Polyhedron, PolyhedronParams, SPatch, Shape, Spec, blend, solids, weave};
use glam::{DVec2, DVec3};
use mesh_core::Watch;
use std::hint::black_box;

/// Points spread over a disc inside every polygon.
fn disc(count: u32) -> Vec<DVec2> {
    let at = |i: u32| {
        let radius = 0.8 * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
        DVec2::from_angle(f64::from(i) * 2.399_963_229_728_653) * radius
    };
    (0..count).map(at).collect()
}

fn pot() -> (Polyhedron, Vec<Spec>) {
    let model = solids::flower_pot();
    let (mesh, of) = model.triangles();
    let solid = Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap();
    let specs = model.clusters.iter().map(|v| Spec { vertices: v.clone(), ..Spec::default() }).collect();
    (solid, specs)
}

fn whole(solid: &Polyhedron, specs: &[Spec]) -> Blend {
    blend(solid, specs, &Params::default(), 1e-4 * solid.size, 1.0, &Watch::default()).unwrap()
}

fn cluster(c: &mut Criterion) {
    let mut group = c.benchmark_group("edge cluster");
    group.sample_size(10);
    let places = disc(1_000_000);
    for degree in [3, 5] {
        let count = Shape::Simplex { sides: 6, degree }.count();
        let points = (0..count).map(|i| DVec3::new(f64::from(i as u32), f64::from((i * i) as u32 % 7), 1.0)).collect();
        let patch = SPatch::new(6, degree, points).unwrap();
        let mut out = vec![];
        group.bench_function(format!("a million points, six sides, degree {degree}"), |b| {
            b.iter(|| {
                out.clear();
                patch.points(black_box(&places), &mut out);
            });
        });
    }
    let (solid, specs) = pot();
    let made = whole(&solid, &specs);
    let faces = made.woven.mesh.faces.len();
    group.bench_function(format!("flower pot tessellated, {faces} triangles"), |b| {
        b.iter(|| weave(&solid, &made.layout, 1e-4 * solid.size, &Watch::default()));
    });
    group.bench_function("flower pot, all stages", |b| b.iter(|| whole(&solid, &specs)));
}

criterion_group!(benches, cluster);
criterion_main!(benches);
