//! A field along a surface, in cubes: centres far from a cube are felt through one expansion, those near it one by one.
//!
//! What a sum of n kernels costs at each of many places then grows with the centres nearby, not with n (\[FongDarve2009\], of whose
//! tree this is the level that pays where a surface is sampled densely and centres stand along a few curves).

use crate::chebyshev::{Basis, MOST};
use crate::field::Field;
use crate::kernel::with_kernel;
use crate::sum::{Block, LANES, Sum, spread};
use crate::wide::wide;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Degree of the expansions. Centres at three half widths or more are felt to 1e-6 of what they add over the cube.
const DEGREE: usize = 7;
/// Fewer centres than this are summed faster.
const FEW: usize = 1000;
/// Points per task.
const TASK: usize = 32 * LANES;

/// The cube of a point, and which point it is.
type Keyed = ([i32; 3], u32);

/// A field for many points in few cubes.
pub struct Patches<'a> {
    field: &'a Field,
    /// Of a cube, in the field's own units.
    width: f64,
    basis: Basis,
    cubes: Mutex<HashMap<[i32; 3], Arc<Cube>>>,
}

struct Cube {
    centre: DVec3,
    /// The centres near it, and the affine part.
    near: Sum,
    /// The expansion of all others. Empty where there are none.
    far: Vec<f64>,
}

impl Field {
    /// The field for many points that lie densely along a surface: in cubes of a width, in model units, within which values and
    /// gradients of far centres are expanded, to about 1e-6 of the width. 40 spacings of the points make good cubes.
    pub fn patches(&self, width: f64) -> Patches<'_> {
        Patches::new(self, width / self.scale)
    }
}

impl<'a> Patches<'a> {
    fn new(field: &'a Field, width: f64) -> Self {
        Self { field, width, basis: Basis::new(DEGREE), cubes: Mutex::default() }
    }

    /// The values at many points, on all cores, whatever else is in the batch. `out` must be as long as `points`.
    pub fn values(&self, points: &[DVec3], out: &mut [f64]) {
        if !self.pays() {
            return self.field.values(points, out);
        }
        let scale = self.field.scale;
        with_kernel!(self.field.kernel, K => self.each(points, out, |cube, at| {
            let (near, far) = (cube.near.block_values::<K>(at), self.expand(cube, at).0);
            std::array::from_fn(|l| scale * (near[l] + far[l]))
        }));
    }

    /// Values and gradients at many points. All three slices must be of one length.
    pub fn values_and_gradients(&self, points: &[DVec3], values: &mut [f64], gradients: &mut [DVec3]) {
        if !self.pays() {
            return self.field.values_and_gradients(points, values, gradients);
        }
        let mut both = vec![(0.0, DVec3::ZERO); points.len()];
        with_kernel!(self.field.kernel, K => self.each(points, &mut both, |cube, at| {
            let ((value, [x, y, z]), (v, d)) = (cube.near.block_of_both::<K>(at), self.expand(cube, at));
            std::array::from_fn(|l| {
                (self.field.scale * (value[l] + v[l]), DVec3::new(x[l] + d[0][l], y[l] + d[1][l], z[l] + d[2][l]))
            })
        }));
        for ((value, gradient), both) in values.iter_mut().zip(gradients).zip(both) {
            (*value, *gradient) = both;
        }
    }

    fn pays(&self) -> bool {
        self.field.centres() > FEW && self.field.sum.tilts[0].is_empty()
    }

