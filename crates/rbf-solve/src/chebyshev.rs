//! Chebyshev polynomials of three variables, of bounded degree in the Euclidean sense.
//!
//! A smooth function on a cube needs all products Tₐ(x) T_b(y) T_c(z) with a² + b² + c² up to some radius, about half of those of a tensor
//! grid of the same accuracy (\[Trefethen2017\]).

use glam::DVec3;

/// Most polynomials along one axis.
pub(crate) const MOST: usize = 12;

/// The products of degree up to `degree`, in order of a, then b, then c.
pub(crate) struct Basis {
    /// Polynomials along one axis: degrees 0 to `degree`.
    pub(crate) order: usize,
    /// For each pair (a, b): a, b, and how many c.
    pub(crate) runs: Vec<(usize, usize, usize)>,
    /// The three degrees of each product.
    pub(crate) degrees: Vec<[usize; 3]>,
    /// Where each product stands in a full table of order³.
    places: Vec<usize>,
    /// Nodes along one axis, ascending.
    pub(crate) nodes: Vec<f64>,
    /// From values at the nodes to coefficients: `analysis[a * order + i]`.
    analysis: Vec<f64>,
    /// Coefficients of Tₙ((x ± 1) / 2) for the lower and the upper half: `halves[side][n * order + m]`.
    halves: [Vec<f64>; 2],
}

impl Basis {
    pub(crate) fn new(degree: usize) -> Self {
        let order = degree + 1;
        let p = order as f64;
        let nodes: Vec<f64> = (0..order).map(|k| -((k as f64 + 0.5) / p * std::f64::consts::PI).cos()).collect();
        let mut analysis = vec![0.0; order * order];
        for (i, &x) in nodes.iter().enumerate() {
            let t = polynomials(x, order);
            for a in 0..order {
                analysis[a * order + i] = t[a] * if a == 0 { 1.0 } else { 2.0 } / p;
            }
        }
        let halves = [-0.5, 0.5].map(|shift| {
            let mut rows = vec![0.0; order * order];
            for (i, &x) in nodes.iter().enumerate() {
                let t = polynomials(0.5 * x + shift, order);
                for n in 0..order {
                    for m in 0..=n {
                        rows[n * order + m] += t[n] * analysis[m * order + i];
                    }
                }
            }
            rows
        });
        let mut runs = vec![];
        let mut degrees = vec![];
        for (a, b) in (0..order).flat_map(|a| (0..order).map(move |b| (a, b))) {
            let count = (0..order).take_while(|c| a * a + b * b + c * c <= degree * degree).count();
            if count > 0 {
                runs.push((a, b, count));
                degrees.extend((0..count).map(|c| [a, b, c]));
            }
        }
        let places = degrees.iter().map(|[a, b, c]| (a * order + b) * order + c).collect();
        Self { order, runs, degrees, places, nodes, analysis, halves }
    }

    /// How many products.
    pub(crate) fn len(&self) -> usize {
        self.degrees.len()
    }

    /// The nodes of a tensor grid in a cube; z runs fastest.
    pub(crate) fn places(&self, centre: DVec3, half: f64) -> Vec<DVec3> {
        let (n, p) = (&self.nodes, self.order);
        (0..p * p * p).map(|i| centre + half * DVec3::new(n[i / p / p], n[i / p % p], n[i % p])).collect()
    }

    /// Adds a weighted point to the moments of a cube.
    #[inline(always)]
    pub(crate) fn gather_point(&self, at: DVec3, weight: f64, moments: &mut [f64]) {
        let [x, y, z] = at.to_array().map(|v| polynomials(v, self.order));
        let mut start = 0;
        for &(a, b, count) in &self.runs {
            let w = weight * x[a] * y[b];
            moments[start..start + count].iter_mut().zip(&z).for_each(|(m, t)| *m += w * t);
            start += count;
        }
    }

    /// The value of an expansion at a point of its cube.
    #[inline(always)]
    pub(crate) fn value(&self, at: DVec3, coefficients: &[f64]) -> f64 {
        let [x, y, z] = at.to_array().map(|v| polynomials(v, self.order));
        let (mut start, mut sum) = (0, 0.0);
        for &(a, b, count) in &self.runs {
            let line: f64 = coefficients[start..start + count].iter().zip(&z).map(|(c, t)| c * t).sum();
            sum += x[a] * y[b] * line;
            start += count;
        }
        sum
    }

