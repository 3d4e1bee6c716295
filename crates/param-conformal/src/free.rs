//! Discs with a free boundary: the spectral conformal map (\[MullenTongAlliezDesbrun2008\]).
//!
//! The map z minimises its conformal energy ½ zᴴL z − area(z) among all of one size, measured on the boundary; no
//! vertex is pinned, so that nothing but the surface decides the result. With z complex the energy is one Hermitian
//! matrix of n rows, whose smallest eigenvector but the constant is found by inverse iteration.

use crate::distortion::{check, doubled_area, face_corners};
use crate::error::Error;
use crate::harmonic::{Pull, Weights, for_neighbours, is_usable};
use glam::DVec2;
use mesh_core::{Adjacency, Positions, VertexId, VertexMap, area, boundary_loops, topology};
use mesh_operators::{HermitianCholesky, LowerTriangle};
use num_complex::Complex64;

/// Flattens a disc: angles kept as far as its curvature lets them, total area kept, centred at the boundary's middle,
/// long axis along x.
///
/// Time as [`crate::Harmonic::new`], times about four.
///
/// # Errors
/// [`Error::NotADisc`], [`Error::NotFinite`], [`Error::Singular`], [`Error::Flipped`].
pub fn map_free<M: Adjacency + Positions + Sync>(mesh: &M) -> Result<VertexMap<DVec2>, Error> {
    let counts = topology(mesh);
    let euler = counts.euler_characteristic();
    let loops = boundary_loops(mesh);
    if counts.components != 1 || loops.len() != 1 || euler != 1 {
        return Err(Error::NotADisc { pieces: counts.components, loops: loops.len(), characteristic: euler });
    }
    let used: Vec<VertexId> = mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_some()).collect();
    for &v in &used {
        let at = mesh.position(v);
        if !is_usable(at) {
            return Err(Error::NotFinite { vertex: v, at });
        }
    }
    let mut index = VertexMap::filled(mesh.vertex_count(), 0u32);
    (0..).zip(&used).for_each(|(i, &v)| index[v] = i);
    let rim: Vec<usize> = loops[0].iter().map(|&h| index[mesh.tail(h)] as usize).collect();
    let lower = energy(mesh, &used, &index);
    let singular = |vertex| Error::Singular { vertex, at: mesh.position(vertex) };
    let factor = HermitianCholesky::new(&lower).map_err(|e| singular(used[e.unknown]))?;
    let z = smallest(&factor, used.len(), &rim);
    let mut map: VertexMap<DVec2> = VertexMap::filled(mesh.vertex_count(), DVec2::ZERO);
    used.iter().zip(&z).for_each(|(&v, z)| map[v] = DVec2::new(z.re, z.im));
    resize(mesh, &mut map);
    check(mesh, face_corners(mesh, &map))?;
    Ok(map)
}

/// A shift that keeps the energy's matrix definite: its null space holds the constants, and on a developable surface
/// all similarities. As a share of the diagonal; inverse iteration is unhurt by it.
const SHIFT: f64 = 1e-9;

/// Twice the conformal energy, as a matrix, slightly shifted.
fn energy<M: Adjacency + Positions + Sync>(
    mesh: &M,
    used: &[VertexId],
    index: &VertexMap<u32>,
) -> LowerTriangle<Complex64> {
    let pull = Pull::of(mesh, Weights::Cotangent);
    let mut lower = LowerTriangle::default();
    let mut column: Vec<(u32, Complex64)> = Vec::new();
    let mut trace = 0.0;
    for (i, &v) in (0..).zip(used) {
        let mut diagonal = 0.0;
        column.clear();
        column.push((i, Complex64::ZERO));
        for_neighbours(mesh, v, |h, w| {
            let weight = pull.along(mesh, h);
            diagonal += weight;
            let j = index[w];
            if j > i {
                // Entry (j, i) of −area: +i/2 when the boundary runs from j to i, −i/2 when from i to j.
                let area = match (mesh.twin(h).is_none(), mesh.tail(h) == v) {
                    (true, true) => -0.5,
                    (true, false) => 0.5,
                    (false, _) => 0.0,
                };
                column.push((j, Complex64::new(-weight, area)));
            }
        });
        column[0].1 = Complex64::new(diagonal, 0.0);
        column.sort_unstable_by_key(|c| c.0);
        trace += diagonal;
        lower.column(&column);
    }
    let shift = SHIFT * trace / used.len() as f64;
    for i in 0..used.len() {
        if let Some(diagonal) = lower.diagonal_mut(i) {
            diagonal.re += shift;
        }
    }
    lower
}

/// The eigenvector of the smallest energy for its size on the boundary, constants apart.
fn smallest(factor: &HermitianCholesky, n: usize, rim: &[usize]) -> Vec<Complex64> {
    // Any start that is no constant will do; the circle is the answer where the disc is round.
    let mut z = vec![Complex64::ZERO; n];
    for (k, &i) in rim.iter().enumerate() {
        let angle = std::f64::consts::TAU * k as f64 / rim.len() as f64;
        z[i] = Complex64::new(angle.cos(), angle.sin());
    }
    for _ in 0..MOST_STEPS {
        let before: Vec<Complex64> = rim.iter().map(|&i| z[i]).collect();
        let mut next = vec![Complex64::ZERO; n];
        for &i in rim {
            next[i] = z[i];
        }
        factor.solve(&mut next);
        let mean = rim.iter().map(|&i| next[i]).sum::<Complex64>() / rim.len() as f64;
        for x in &mut next {
            *x -= mean;
        }
        let norm = rim.iter().map(|&i| next[i].norm_sqr()).sum::<f64>().sqrt();
        // Each step may turn z by a phase; compare without it.
        let overlap: Complex64 = rim.iter().zip(&before).map(|(&i, b)| b.conj() * next[i]).sum();
        let phase = if overlap.norm() > 0.0 { overlap / overlap.norm() } else { Complex64::new(1.0, 0.0) };
        for x in &mut next {
            *x /= phase * norm;
        }
        let change = rim.iter().zip(&before).map(|(&i, b)| (next[i] - b).norm_sqr()).sum::<f64>().sqrt();
        z = next;
        if change <= 1e-13 {
            break;
        }
    }
    z
}

/// Far more than are needed: each step gains the digits by which the second eigenvalue exceeds the first.
const MOST_STEPS: usize = 60;

/// Keeps the total area and lays the long axis along x.
fn resize<M: Adjacency + Positions + Sync>(mesh: &M, map: &mut VertexMap<DVec2>) {
    let mapped: f64 = mesh.face_ids().map(|f| 0.5 * doubled_area(mesh.corners(f).map(|v| map[v]))).sum();
    let scale = (area(mesh) / mapped.abs()).sqrt();
    let used = || mesh.vertex_ids().filter(|&v| mesh.outgoing(v).is_some());
    let moment = used().map(|v| Complex64::new(map[v].x, map[v].y)).map(|z| z * z).sum::<Complex64>();
    let turn = DVec2::from_angle(-0.5 * moment.im.atan2(moment.re));
    for v in used() {
        map[v] = scale * turn.rotate(map[v]);
    }
}
