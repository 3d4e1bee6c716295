//! S-patches: a Bézier simplex composed with the embedding of a polygon, evaluated by de Casteljau's algorithm.

use crate::control::{Shape, compositions};
use crate::embedding::{LANES, Lanes, Polygon};
use glam::{DVec2, DVec3};
use profile_nurbs::SurfaceJet;
use rayon::prelude::*;

/// An m-sided S-patch of degree n (\[LoopDeRose1989\]).
///
/// A step of de Casteljau's algorithm takes the points of weight d + 1 to those of weight d: b_i = Σ_k l_k b_{i+e_k}.
/// Which point each i + e_k is depends on the shape alone, and is looked up.
#[derive(Clone, Debug)]
pub struct SPatch {
    polygon: Polygon,
    degree: usize,
    points: Vec<DVec3>,
    /// For each weight from n − 1 down to 0, the m points each point is mixed from.
    steps: Vec<Vec<u32>>,
}

/// Batches at least this long are worth a second thread.
const BATCH: usize = 4096;

impl SPatch {
    /// A patch with `points` numbered as [`Shape`] says; `None` if their number is not right.
    pub fn new(sides: usize, degree: usize, points: Vec<DVec3>) -> Option<Self> {
        let shape = Shape::Simplex { sides, degree }.checked().ok()?;
        if points.len() != shape.count() {
            return None;
        }
        let step = |weight: usize| {
            let above = Shape::Simplex { sides, degree: weight + 1 };
            let mut all = vec![];
            compositions(weight as u8, &mut vec![0; sides], 0, &mut all);
            let mut parents = Vec::with_capacity(all.len() * sides);
            for mut index in all {
                for k in 0..sides {
                    index[k] += 1;
                    parents.push(above.number(&index).unwrap_or(0) as u32);
                    index[k] -= 1;
                }
            }
            parents
        };
        let steps = (0..degree).rev().map(step).collect();
        Some(Self { polygon: Polygon::new(sides), degree, points, steps })
    }

    /// The domain.
    pub fn polygon(&self) -> &Polygon {
        &self.polygon
    }

    /// The degree n.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The control points.
    pub fn control_points(&self) -> &[DVec3] {
        &self.points
    }

    /// The surface at many points of the polygon, appended to `out`. Eight at a time, in parallel if there are many;
    /// O(m · control points) each.
    pub fn points(&self, at: &[DVec2], out: &mut Vec<DVec3>) {
        let from = out.len();
        out.resize(from + at.len(), DVec3::ZERO);
        let out = &mut out[from..];
        if at.len() <= BATCH {
            self.fill(at, out);
        } else {
            at.par_chunks(BATCH).zip(out.par_chunks_mut(BATCH)).for_each(|(at, out)| self.fill(at, out));
        }
    }

    fn fill(&self, at: &[DVec2], out: &mut [DVec3]) {
        let m = self.polygon.sides();
        let (mut sigma, mut l) = (vec![[0.0; LANES]; m], vec![[0.0; LANES]; m]);
        // Two levels in turn; the first step reads the control points themselves.
        let room = self.steps.first().map_or(1, |s| s.len() / m);
        let mut levels = [vec![[[0.0; LANES]; 3]; room], vec![[[0.0; LANES]; 3]; room]];
        for (block, out) in at.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let place = |lane: usize| block[lane.min(block.len() - 1)];
            let (x, y) = (std::array::from_fn(|i| place(i).x), std::array::from_fn(|i| place(i).y));
            self.polygon.embed_lanes(&x, &y, &mut sigma, &mut l);
            for (level, step) in self.steps.iter().enumerate() {
                let [a, b] = &mut levels;
                let (from, to) = if level % 2 == 0 { (b, a) } else { (a, b) };
                for (mixed, parents) in to.iter_mut().zip(step.chunks_exact(m)) {
                    *mixed = if level == 0 { self.mix_control(parents, &l) } else { mix(parents, from, &l) };
                }
            }
            let last = &levels[(self.steps.len() + 1) % 2][0];
            for (lane, p) in out.iter_mut().enumerate() {
                *p = DVec3::new(last[0][lane], last[1][lane], last[2][lane]);
            }
        }
    }

    #[inline]
    fn mix_control(&self, parents: &[u32], l: &[Lanes]) -> [Lanes; 3] {
        let mut sum = [[0.0; LANES]; 3];
        for (&parent, l) in parents.iter().zip(l) {
            let p = self.points[parent as usize].to_array();
            for axis in 0..3 {
                for lane in 0..LANES {
                    sum[axis][lane] += l[lane] * p[axis];
                }
            }
        }
        sum
    }

    /// The surface at one point of the polygon.
    pub fn point(&self, p: DVec2) -> DVec3 {
        let mut out = Vec::with_capacity(1);
        self.points(&[p], &mut out);
        out[0]
    }

    /// The surface at one point with derivatives by the polygon's x and y.
    pub fn jet(&self, p: DVec2) -> SurfaceJet {
        let (m, n) = (self.polygon.sides(), self.degree as f64);
        let l = self.polygon.embed_jets(p);
        let mut level = self.points.clone();
        let mut first = vec![];
        let mut second = vec![];
        for (step, weight) in self.steps.iter().zip((0..self.degree).rev()) {
            // Points of weight 1 are the gradient, those of weight 2 the Hessian, in barycentric coordinates.
            if weight == 1 {
                second.clone_from(&level);
            }
            if weight == 0 {
                first.clone_from(&level);
            }
            level = step
                .chunks_exact(m)
                .map(|parents| parents.iter().zip(&l).map(|(&p, l)| l.0[0] * level[p as usize]).sum())
                .collect();
        }
        let mut jet = SurfaceJet { point: level[0], ..SurfaceJet::default() };
        for (k, l) in l.iter().enumerate() {
            let slope = n * first[k];
            jet.first[0] += l.0[1] * slope;
            jet.first[1] += l.0[2] * slope;
            for d in 0..3 {
                jet.second[d] += l.0[3 + d] * slope;
            }
        }
        if self.degree >= 2 {
            // Indices e_k + e_l of weight 2, through the table that mixes weight 1 from them.
            let table = &self.steps[self.degree - 2];
            for k in 0..m {
                for j in 0..m {
                    let bend = n * (n - 1.0) * second[table[k * m + j] as usize];
                    let (a, b) = (l[k].0, l[j].0);
                    jet.second[0] += a[1] * b[1] * bend;
                    jet.second[1] += a[1] * b[2] * bend;
                    jet.second[2] += a[2] * b[2] * bend;
                }
            }
        }
        jet
    }
}