    /// Evaluates all points, those of one cube together.
    fn each<T: Copy + Send + Sync>(
        &self,
        points: &[DVec3],
        out: &mut [T],
        evaluate: impl Fn(&Cube, &Block) -> [T; LANES] + Sync,
    ) {
        let at = self.field.normalised(points);
        let key = |p: DVec3| (p / self.width).floor().as_ivec3().to_array();
        let mut order: Vec<Keyed> = at.par_iter().zip(0..at.len() as u32).map(|(&p, i)| (key(p), i)).collect();
        order.par_sort_unstable();
        let runs: Vec<&[Keyed]> = order.chunk_by(|a, b| a.0 == b.0).collect();
        let cubes = self.cubes_of(&runs.iter().map(|r| r[0].0).collect::<Vec<_>>());
        let tasks: Vec<(&Cube, &[Keyed])> =
            cubes.iter().zip(&runs).flat_map(|(cube, run)| run.chunks(TASK).map(|part| (&**cube, part))).collect();
        let found: Vec<Vec<T>> = tasks
            .par_iter()
            .map(|(cube, part)| {
                wide(
                    #[inline(always)]
                    || {
                        let blocks = part.chunks(LANES).flat_map(|some| {
                            let mut places = [at[some[0].1 as usize]; LANES];
                            places.iter_mut().zip(some).for_each(|(place, &(_, i))| *place = at[i as usize]);
                            evaluate(cube, &spread(&places)).into_iter().take(some.len())
                        });
                        blocks.collect()
                    },
                )
            })
            .collect();
        for (&(_, i), value) in order.iter().zip(found.into_iter().flatten()) {
            out[i as usize] = value;
        }
    }

    /// The cubes of these keys, made where they are asked for the first time.
    fn cubes_of(&self, keys: &[[i32; 3]]) -> Vec<Arc<Cube>> {
        // A cube is put in whole or not at all, so one thread's panic leaves nothing half made.
        let lock = || self.cubes.lock().unwrap_or_else(PoisonError::into_inner);
        let known: Vec<Option<Arc<Cube>>> = {
            let cubes = lock();
            keys.iter().map(|k| cubes.get(k).cloned()).collect()
        };
        let all: Vec<Arc<Cube>> =
            keys.par_iter().zip(known).map(|(&k, known)| known.unwrap_or_else(|| Arc::new(self.cube(k)))).collect();
        lock().extend(keys.iter().copied().zip(all.iter().cloned()));
        all
    }

    fn cube(&self, key: [i32; 3]) -> Cube {
        let all = &self.field.sum;
        let centre = (DVec3::from(key.map(f64::from)) + 0.5) * self.width;
        let is_near =
            |&i: &usize| (DVec3::new(all.x[i], all.y[i], all.z[i]) - centre).abs().max_element() < 1.5 * self.width;
        let (near, far): (Vec<usize>, Vec<usize>) = (0..all.x.len()).partition(is_near);
        let part = |of: &[usize], affine: [f64; 4]| {
            let take = |from: &[f64]| of.iter().map(|&i| from[i]).collect();
            Sum {
                x: take(&all.x),
                y: take(&all.y),
                z: take(&all.z),
                weights: take(&all.weights),
                affine,
                ..Sum::default()
            }
        };
        let mut expansion = vec![];
        if !far.is_empty() {
            let nodes = self.basis.places(centre, 0.5 * self.width);
            let mut values = vec![0.0; nodes.len()];
            part(&far, [0.0; 4]).values(self.field.kernel, &nodes, &mut values);
            expansion = vec![0.0; self.basis.len()];
            self.basis.analyse(values, &mut expansion);
        }
        Cube { centre, near: part(&near, all.affine), far: expansion }
    }

    /// Value and gradient of what is far.
    #[inline(always)]
    fn expand(&self, cube: &Cube, at: &Block) -> ([f64; LANES], Block) {
        let (mut value, mut gradient) = ([0.0; LANES], [[0.0; LANES]; 3]);
        if cube.far.is_empty() {
            return (value, gradient);
        }
        let half = 2.0 / self.width;
        let [x, y, z] = [0, 1, 2].map(|k| polynomials(&at[k].map(|v| (v - cube.centre[k]) * half)));
        let mut start = 0;
        for &(a, b, count) in &self.basis.runs {
            let (mut line, mut slope) = ([0.0; LANES], [0.0; LANES]);
            for (c, w) in cube.far[start..start + count].iter().enumerate() {
                for l in 0..LANES {
                    line[l] += w * z[c].0[l];
                    slope[l] += w * z[c].1[l];
                }
            }
            for l in 0..LANES {
                value[l] += x[a].0[l] * y[b].0[l] * line[l];
                gradient[0][l] += half * x[a].1[l] * y[b].0[l] * line[l];
                gradient[1][l] += half * x[a].0[l] * y[b].1[l] * line[l];
                gradient[2][l] += half * x[a].0[l] * y[b].0[l] * slope[l];
            }
            start += count;
        }
        (value, gradient)
    }
}

