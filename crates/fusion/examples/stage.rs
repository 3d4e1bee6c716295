//! One stage from arrays to arrays, timed, for comparison with other programs: what is read from files is ready before the clock starts.
//!
//! `stage read PATH`: a file as a mesh.
//! `stage union A B`: the union of two solids.
//! `stage curves A B`: the curves in which two meshes meet.
//! `stage remesh MESH LENGTH ROUNDS`: even triangles.
//! `stage harmonic MESH FIXED OUT`: coordinates in the plane, those of fixed vertices given as (vertex, u, v).
//! `stage flow MESH TIME OUT`: one implicit step of mean-curvature flow.
//! `stage field KERNEL CONSTRAINTS CAPS CELL OUT`: the zero set of a field, followed from one loop of the caps to the other; constraints are
//! (place, value).
//!
//! Files of numbers are 64-bit floats. Prints, as JSON, the best seconds of five runs on the clock and of all processors (Linux tells), and
//! what has been made.

use fusion::mesh_core::{Connected, Faces, TriMesh, VertexId, Watch, boundary_loops};
use glam::DVec3;
use lmc_tessellate::{Rim, tessellate};
use param_conformal::Harmonic;
use rbf_solve::{Constraint, Field, Kernel, Solver};
use remesh::{Projection, Sizing};
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use tri_intersect::Operation;

/// The program's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const ROUNDS: usize = 5;
/// From here on the iterative solver is the faster one.
const MANY: usize = 4000;
/// Cells along a cube in which a field is expanded, as compositions have it.
const CUBE: f64 = 40.0;

type Fault = Box<dyn Error>;

fn main() -> Result<(), Fault> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (seconds, made) = match arguments[..] {
        ["read", path] => read(path)?,
        ["union", a, b] => union(&mesh(a)?, &mesh(b)?)?,
        ["remesh", path, length, rounds] => remesh(&mesh(path)?, length.parse()?, rounds.parse()?)?,
        ["curves", a, b] => curves(&mesh(a)?, &mesh(b)?)?,
        ["harmonic", path, fixed, out] => harmonic(&mesh(path)?, &numbers(fixed)?, out)?,
        ["flow", path, time, out] => flow(&mesh(path)?, time.parse()?, out)?,
        ["field", kernel, constraints, caps, cell, out] => {
            let kernel = if kernel == "biharmonic" { Kernel::Biharmonic } else { Kernel::Triharmonic };
            zero_set(kernel, &numbers(constraints)?, &mesh(caps)?, cell.parse()?, out)?
        }
        _ => {
            return Err(
                "stage read | union | curves | remesh | harmonic | flow | field, as on the example's first page".into(),
            );
        }
    };
    println!(r#"{{"clock": {}, "processor": {}, "made": {made}}}"#, seconds.clock, seconds.processor);
    Ok(())
}

fn read(path: &str) -> Result<(Seconds, usize), Fault> {
    let (seconds, mesh) = timed(|| mesh(path))?;
    Ok((seconds, mesh.face_count()))
}

fn union(a: &TriMesh, b: &TriMesh) -> Result<(Seconds, usize), Fault> {
    let (seconds, both) = timed(|| {
        let [a, b] = [Connected::new(a.clone())?, Connected::new(b.clone())?];
        Ok(tri_intersect::boolean(&a, &b, Operation::Union, &tri_intersect::Params::default(), &Watch::default())?)
    })?;
    Ok((seconds, both.mesh.face_count()))
}

fn remesh(mesh: &TriMesh, length: f64, rounds: usize) -> Result<(Seconds, usize), Fault> {
    let params = remesh::Params { rounds, ..remesh::Params::new(length) };
    let (seconds, even) = timed(|| {
        let (mesh, frozen) = (Connected::new(mesh)?, remesh::Frozen::default());
        Ok(remesh::remesh(&mesh, &frozen, Sizing::Uniform, &params, Projection::Input, &Watch::default())?)
    })?;
    Ok((seconds, even.mesh.face_count()))
}

fn curves(a: &TriMesh, b: &TriMesh) -> Result<(Seconds, usize), Fault> {
    let (seconds, curves) = timed(|| {
        let [a, b] = [Connected::new(a.clone())?, Connected::new(b.clone())?];
        Ok(tri_intersect::intersection_curves(&a, &b, &Watch::default())?)
    })?;
    Ok((seconds, curves.iter().map(|c| c.points.len()).sum()))
}