    /// Adds a child's moments to its parent's. Exact.
    #[inline(always)]
    pub(crate) fn gather(&self, child: &[f64], octant: [usize; 3], parent: &mut [f64]) {
        let table = self.along_axes(self.fill(child), |k, n, m| self.halves[octant[k]][n * self.order + m]);
        parent.iter_mut().zip(&self.places).for_each(|(p, &i)| *p += table[i]);
    }

    /// Adds a parent's expansion to its child's. Exact.
    #[inline(always)]
    pub(crate) fn scatter(&self, parent: &[f64], octant: [usize; 3], child: &mut [f64]) {
        let table = self.along_axes(self.fill(parent), |k, n, m| self.halves[octant[k]][m * self.order + n]);
        child.iter_mut().zip(&self.places).for_each(|(c, &i)| *c += table[i]);
    }

    /// Weights at the nodes that have these moments.
    pub(crate) fn node_weights(&self, moments: &[f64]) -> Vec<f64> {
        self.along_axes(self.fill(moments), |_, n, m| self.analysis[m * self.order + n])
    }

    /// Adds the expansion of values at the nodes.
    #[inline(always)]
    pub(crate) fn analyse(&self, values: Vec<f64>, coefficients: &mut [f64]) {
        let table = self.along_axes(values, |_, n, m| self.analysis[n * self.order + m]);
        coefficients.iter_mut().zip(&self.places).for_each(|(c, &i)| *c += table[i]);
    }

    #[inline(always)]
    fn fill(&self, products: &[f64]) -> Vec<f64> {
        let mut table = vec![0.0; self.order * self.order * self.order];
        self.places.iter().zip(products).for_each(|(&i, v)| table[i] = *v);
        table
    }

    /// Multiplies a full table along each axis by the matrix `entry(axis, row, column)`.
    #[inline(always)]
    fn along_axes(&self, mut now: Vec<f64>, entry: impl Fn(usize, usize, usize) -> f64) -> Vec<f64> {
        let p = self.order;
        let mut next = vec![0.0; now.len()];
        // Each round turns the axes: the last one is multiplied and becomes the first.
        for axis in [2, 1, 0] {
            // By columns, and padded, so that the inner loop is a few whole vectors.
            let mut columns = [[0.0; MOST]; MOST];
            for (m, column) in columns[..p].iter_mut().enumerate() {
                for (n, v) in column[..p].iter_mut().enumerate() {
                    *v = entry(axis, n, m);
                }
            }
            for (line, values) in now.chunks_exact(p).enumerate() {
                let mut sums = [0.0; MOST];
                for (v, column) in values.iter().zip(&columns) {
                    for n in 0..MOST {
                        sums[n] += v * column[n];
                    }
                }
                for (n, v) in sums[..p].iter().enumerate() {
                    next[n * p * p + line] = *v;
                }
            }
            std::mem::swap(&mut now, &mut next);
        }
        now
    }

    /// Coefficients of a function of two points, `kernel[target node * order³ + source node]`, in products of both, sorted by `sorted`.
    #[inline(always)]
    pub(crate) fn analyse_pairs(&self, kernel: &[f64], sorted: &[usize]) -> Vec<f64> {
        let (q, full) = (self.len(), self.order * self.order * self.order);
        // First the sources of every target node, then the targets of every source product.
        let mut half = vec![0.0; q * full];
        for (t, values) in kernel.chunks(full).enumerate() {
            let mut row = vec![0.0; q];
            self.analyse(values.to_vec(), &mut row);
            for (s, v) in row.into_iter().enumerate() {
                half[s * full + t] = v;
            }
        }
        let mut out = vec![0.0; q * q];
        for (column, &s) in out.chunks_mut(q).zip(sorted) {
            let mut row = vec![0.0; q];
            self.analyse(half[s * full..][..full].to_vec(), &mut row);
            column.iter_mut().zip(sorted).for_each(|(o, &t)| *o = row[t]);
        }
        out
    }
}

/// T₀ … at `x`.
#[inline(always)]
fn polynomials(x: f64, order: usize) -> [f64; MOST] {
    let mut t = [0.0; MOST];
    t[0] = 1.0;
    t[1] = x;
    for n in 2..order {
        t[n] = 2.0 * x * t[n - 1] - t[n - 2];
    }
    t
}
