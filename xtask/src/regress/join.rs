//! One job through the library, and what must hold of any result.

use super::case::Operation;
use fusion::{blend, compose};
use glam::DVec3;
use mesh_core::{Stopwatch, TriMesh, Watch, validate};
use mesh_io::{Format, Model};
use mesh_query::TriBvh;
use std::collections::{BTreeMap, HashSet};

/// A result.
pub struct Joined {
    pub mesh: TriMesh,
    pub warnings: Vec<String>,
    /// The report's figures.
    pub figures: BTreeMap<String, f64>,
    pub milliseconds: f64,
}

impl Joined {
    /// A figure of the report; 0 if it has none of that name.
    pub fn figure(&self, name: &str) -> f64 {
        self.figures.get(name).copied().unwrap_or_default()
    }
}

/// Why there is none.
pub struct Failure {
    pub reason: String,
    pub place: Option<DVec3>,
    pub milliseconds: f64,
}

impl Joined {
    /// What is wrong with the result of a job on `parts`.
    pub fn faults(&self, parts: &[TriMesh], operation: Operation, radius: Option<f64>) -> Vec<String> {
        let mut faults = vec![];
        let defects = validate(&self.mesh);
        if !defects.is_closed() {
            faults.push(format!("is not valid: {defects}"));
        }
        match tri_intersect::self_intersections(&self.mesh, &Watch::default()) {
            Ok(pairs) if pairs.is_empty() => {}
            Ok(pairs) => faults.push(format!("intersects itself: {} pairs, first {:?}", pairs.len(), pairs[0])),
            Err(error) => faults.push(format!("cannot be checked: {error}")),
        }
        faults.extend(match operation {
            Operation::Compose => self.moved(parts),
            _ => self.strangers(parts, radius.unwrap_or(0.0)),
        });
        faults
    }

    /// A composition holds its parts in order, bit for bit, then its own.
    fn moved(&self, parts: &[TriMesh]) -> Option<String> {
        let wanted = parts.iter().flat_map(|m| &m.positions);
        let moved = wanted.zip(&self.mesh.positions).position(|(p, q)| p != q);
        moved.map(|v| format!("vertex {v} of the parts has been moved"))
    }

    /// A vertex that is no input vertex must lie near the seam, so near two parts at once: a point of a fillet is
    /// within a diameter of both, and a linkage that walks through a dent which the ball spans, within two.
    fn strangers(&self, parts: &[TriMesh], radius: f64) -> Option<String> {
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        let known: HashSet<_> = parts.iter().flat_map(|m| &m.positions).map(bits).collect();
        let trees: Vec<_> = parts.iter().filter_map(|m| Some((m, TriBvh::build(m).ok()?))).collect();
        let size = mesh_core::bounds(&self.mesh).diagonal();
        let reach = 4.0 * radius + 1e-9 * size;
        let far = self.mesh.positions.iter().filter(|p| !known.contains(&bits(p))).find(|&&p| {
            let near = |(m, tree): &&(&TriMesh, TriBvh)| tree.closest_point(*m, p).is_some_and(|c| c.distance <= reach);
            trees.iter().filter(near).count() < 2
        });
        far.map(|p| format!("moved or made a vertex at {p}, away from the seam"))
    }
}

/// Joins the parts in order.
pub fn join(parts: &[TriMesh], operation: Operation, radius: Option<f64>) -> Result<Joined, Failure> {
    let start = Stopwatch::start();
    let result = run(parts, operation, radius);
    let milliseconds = 1e3 * start.elapsed().as_secs_f64();
    match result {
        Ok(done) => Ok(Joined {
            mesh: done.model.mesh,
            warnings: [done.report.warnings, done.report.notes].concat(),
            figures: done.report.figures,
            milliseconds,
        }),
        Err(e) => Err(Failure { reason: e.to_string(), place: e.place(), milliseconds }),
    }
}

fn run(parts: &[TriMesh], operation: Operation, radius: Option<f64>) -> Result<fusion::Outcome, fusion::Error> {
    let models: Vec<_> = parts.iter().cloned().map(Model::from).collect();
    let watch = Watch::default();
    let booleans = |operation: fusion::Operation| {
        let params = fusion::join::Params {
            operation,
            blend: radius.map(blend::Params::new),
            seams: fusion::join::SeamChoice::default(),
            format: Format::Ply,
        };
        fusion::join(&models, &params, &watch)
    };
    match operation {
        Operation::Union => booleans(fusion::Operation::Union),
        Operation::Difference => booleans(fusion::Operation::Difference),
        Operation::Intersection => booleans(fusion::Operation::Intersection),
        Operation::Compose => compose::compose(&models, &compose::Params::new(Format::Ply), &watch),
    }
}
