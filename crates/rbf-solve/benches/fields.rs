//! Fits and evaluations on a bumpy closed surface, each point with one off-surface constraint beside it.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use rbf_solve::{Constraint, Field, Kernel, Params, Solver};
use std::hint::black_box;

fn bumpy(count: usize) -> Vec<Constraint> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let tau = 0.1 * (12.0 / count as f64).sqrt();
    let pair = |i: usize| {
        let z = 1.0 - (4.0 * i as f64 + 2.0) / count as f64;
        let (s, c) = (golden * i as f64).sin_cos();
        let d = DVec3::new((1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z);
        let p = d * (1.0 + 0.1 * (5.0 * d.x).sin() * (4.0 * d.y).cos());
        [Constraint::on_surface(p), Constraint::off_surface(p + tau * d, tau)]
    };
    (0..count / 2).flat_map(pair).collect()
}

fn fit(constraints: &[Constraint], kernel: Kernel, solver: Solver) -> Field {
    let params = Params { kernel, solver, ..Params::default() };
    Field::fit(constraints, &params, &|_| true).expect("a sound system")
}

fn fits(c: &mut Criterion) {
    let mut group = c.benchmark_group("rbf-solve/fit");
    group.sample_size(10);
    for count in [1000, 4000] {
        let constraints = bumpy(count);
        group.bench_with_input(BenchmarkId::new("dense", count), &constraints, |b, constraints| {
            b.iter(|| fit(black_box(constraints), Kernel::Triharmonic, Solver::Dense));
        });
    }
    let constraints = bumpy(10_000);
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
        group.bench_function(BenchmarkId::new(format!("iterative/{kernel:?}"), 10_000), |b| {
            b.iter(|| fit(black_box(&constraints), kernel, Solver::Iterative { tolerance: 1e-6 }));
        });
    }
}

fn evaluations(c: &mut Criterion) {
    let mut group = c.benchmark_group("rbf-solve/evaluate 100 000 points");
    group.sample_size(10);
    let points: Vec<DVec3> = (0..100_000)
        .map(|i| DVec3::new(f64::from(i % 50), f64::from(i / 50 % 50), f64::from(i / 2500)) / 20.0 - 1.2)
        .collect();
    let mut values = vec![0.0; points.len()];
    let mut gradients = vec![DVec3::ZERO; points.len()];
    for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
        let field = fit(&bumpy(1000), kernel, Solver::Dense);
        group.bench_function(BenchmarkId::new(format!("values/{kernel:?}"), 1000), |b| {
            b.iter(|| field.values(black_box(&points), &mut values));
        });
        group.bench_function(BenchmarkId::new(format!("gradients/{kernel:?}"), 1000), |b| {
            b.iter(|| field.gradients(black_box(&points), &mut gradients));
        });
    }
}

criterion_group!(benches, fits, evaluations);
criterion_main!(benches);
