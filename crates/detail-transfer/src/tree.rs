//! A k-d tree over vectors, in their principal axes.

use rayon::prelude::*;

/// Principal axes kept. Distances in them never exceed the vectors' own.
const AXES: usize = 8;
/// Vectors in a leaf, at most.
const LEAF: usize = 16;
/// Rounding of projected distances, as a share of them and of the largest coordinate.
const SLACK: [f32; 2] = [1e-4, 1e-6];

type Point = [f32; AXES];

/// Vectors by number, findable by distance.
pub(crate) struct Tree {
    axes: Vec<Vec<f64>>,
    nodes: Vec<Node>,
    /// Projections, leaf by leaf, and whose they are.
    points: Vec<Point>,
    ids: Vec<u32>,
    /// Of all coordinates, by magnitude.
    largest: f32,
}

enum Node {
    Leaf {
        start: u32,
        end: u32,
    },
    /// Below: up to `low` on the axis, in the next node; above: from `high` on, in node `above`.
    Fork {
        axis: usize,
        low: f32,
        high: f32,
        above: u32,
    },
}

impl Tree {
    /// A tree of `count` vectors of `numbers` numbers; `read` writes one out. O(n log n), parallel.
    pub fn build(count: u32, numbers: usize, read: &(impl Fn(u32, &mut [f32]) + Sync)) -> Self {
        let axes = principal_axes(count, numbers, read);
        let projected = |vector: &mut Vec<f32>, id: u32| {
            read(id, vector);
            (project(&axes, vector), id)
        };
        let mut all: Vec<(Point, u32)> =
            (0..count).into_par_iter().map_init(|| vec![0.0; numbers], projected).collect();
        let mut nodes = vec![];
        fork(&mut all, 0, &mut nodes);
        let largest = all.iter().flat_map(|p| p.0).fold(0.0, |m: f32, x| m.max(x.abs()));
        let (points, ids) = all.into_iter().unzip();
        Self { axes, nodes, points, ids, largest }
    }

    /// Shows `visit` every vector that is not farther from `query` than the square root of the limit, and perhaps others. The limit is
    /// what `visit` last gave back.
    pub fn visit(&self, query: &[f32], limit: f32, mut visit: impl FnMut(u32) -> f32) {
        let q = project(&self.axes, query);
        let largest = q.iter().fold(self.largest, |m, x| m.max(x.abs()));
        let loosened = |limit: f32| ((1.0 + SLACK[0]) * limit.sqrt() + SLACK[1] * largest).powi(2);
        let mut limit = loosened(limit);
        // Node, squared distance to its box, and the parts of it by axis.
        let mut stack: Vec<(u32, f32, Point)> = Vec::with_capacity(64);
        stack.push((0, 0.0, [0.0; AXES]));
        while let Some((mut at, distance, parts)) = stack.pop() {
            if distance > limit {
                continue;
            }
            loop {
                match self.nodes[at as usize] {
                    Node::Leaf { start, end } => {
                        for i in start as usize..end as usize {
                            if squared(&q, &self.points[i]) <= limit {
                                limit = loosened(visit(self.ids[i]));
                            }
                        }
                        break;
                    }
                    Node::Fork { axis, low, high, above } => {
                        let (to_low, to_high) = (q[axis] - low, high - q[axis]);
                        let (near, far, gap) =
                            if to_low < to_high { (at + 1, above, to_high) } else { (above, at + 1, to_low) };
                        let gap = parts[axis].max(gap.max(0.0).powi(2));
                        let farther = distance - parts[axis] + gap;
                        if farther <= limit {
                            let mut of_far = parts;
                            of_far[axis] = gap;
                            stack.push((far, farther, of_far));
                        }
                        at = near;
                    }
                }
            }
        }
    }
}

fn squared(a: &Point, b: &Point) -> f32 {
    let mut lanes = [0f32; 4];
    for line in 0..AXES / 4 {
        for (k, lane) in lanes.iter_mut().enumerate() {
            let d = a[4 * line + k] - b[4 * line + k];
            *lane += d * d;
        }
    }
    lanes.iter().sum()
}

/// Orthonormal axes along which the vectors vary most.
fn principal_axes(count: u32, numbers: usize, read: &impl Fn(u32, &mut [f32])) -> Vec<Vec<f64>> {
    let step = (count / MOST_SAMPLED).max(1) as usize;
    let sampled = || (0..count).step_by(step);
    let total = sampled().count().max(1) as f64;
    let mut vector = vec![0.0; numbers];
    let mut mean = vec![0.0; numbers];
    for id in sampled() {
        read(id, &mut vector);
        mean.iter_mut().zip(&vector).for_each(|(m, &x)| *m += f64::from(x) / total);
    }
    let mut covariance = vec![0.0; numbers * numbers];
    let mut centred = vec![0.0; numbers];
    for id in sampled() {
        read(id, &mut vector);
        centred.iter_mut().zip(vector.iter().zip(&mean)).for_each(|(c, (&x, m))| *c = f64::from(x) - m);
        for i in 0..numbers {
            for j in i..numbers {
                covariance[i * numbers + j] += centred[i] * centred[j];
            }
        }
    }
    for i in 0..numbers {
        for j in 0..i {
            covariance[i * numbers + j] = covariance[j * numbers + i];
        }
    }
    let mut axes = mesh_operators::eigenvectors(&covariance, numbers);
    axes.truncate(AXES);
    axes
}

/// Vectors enough to know how all vary.
const MOST_SAMPLED: u32 = 8192;

fn project(axes: &[Vec<f64>], vector: &[f32]) -> Point {
    let along = |axis: &Vec<f64>| axis.iter().zip(vector).map(|(a, &x)| a * f64::from(x)).sum::<f64>() as f32;
    std::array::from_fn(|k| axes.get(k).map_or(0.0, along))
}

/// Splits at the middle of the widest axis until leaves are small. `start` is the place of the first point in the whole.
fn fork(points: &mut [(Point, u32)], start: usize, nodes: &mut Vec<Node>) {
    let here = nodes.len();
    let leaf = Node::Leaf { start: start as u32, end: (start + points.len()) as u32 };
    nodes.push(leaf);
    if points.len() <= LEAF {
        return;
    }
    let extent = |axis: usize| {
        let (low, high) = points
            .iter()
            .map(|p| p.0[axis])
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    let (axis, widest) =
        (0..AXES).map(|a| (a, extent(a))).fold((0, 0.0), |best, e| if e.1 > best.1 { e } else { best });
    if widest <= 0.0 {
        return;
    }
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (below, above) = points.split_at_mut(middle);
    let low = below.iter().map(|p| p.0[axis]).fold(f32::NEG_INFINITY, f32::max);
    let high = above.iter().map(|p| p.0[axis]).fold(f32::INFINITY, f32::min);
    fork(below, start, nodes);
    let at = nodes.len() as u32;
    nodes[here] = Node::Fork { axis, low, high, above: at };
    fork(above, start + middle, nodes);
}
