//! The cotangent Laplacian of a patch.

use crate::cholesky::{Cholesky, Lower};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, Faces, TriMesh, mixed_areas};

/// A triangle narrower than this share of its longest side counts as that wide, so that no weight runs away.
const NARROWEST: f64 = 1e-3;
/// The least area of a vertex, as a share of the mean.
const LEAST_AREA: f64 = 1e-3;

/// C and A of the Laplacian A⁻¹C: C_ij = −w_ij, cotangent weights; A the vertices' areas. Positive semidefinite, and zero
/// on constants.
#[derive(Debug)]
pub(crate) struct Operator {
    starts: Vec<u32>,
    columns: Vec<u32>,
    weights: Vec<f64>,
    diagonal: Vec<f64>,
    areas: Vec<f64>,
}

impl Operator {
    pub fn new(mesh: &Connected<TriMesh>) -> Self {
        let cotangents: Vec<[f64; 3]> = mesh.face_ids().map(|f| tame_cotangents(mesh.mesh().triangle(f))).collect();
        let mut areas = mixed_areas(mesh).into_vec();
        let mean = areas.iter().sum::<f64>() / areas.len() as f64;
        for a in &mut areas {
            *a = a.max(LEAST_AREA * mean);
        }
        let mut out = Self { starts: vec![0], columns: vec![], weights: vec![], diagonal: vec![], areas };
        let facing = |f: FaceId, corner: usize| 0.5 * cotangents[f.index()][corner];
        for v in mesh.vertex_ids() {
            let mut diagonal = 0.0;
            for h in mesh.ring(v) {
                let mut add = |w: u32, weight: f64| {
                    out.columns.push(w);
                    out.weights.push(weight);
                    diagonal += weight;
                };
                let across = mesh.twin(h).map_or(0.0, |t| facing(t.face(), t.prev().corner()));
                add(mesh.head(h).0, facing(h.face(), h.prev().corner()) + across);
                if mesh.twin(h.prev()).is_none() {
                    add(mesh.tail(h.prev()).0, facing(h.face(), h.next().corner()));
                }
            }
            out.diagonal.push(diagonal);
            out.starts.push(out.columns.len() as u32);
        }
        out
    }

    /// The area of a vertex.
    pub fn area(&self, i: usize) -> f64 {
        self.areas[i]
    }

    /// The neighbours of a vertex and their weights.
    pub fn neighbours(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        range.map(|k| (self.columns[k] as usize, self.weights[k]))
    }

    /// A row of C: its own entry first.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        std::iter::once((i, self.diagonal[i])).chain(self.neighbours(i).map(|(j, w)| (j, -w)))
    }

    /// (A⁻¹C x)_i, in units of x over a squared length; x grows against it as heat flows.
    pub fn laplacian(&self, x: &[DVec3], i: usize) -> DVec3 {
        self.neighbours(i).map(|(j, w)| w * (x[i] - x[j])).sum::<DVec3>() / self.areas[i]
    }
}

/// Cotangents of a triangle's corners, of one no narrower than [`NARROWEST`]. They all shrink alike, which keeps the energy of the
/// triangle from becoming negative.
fn tame_cotangents(p: [DVec3; 3]) -> [f64; 3] {
    let side = |k: usize| p[(k + 1) % 3] - p[k];
    let longest = (0..3).map(|k| side(k).length_squared()).fold(0.0, f64::max);
    let twice_area = side(0).cross(side(1)).length().max(NARROWEST * longest);
    [0, 1, 2].map(|k| {
        let cotangent = -side(k).dot(side((k + 2) % 3)) / twice_area;
        if cotangent.is_finite() { cotangent } else { 0.0 }
    })
}

/// Implicit steps of diffusion, (A + tC) x' = A x, with some vertices held.
pub(crate) struct Diffusion<'a> {
    operator: &'a Operator,
    factor: Option<Cholesky>,
    /// The unknown of each vertex.
    unknowns: Vec<u32>,
    free: Vec<usize>,
    time: f64,
}

pub(crate) const HELD: u32 = u32::MAX;

impl<'a> Diffusion<'a> {
    /// `None` where the equations are singular to working precision.
    pub fn new(operator: &'a Operator, held: &[bool], time: f64) -> Option<Self> {
        let mut unknowns = vec![HELD; held.len()];
        let free: Vec<usize> = (0..held.len()).filter(|&i| !held[i]).collect();
        free.iter().enumerate().for_each(|(k, &i)| unknowns[i] = k as u32);
        let mut lower = Lower::default();
        let mut column = vec![];
        for (k, &i) in free.iter().enumerate() {
            lower.begin();
            column.clear();
            for (j, c) in operator.row(i) {
                let row = unknowns[j];
                if row != HELD && row as usize >= k {
                    let own = if i == j { operator.area(i) } else { 0.0 };
                    column.push((row as usize, own + time * c));
                }
            }
            column.sort_unstable_by_key(|e| e.0);
            for &(row, value) in &column {
                lower.push(row, value);
            }
        }
        let factor = if free.is_empty() { None } else { Some(lower.factor()?) };
        Some(Self { operator, factor, unknowns, free, time })
    }

    /// One step from `x`, held vertices staying at their values in `x`.
    pub fn step(&self, x: &[DVec3]) -> Vec<DVec3> {
        let right = self.free.iter().map(|&i| {
            let held = self.operator.neighbours(i).filter(|&(j, _)| self.unknowns[j] == HELD);
            self.operator.area(i) * x[i] + self.time * held.map(|(j, w)| w * x[j]).sum::<DVec3>()
        });
        let right: Vec<DVec3> = right.collect();
        let mut out = x.to_vec();
        if let Some(factor) = &self.factor {
            self.free.iter().zip(factor.solve(&right)).for_each(|(&i, v)| out[i] = v);
        }
        out
    }
}