fn harmonic(mesh: &TriMesh, fixed: &[f64], out: &str) -> Result<(Seconds, usize), Fault> {
    let vertices: Vec<VertexId> = fixed.chunks_exact(3).map(|row| VertexId::from(row[0] as usize)).collect();
    let held: Vec<[f64; 2]> = fixed.chunks_exact(3).map(|row| [row[1], row[2]]).collect();
    let (seconds, map) = timed(|| Ok(Harmonic::new(&Connected::new(mesh)?, &vertices)?.solve(&held)))?;
    write(out, map.as_slice().iter().flatten())?;
    Ok((seconds, mesh.vertex_count()))
}

fn flow(mesh: &TriMesh, time: f64, out: &str) -> Result<(Seconds, usize), Fault> {
    let (seconds, points) = timed(|| {
        let (mesh, flow) = (Connected::new(mesh)?, remesh::Flow { time, steps: 1 });
        Ok(remesh::curvature_flow(&mesh, &remesh::Frozen::default(), &flow, &Watch::default())?)
    })?;
    write(out, points.iter().flat_map(AsRef::as_ref))?;
    Ok((seconds, points.len()))
}

/// The fit is not timed.
fn zero_set(
    kernel: Kernel,
    constraints: &[f64],
    caps: &TriMesh,
    cell: f64,
    out: &str,
) -> Result<(Seconds, usize), Fault> {
    let row = |c: &[f64]| Constraint::off_surface(DVec3::new(c[0], c[1], c[2]), c[3]);
    let constraints: Vec<Constraint> = constraints.chunks_exact(4).map(row).collect();
    let solver = if constraints.len() < MANY { Solver::Dense } else { Solver::Iterative { tolerance: 1e-6 } };
    let params = rbf_solve::Params { kernel, solver, ..Default::default() };
    let field = Field::fit(&constraints, &params, &|_| true)?;
    let (seconds, made) = timed(|| {
        let patches = field.patches(CUBE * cell);
        let values = |points: &[DVec3], values: &mut [f64]| patches.values(points, values);
        let caps = Connected::new(caps)?;
        let rims: Vec<Rim> = boundary_loops(&caps).iter().map(|walk| Rim::of(&caps, walk)).collect();
        let params = lmc_tessellate::Params { cell, ..Default::default() };
        Ok(tessellate(&rims, &values, &params, &Watch::default())?)
    })?;
    write(out, made.mesh.positions.iter().flat_map(AsRef::as_ref))?;
    Ok((seconds, made.mesh.face_count()))
}

/// The best times of a job, and what it makes.
fn timed<T>(job: impl Fn() -> Result<T, Fault>) -> Result<(Seconds, T), Fault> {
    let (mut best, mut made) = (Seconds { clock: f64::INFINITY, processor: f64::INFINITY }, None);
    for _ in 0..ROUNDS {
        drop(made.take());
        let (since, before) = (Instant::now(), processor_seconds());
        made = Some(job()?);
        best.clock = best.clock.min(since.elapsed().as_secs_f64());
        best.processor = best.processor.min(processor_seconds() - before);
    }
    Ok((best, made.ok_or("no round")?))
}

struct Seconds {
    clock: f64,
    processor: f64,
}

/// What all threads have used so far; not a number where no `/proc` tells.
fn processor_seconds() -> f64 {
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let nanoseconds = threads.map(|thread| {
        let said = std::fs::read_to_string(thread.path().join("schedstat")).unwrap_or_default();
        said.split(' ').next().and_then(|n| n.parse().ok()).unwrap_or(f64::NAN)
    });
    1e-9 * nanoseconds.sum::<f64>()
}

fn mesh(path: &str) -> Result<TriMesh, Fault> {
    Ok(mesh_io::read(Path::new(path))?.mesh)
}

fn numbers(path: &str) -> Result<Vec<f64>, std::io::Error> {
    Ok(std::fs::read(path)?.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
}

fn write<'a>(path: &str, numbers: impl Iterator<Item = &'a f64>) -> Result<(), std::io::Error> {
    std::fs::write(path, numbers.flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>())
}
