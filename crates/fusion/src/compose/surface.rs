//! The surface between the openings: the field's zero set, tessellated and remeshed.

use super::openings::{Opening, mean_edge};
use super::{Error, Params};
use crate::Report;
use glam::DVec3;
use lmc_tessellate::{Rim, Transition, suggested_cell, tessellate};
use mesh_core::{Connected, Faces, TriMesh, VertexId, VertexMap, Watch};
use rayon::prelude::*;
use rbf_solve::{Field, Patches};
use remesh::{Frozen, Projection, Sizing};
use std::collections::BTreeSet;

/// Rounds of remeshing, and the share of the way that a step of relaxation goes: the fewest and the longest with which
/// triangles of marching cubes become nearly equilateral.
const ROUNDS: usize = 7;
const LAMBDA: f64 = 0.5;

/// Cells along a cube in which the field is expanded: wider ones have more centres near, narrower ones are more.
const CUBE: f64 = 40.0;

/// Edges of the surface around an opening, at least.
const ROUND: f64 = 28.0;

/// The surface between the openings, whose first vertices are theirs. `fineness` divides the cells.
pub(super) fn surface(
    openings: &[Opening],
    field: &Field,
    params: &Params,
    fineness: f64,
    report: &mut Report,
    watch: &Watch,
) -> Result<Transition, Error> {
    let rims: Vec<Rim> = openings.iter().map(|o| o.rim.clone()).collect();
    let how = lmc_tessellate::Params {
        cell: cell_size(&rims, openings, params) / fineness,
        space: params.space,
        // Remeshing ends on the field anyway.
        steps: 0,
        ..lmc_tessellate::Params::default()
    };
    let field = &field.patches(CUBE * how.cell);
    let values = |points: &[DVec3], out: &mut [f64]| field.values(points, out);
    let made = report.time("tessellate", || tessellate(&rims, &values, &how, watch))?;
    report.figures.insert("cells".into(), made.cells as f64);
    report.figures.insert("cell".into(), how.cell);
    let mesh = report.time("remesh", || even_out(made.mesh, openings, field, params, watch))?;
    Ok(Transition { mesh, ..made })
}

/// The wanted share of the mean edge, or less where openings are close or of few edges.
fn cell_size(rims: &[Rim], openings: &[Opening], params: &Params) -> f64 {
    let (safe, edge) = (suggested_cell(rims), mean_edge(openings));
    let least = openings.iter().map(|o| o.perimeter() / ROUND).fold(edge, f64::min).max(0.25 * edge);
    let wanted = params.cell * least;
    if safe < 0.799 * edge { wanted.min(safe) } else { wanted }
}

/// Remeshes to edges as long as those of the nearest openings, or as asked, with vertices on the zero set.
fn even_out(
    mesh: TriMesh,
    openings: &[Opening],
    field: &Patches<'_>,
    params: &Params,
    watch: &Watch,
) -> Result<TriMesh, Error> {
    let sizes = Sizes::new(openings, params.edge_length);
    let sizes = VertexMap::from(mesh.positions.par_iter().map(|&p| sizes.at(p)).collect::<Vec<f64>>());
    let reach = 0.5 * mean_edge(openings);
    let edge = params.edge_length.unwrap_or_else(|| mean_edge(openings));
    // The field is dear: all rounds follow the tessellated surface, which is near enough for a last step to find the field.
    let how = remesh::Params { feature_angle: 180.0, rounds: ROUNDS, lambda: LAMBDA, ..remesh::Params::new(edge) };
    let Ok(connected) = Connected::new(mesh) else { return Err(Error::Closed) };
    let evened =
        remesh::remesh(&connected, &Frozen::default(), Sizing::PerVertex(&sizes), &how, Projection::Input, watch)?;
    let mut mesh = evened.mesh;
    let rims: usize = openings.iter().map(|o| o.vertices.len()).sum();
    onto(|at, v, g| field.values_and_gradients(at, v, g), &mut mesh.positions[rims..], reach);
    Ok(mesh)
}

