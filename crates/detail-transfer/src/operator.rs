//! The cotangent Laplacian of a patch.

use glam::DVec3;
use mesh_core::{Connected, TriMesh};
use mesh_operators::{HeldSystem, Laplacian, Unknowns, vertex_areas};

/// C and A of the Laplacian A⁻¹C: C the cotangent Laplacian, A the vertices' areas. Positive semidefinite, and zero on constants.
#[derive(Debug)]
pub(crate) struct Operator {
    laplacian: Laplacian,
    areas: Vec<f64>,
}

impl Operator {
    pub fn new(mesh: &Connected<TriMesh>) -> Self {
        Self { laplacian: Laplacian::cotangent(mesh), areas: vertex_areas(mesh).into_vec() }
    }

    /// The area of a vertex.
    pub fn area(&self, i: usize) -> f64 {
        self.areas[i]
    }

    /// A row of C: its own entry first.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.laplacian.row(i)
    }

    /// (A⁻¹C x)_i, in units of x over a squared length; x grows against it as heat flows.
    pub fn laplacian(&self, x: &[DVec3], i: usize) -> DVec3 {
        self.laplacian.apply(x, i) / self.areas[i]
    }
}

/// Implicit steps of diffusion, (A + tC) x' = A x, with some vertices held.
pub(crate) struct Diffusion<'a> {
    operator: &'a Operator,
    system: HeldSystem,
}

impl<'a> Diffusion<'a> {
    /// `None` where the equations are singular to working precision.
    pub fn new(operator: &'a Operator, held: &[bool], time: f64) -> Option<Self> {
        let unknowns = Unknowns::new(held.len(), |i| !held[i]);
        let system = HeldSystem::new(unknowns, |v, row| {
            row.push((v, operator.areas[v as usize]));
            operator.laplacian.add_row(v, time, row);
        });
        Some(Self { operator, system: system.ok()? })
    }

    /// One step from `x`, held vertices staying at their values in `x`.
    pub fn step(&self, x: &[DVec3]) -> Vec<DVec3> {
        let free = self.system.unknowns().free();
        let right: Vec<DVec3> = free.iter().map(|&i| self.operator.areas[i as usize] * x[i as usize]).collect();
        let mut out = x.to_vec();
        self.system.solve(&mut out, &right, 1);
        out
    }
}