/// T₀ … and their derivatives at some places.
#[inline(always)]
fn polynomials(x: &[f64; LANES]) -> [([f64; LANES], [f64; LANES]); MOST] {
    let mut t = [([0.0; LANES], [0.0; LANES]); MOST];
    t[0].0 = [1.0; LANES];
    t[1] = (*x, [1.0; LANES]);
    for n in 2..=DEGREE {
        for (l, x) in x.iter().enumerate() {
            t[n].0[l] = 2.0 * x * t[n - 1].0[l] - t[n - 2].0[l];
            t[n].1[l] = 2.0 * t[n - 1].0[l] + 2.0 * x * t[n - 1].1[l] - t[n - 2].1[l];
        }
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Constraint, Kernel, Params};

    type Evaluate<'a> = dyn Fn(&[DVec3], &mut [f64], &mut [DVec3]) + 'a;

    /// The twin that adds everything directly, along a tube between two rings of centres; and one point alone gets the same bits.
    #[test]
    fn patches_are_the_field() {
        let ring = |z: f64| {
            let turn = |i: u32| (std::f64::consts::TAU * f64::from(i) / 300.0).sin_cos();
            (0..300).flat_map(move |i| {
                let d = DVec3::new(turn(i).1, turn(i).0, 0.0);
                let at = d + z * DVec3::Z;
                [Constraint::on_surface(at), Constraint::off_surface(at + 0.02 * d, 0.02)]
            })
        };
        let constraints: Vec<Constraint> = ring(-1.0).chain(ring(1.0)).collect();
        let points: Vec<DVec3> = (0..4000u32)
            .map(|i| {
                let (s, c) = f64::from(i).sin_cos();
                DVec3::new(c, s, f64::from(i) / 2000.0 - 1.0)
            })
            .collect();
        for kernel in [Kernel::Biharmonic, Kernel::Triharmonic] {
            let field = Field::fit(&constraints, &Params { kernel, ..Params::default() }, &|_| true).unwrap();
            let both = |f: &Evaluate<'_>, points: &[DVec3]| {
                let (mut values, mut gradients) = (vec![0.0; points.len()], vec![DVec3::ZERO; points.len()]);
                f(points, &mut values, &mut gradients);
                (values, gradients)
            };
            let exact = both(&|p, v, g| field.values_and_gradients(p, v, g), &points);
            for width in [0.3, 0.8] {
                let patches = field.patches(width);
                assert!(patches.pays());
                let found = both(&|p, v, g| patches.values_and_gradients(p, v, g), &points);
                let off = found.0.iter().zip(&exact.0).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
                let turned = found.1.iter().zip(&exact.1).map(|(f, e)| f.distance(*e)).fold(0.0, f64::max);
                println!("{kernel:?} {width}: {off:e} {turned:e}");
                assert!(off < 1e-6 * width && turned < 1e-4, "{kernel:?} {width}: {off:e} {turned:e}");
                let mut values = vec![0.0; points.len()];
                patches.values(&points, &mut values);
                assert_eq!(values, found.0);
                for (&p, v) in points.iter().zip(&values).step_by(371) {
                    let mut alone = [0.0];
                    patches.values(&[p], &mut alone);
                    assert_eq!(alone[0].to_bits(), v.to_bits());
                }
            }
        }
    }
}