/// Moves every point towards the zero set by Newton's steps: one, and another wherever the one was long beside the
/// `reach` that no step exceeds.
fn onto(field: impl Fn(&[DVec3], &mut [f64], &mut [DVec3]), points: &mut [DVec3], reach: f64) {
    const STEPS: usize = 3;
    // What is left after a step falls with its square.
    const LONG: f64 = 1e-3;
    let mut far: Vec<usize> = (0..points.len()).collect();
    for _ in 0..STEPS {
        let at: Vec<DVec3> = far.iter().map(|&i| points[i]).collect();
        let (mut values, mut gradients) = (vec![0.0; at.len()], vec![DVec3::ZERO; at.len()]);
        field(&at, &mut values, &mut gradients);
        let mut still = vec![];
        for ((&i, v), g) in far.iter().zip(values).zip(gradients) {
            let step = -v * g / g.length_squared();
            if step.is_finite() {
                points[i] += step.clamp_length_max(reach);
                if step.length() > LONG * reach {
                    still.push(i);
                }
            }
        }
        far = still;
    }
}

/// The wanted edge length at every place.
struct Sizes {
    /// Places on the openings and the mean edge there.
    samples: Vec<(DVec3, f64)>,
    wanted: Option<f64>,
}

impl Sizes {
    /// How fast lengths may change with the distance from an opening.
    const GROWTH: f64 = 0.3;
    /// Places on each opening.
    const SAMPLES: usize = 64;

    fn new(openings: &[Opening], wanted: Option<f64>) -> Self {
        let mut samples = vec![];
        for o in openings {
            let lengths: Vec<f64> = o.rim.lengths().collect();
            let n = lengths.len();
            // A neck of a few edges would be a prism.
            let finest = o.perimeter() / ROUND;
            for i in (0..n).step_by(n.div_ceil(Self::SAMPLES)) {
                // A cut leaves slivers: means by length, as points of the curve see its edges, pass over them.
                let window = 7.min(n);
                let near = (0..window).map(|k| lengths[(i + n + k - window / 2) % n]);
                samples.push((o.rim.points[i], mean_by_length(near).min(finest)));
            }
        }
        Self { samples, wanted }
    }

    fn at(&self, p: DVec3) -> f64 {
        if let Some(wanted) = self.wanted {
            let (d, edge) = self
                .samples
                .iter()
                .map(|s| (p.distance_squared(s.0), s.1))
                .fold((f64::INFINITY, wanted), |best, s| if s.0 < best.0 { s } else { best });
            let change = Self::GROWTH * d.sqrt();
            return if edge < wanted { (edge + change).min(wanted) } else { (edge - change).max(wanted) };
        }
        // The fourth power keeps far openings out of the neighbourhood of a near one.
        let (mut sum, mut weights) = (0.0, 0.0);
        for (q, edge) in &self.samples {
            let w = p.distance_squared(*q).max(1e-4 * edge * edge).powi(-2);
            sum += w * edge;
            weights += w;
        }
        sum / weights
    }
}

fn mean_by_length(lengths: impl Iterator<Item = f64>) -> f64 {
    let (sum, squares) = lengths.fold((0.0, 0.0), |(s, q), l| (s + l, q + l * l));
    squares / sum
}

/// Splits edges of the surface that join two vertices of an opening which the part already joins by an edge: welded,
/// that edge would have four faces.
pub(super) fn split_chords(mesh: &mut TriMesh, taken: &BTreeSet<[u32; 2]>, field: &Field, reach: f64) -> usize {
    let edge = |a: VertexId, b: VertexId| [a.0.min(b.0), a.0.max(b.0)];
    let mut chords: Vec<[u32; 2]> = mesh
        .faces
        .par_iter()
        .flat_map_iter(|f| [edge(f[0], f[1]), edge(f[1], f[2]), edge(f[2], f[0])])
        .filter(|e| taken.contains(e))
        .collect();
    chords.sort_unstable();
    let chords: Vec<[u32; 2]> = chords.chunk_by(|a, b| a == b).filter(|c| c.len() > 1).map(|c| c[0]).collect();
    for [a, b] in &chords {
        let middle = VertexId::from(mesh.vertex_count());
        let mut p = [0.5 * (mesh.positions[*a as usize] + mesh.positions[*b as usize])];
        onto(|at, v, g| field.values_and_gradients(at, v, g), &mut p, reach);
        mesh.positions.push(p[0]);
        for f in 0..mesh.faces.len() {
            let face = mesh.faces[f];
            let Some(k) = (0..3).find(|&k| edge(face[k], face[(k + 1) % 3]) == [*a, *b]) else { continue };
            mesh.faces[f][(k + 1) % 3] = middle;
            let mut other = face;
            other[k] = middle;
            mesh.faces.push(other);
        }
    }
    chords.len()
}
