//! Fits a field to constraints from a file and evaluates it at points from another: `fit KERNEL CONSTRAINTS POINTS`, the
//! kernel `biharmonic` or `triharmonic`, the files 64-bit floats, four for a constraint (place and value), three for a
//! point. Prints seconds, the residual, and how far the first thousand values are from the sum over all centres, as JSON.

use glam::DVec3;
use mesh_core::Stopwatch;
use rbf_solve::{Constraint, Field, Kernel, Params, Solver};
use std::error::Error;

/// From here on the iterative solver is the faster one.
const MANY: usize = 4000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kernel, constraints, points] = &arguments[..] else { return Err("fit KERNEL CONSTRAINTS POINTS".into()) };
    let kernel = if kernel == "biharmonic" { Kernel::Biharmonic } else { Kernel::Triharmonic };
    let place = |c: &[f64]| DVec3::new(c[0], c[1], c[2]);
    let constraints: Vec<Constraint> =
        numbers(constraints)?.chunks_exact(4).map(|c| Constraint::off_surface(place(c), c[3])).collect();
    let points: Vec<DVec3> = numbers(points)?.chunks_exact(3).map(place).collect();
    let solver = if constraints.len() < MANY { Solver::Dense } else { Solver::Iterative { tolerance: 1e-6 } };
    let since = Stopwatch::start();
    let field = Field::fit(&constraints, &Params { kernel, solver, ..Params::default() }, &|_| true)?;
    let fit = since.elapsed().as_secs_f64();
    let since = Stopwatch::start();
    let mut values = vec![0.0; points.len()];
    field.many_values(&points, &mut values);
    let evaluate = since.elapsed().as_secs_f64();
    let some = points.len().min(1000);
    let mut exact = vec![0.0; some];
    field.values(&points[..some], &mut exact);
    let off = values.iter().zip(&exact).map(|(v, e)| (v - e).abs()).fold(0.0, f64::max);
    println!(r#"{{"fit": {fit}, "evaluate": {evaluate}, "residual": {}, "off": {off}}}"#, field.residual());
    Ok(())
}

fn numbers(path: &str) -> Result<Vec<f64>, std::io::Error> {
    Ok(std::fs::read(path)?.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
}