#[inline]
fn mix(parents: &[u32], from: &[[Lanes; 3]], l: &[Lanes]) -> [Lanes; 3] {
    let mut sum = [[0.0; LANES]; 3];
    for (&parent, l) in parents.iter().zip(l) {
        let p = &from[parent as usize];
        for axis in 0..3 {
            for lane in 0..LANES {
                sum[axis][lane] += l[lane] * p[axis][lane];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn net(sides: usize, degree: usize, seed: &[f64]) -> Vec<DVec3> {
        let at = |i: usize| seed[i % seed.len()] * (1.0 + (i % 13) as f64);
        (0..Shape::Simplex { sides, degree }.count())
            .map(|i| DVec3::new(at(3 * i), at(3 * i + 1), at(3 * i + 2)))
            .collect()
    }

    /// Σ n!/Π i_k! Π l_k^{i_k} b_i, straight from the definition.
    fn definition(sides: usize, degree: usize, points: &[DVec3], p: DVec2) -> DVec3 {
        let l = Polygon::new(sides).embed(p);
        let factorial = |n: u8| (1..=n).map(f64::from).product::<f64>();
        let basis = |index: &[u8]| {
            index.iter().zip(&l).map(|(&i, l)| l.powi(i32::from(i)) / factorial(i)).product::<f64>()
                * factorial(degree as u8)
        };
        Shape::Simplex { sides, degree }.indices().iter().zip(points).map(|(i, &b)| basis(i) * b).sum()
    }

    proptest! {
        #[test]
        fn agrees_with_the_definition_and_its_differences(sides in 3usize..8, degree in 1usize..6, x in -0.4..0.4f64, y in -0.2..0.4f64, seed in prop::collection::vec(-1.0..1.0f64, 17)) {
            let points = net(sides, degree, &seed);
            let patch = SPatch::new(sides, degree, points.clone()).unwrap();
            let (p, h) = (DVec2::new(x, y), 1e-4);
            let truth = |x: f64, y: f64| definition(sides, degree, &points, p + DVec2::new(x, y));
            prop_assert!(patch.point(p).distance(truth(0.0, 0.0)) < 1e-12);
            let jet = patch.jet(p);
            prop_assert!(jet.point.distance(truth(0.0, 0.0)) < 1e-12);
            let close = |a: DVec3, b: DVec3, scale: f64| a.distance(b) < scale * (1.0 + a.length());
            let [c, e, w, n, s] = [truth(0.0, 0.0), truth(h, 0.0), truth(-h, 0.0), truth(0.0, h), truth(0.0, -h)];
            prop_assert!(close(jet.first[0], (e - w) / (2.0 * h), 1e-5) && close(jet.first[1], (n - s) / (2.0 * h), 1e-5));
            prop_assert!(close(jet.second[0], (e + w - 2.0 * c) / (h * h), 1e-4));
            prop_assert!(close(jet.second[2], (n + s - 2.0 * c) / (h * h), 1e-4));
            let mixed = (truth(h, h) - truth(-h, h) - truth(h, -h) + truth(-h, -h)) / (4.0 * h * h);
            prop_assert!(close(jet.second[1], mixed, 1e-4));
        }
    }

    /// With three sides the embedding is the identity, so the patch is the triangular Bézier patch; along a side of any
    /// patch lies the Bézier curve of the side's control points.
    #[test]
    fn sides_are_bezier_curves() {
        for (sides, degree) in [(3, 4), (5, 3), (6, 3), (8, 2)] {
            let shape = Shape::Simplex { sides, degree };
            let patch = SPatch::new(sides, degree, net(sides, degree, &[0.3, -0.7, 0.55, 0.21, -0.4])).unwrap();
            for k in 0..sides {
                let t = 0.37;
                let mut curve: Vec<DVec3> = shape.border(k).iter().map(|&i| patch.points[i]).collect();
                while curve.len() > 1 {
                    curve = curve.windows(2).map(|w| w[0].lerp(w[1], t)).collect();
                }
                let at = patch.polygon.corner(k).lerp(patch.polygon.corner(k + 1), t);
                assert!(patch.point(at).distance(curve[0]) < 1e-12);
            }
        }
    }
}
