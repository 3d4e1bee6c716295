//! A thin plate drawn towards where it belongs: fair everywhere, tangent to what is around it.

use glam::DVec3;
use rayon::prelude::*;

/// A linear thin plate over the vertices of a mesh, some of them fixed.
///
/// It minimises ∫|Δx|² + ∫ q·|x − t|²/σ⁴, discretised on the shape it is built on, every vertex inside or
/// on the boundary bearing energy.
pub(crate) struct Plate {
    laplacian: Rows,
    transposed: Rows,
    areas: Vec<f64>,
    free: Vec<bool>,
}

/// A sparse matrix by rows.
struct Rows {
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl Rows {
    fn from(mut triples: Vec<(u32, u32, f64)>, rows: usize) -> Self {
        triples.sort_by_key(|t| (t.0, t.1));
        let mut starts = vec![0; rows + 1];
        for t in &triples {
            starts[t.0 as usize + 1] += 1;
        }
        for i in 0..rows {
            starts[i + 1] += starts[i];
        }
        Self { starts, entries: triples.into_iter().map(|t| (t.1, t.2)).collect() }
    }

    fn row(&self, i: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[i]..self.starts[i + 1]]
    }

    fn times(&self, x: &[DVec3]) -> Vec<DVec3> {
        let product = |i: usize| self.row(i).iter().map(|&(j, w)| w * x[j as usize]).sum();
        (0..self.starts.len() - 1).into_par_iter().with_min_len(512).map(product).collect()
    }
}

/// Half the widest angle that is told apart from a straight one, in radians: the weights grow beyond bounds there.
const WIDEST: f64 = 1.53;

impl Plate {
    /// The first `bearing` of the points bear energy; `free` tells which may move.
    pub fn new(points: &[DVec3], faces: &[[u32; 3]], bearing: usize, free: Vec<bool>) -> Self {
        let mut weights: Vec<(u32, u32, f64)> = Vec::with_capacity(6 * faces.len());
        let mut areas = vec![0.0; points.len()];
        for f in faces {
            let p = f.map(|v| points[v as usize]);
            let area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
            for k in 0..3 {
                areas[f[k] as usize] += area / 3.0;
                if f[k] as usize >= bearing {
                    continue;
                }
                // Mean value weights [Floater2003] are positive for any triangles and vanish on linear functions.
                let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                let half = (0.5 * u.cross(v).length().atan2(u.dot(v))).min(WIDEST).tan();
                weights.push((f[k], f[(k + 1) % 3], half / u.length().max(f64::MIN_POSITIVE)));
                weights.push((f[k], f[(k + 2) % 3], half / v.length().max(f64::MIN_POSITIVE)));
            }
        }
        weights.sort_by_key(|t| (t.0, t.1));
        let mean = areas[..bearing].iter().sum::<f64>() / bearing.max(1) as f64;
        let mut entries: Vec<(u32, u32, f64)> = Vec::with_capacity(weights.len() / 2 + bearing);
        for row in weights.chunk_by(|a, b| a.0 == b.0) {
            let v = row[0].0 as usize;
            // Scaled so that the Laplacian of |x|² is four, and by the root of the vertex' share of the area.
            let squares: f64 = row.iter().map(|e| e.2 * points[e.1 as usize].distance_squared(points[v])).sum();
            let scale = 4.0 * areas[v].max(0.05 * mean).sqrt() / squares.max(f64::MIN_POSITIVE);
            let mut total = 0.0;
            for edge in row.chunk_by(|a, b| a.1 == b.1) {
                let weight = scale * edge.iter().map(|e| e.2).sum::<f64>();
                total += weight;
                entries.push((edge[0].0, edge[0].1, weight));
            }
            entries.push((v as u32, v as u32, -total));
        }
        let turned = entries.iter().map(|&(i, j, w)| (j, i, w)).collect();
        Self { laplacian: Rows::from(entries, bearing), transposed: Rows::from(turned, points.len()), areas, free }
    }

    /// Whether point `v` may move.
    pub fn moves(&self, v: usize) -> bool {
        self.free[v]
    }

    /// Moves the free points to where the energy is least, from where they are. `pull` is q/σ⁴ for each point.
    pub fn settle(&self, x: &mut [DVec3], targets: &[DVec3], pull: &[f64], accuracy: f64) {
        let n = x.len();
        let hold: Vec<f64> = (0..n).map(|v| pull[v] * self.areas[v]).collect();
        let apply = |x: &[DVec3]| {
            let bent = self.transposed.times(&self.laplacian.times(x));
            let masked = |v: usize| if self.free[v] { bent[v] + hold[v] * x[v] } else { DVec3::ZERO };
            (0..n).map(masked).collect::<Vec<_>>()
        };
        let diagonal: Vec<f64> = (0..n)
            .map(|v| hold[v] + self.transposed.row(v).iter().map(|e| e.1 * e.1).sum::<f64>())
            .map(|d| d.max(f64::MIN_POSITIVE))
            .collect();
        let first = apply(x);
        let mut residual: Vec<DVec3> =
            (0..n).map(|v| if self.free[v] { hold[v] * targets[v] - first[v] } else { DVec3::ZERO }).collect();
        let scale = |r: &[DVec3]| -> Vec<DVec3> { r.iter().zip(&diagonal).map(|(r, d)| *r / *d).collect() };
        let dot = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(p, q)| p.dot(*q)).sum::<f64>();
        let mut scaled = scale(&residual);
        let mut direction = scaled.clone();
        let mut size = dot(&residual, &scaled);
        let enough = accuracy * accuracy * size;
        for _ in 0..MOST_STEPS {
            if size <= enough || size.is_nan() {
                break;
            }
            let image = apply(&direction);
            let step = size / dot(&direction, &image);
            for v in 0..n {
                x[v] += step * direction[v];
                residual[v] -= step * image[v];
            }
            scaled = scale(&residual);
            let next = dot(&residual, &scaled);
            for (d, s) in direction.iter_mut().zip(&scaled) {
                *d = *s + next / size * *d;
            }
            size = next;
        }
    }
}

/// Steps of conjugate gradients at most.
const MOST_STEPS: usize = 1500;
