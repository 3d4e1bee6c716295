//! A surface put together again from base and detail, by least squares.

use crate::error::Error;
use crate::relief::{Detail, Relief};
use glam::DVec3;
use mesh_operators::{Cholesky, LowerTriangle, Unknowns};

/// Equations for the places of some vertices, prepared for many details.
///
/// They minimise Σ a·|Δd − bend|² + Σ a·|d − offset|²/ℓ⁴ over the offsets d of the free vertices, a the vertices' areas, Δ the base's
/// Laplacian, ℓ the wavelength over 2π: short waves follow the bend, as in \[Lin2008\] §4.2, long ones the offset, which alone
/// keeps small errors of the bend from adding up to dents. All other vertices keep their offsets exactly, and the bends of those next to free ones are
/// asked for as well, so that the surface passes the weld smoothly.
pub struct Reconstruction<'a> {
    relief: &'a Relief,
    unknowns: Unknowns,
    /// Vertices whose bend is asked for.
    rows: Vec<usize>,
    factor: Option<Cholesky>,
}

/// Steps of iterative refinement: the equations are squared, so their solution alone keeps half of the digits only.
const REFINEMENTS: usize = 3;

impl<'a> Reconstruction<'a> {
    /// Factorises the equations of the vertices `free` of the patch; those on its rim are held all the same. About O(n^1.5).
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub fn new(relief: &'a Relief, free: &[bool]) -> Result<Self, Error> {
        let (operator, rim) = (relief.operator(), relief.rim());
        let is_free = |i: usize| free.get(i) == Some(&true) && !rim[i];
        let unknowns = Unknowns::new(rim.len(), is_free);
        let concerned = |i: usize| !rim[i] && operator.row(i).any(|(j, _)| unknowns.number(j).is_some());
        let rows: Vec<usize> = (0..rim.len()).filter(|&i| concerned(i)).collect();
        let mut out = Self { relief, unknowns, rows, factor: None };
        if let Some(&first) = out.unknowns.free().first() {
            let at = relief.base().mesh().positions[first as usize];
            out.factor = Some(Cholesky::new(&out.squared()).map_err(|_| Error::Singular { at })?);
        }
        Ok(out)
    }

    /// The free vertices' part of C A⁻¹ C + A/ℓ⁴, C restricted to the rows asked for.
    fn squared(&self) -> LowerTriangle<f64> {
        let operator = self.relief.operator();
        let mut asked = vec![false; self.relief.rim().len()];
        self.rows.iter().for_each(|&i| asked[i] = true);
        let mut lower = LowerTriangle::default();
        let mut sums = vec![0.0; self.unknowns.free().len()];
        let (mut touched, mut column): (Vec<u32>, Vec<(u32, f64)>) = (vec![], vec![]);
        for (k, j) in self.free().enumerate() {
            for (i, c) in operator.row(j).filter(|&(i, _)| asked[i]) {
                for (m, d) in operator.row(i) {
                    if let Some(row) = self.unknowns.number(m).filter(|&row| row as usize >= k) {
                        touched.push(row);
                        sums[row as usize] += c * d / operator.area(i);
                    }
                }
            }
            sums[k] += self.pull(j);
            touched.sort_unstable();
            touched.dedup();
            column.extend(touched.drain(..).map(|row| (row, std::mem::take(&mut sums[row as usize]))));
            lower.column(&column);
            column.clear();
        }
        lower
    }

    fn free(&self) -> impl Iterator<Item = usize> + '_ {
        self.unknowns.free().iter().map(|&i| i as usize)
    }

    /// The weight of a vertex's offset.
    fn pull(&self, i: usize) -> f64 {
        self.relief.operator().area(i) / self.relief.anchor().powi(4)
    }

    /// Places of the patch's vertices with `details` at the free ones and bends of `details` at those beside them; all but the free ones stay where they are.
    ///
    /// # Panics
    /// Never; missing details count as zero.
    pub fn solve(&self, details: &[Detail]) -> Vec<DVec3> {
        let (relief, operator) = (self.relief, self.relief.operator());
        let detail = |i: usize| details.get(i).copied().unwrap_or_default();
        let mut bends = vec![DVec3::ZERO; relief.rim().len()];
        for &i in &self.rows {
            bends[i] = relief.frames()[i].world(detail(i).bend);
        }
        let wanted: Vec<DVec3> = self.free().map(|i| relief.frames()[i].world(detail(i).offset)).collect();
        let mut offsets = relief.offsets().to_vec();
        self.free().zip(&wanted).for_each(|(i, d)| offsets[i] = *d);
        let Some(factor) = &self.factor else { return self.places(&offsets) };
        let mut missing = vec![DVec3::ZERO; relief.rim().len()];
        for _ in 0..REFINEMENTS {
            self.rows.iter().for_each(|&i| missing[i] = bends[i] - operator.laplacian(&offsets, i));
            let right = self.free().zip(&wanted).map(|(j, d)| {
                let pushed: DVec3 = operator.row(j).map(|(i, c)| c * missing[i]).sum();
                pushed + self.pull(j) * (*d - offsets[j])
            });
            let right: Vec<DVec3> = right.collect();
            self.free().zip(factor.solve_points(&right)).for_each(|(j, step)| offsets[j] += step);
        }
        self.places(&offsets)
    }

    fn places(&self, offsets: &[DVec3]) -> Vec<DVec3> {
        self.relief.base().mesh().positions.iter().zip(offsets).map(|(b, d)| *b + *d).collect()
    }
}
