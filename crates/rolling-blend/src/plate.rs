//! A disc of triangles across a closed polygon in space, bent onto a ball or into a thin plate.

use glam::DVec3;
use mesh_operators::{Cholesky, LowerTriangle, SparseRows};
use rustc_hash::FxHashMap;
use std::f64::consts::TAU;

/// A disc whose first vertices are the polygon that bounds it, counter-clockwise.
pub(crate) struct Plate {
    pub points: Vec<DVec3>,
    pub faces: Vec<[u32; 3]>,
    /// Vertices of the rim.
    rim: usize,
}

/// Rounds of smoothing on a ball; each moves a disturbance by about one edge.
const ROUNDS: usize = 60;

impl Plate {
    /// Concentric rings within the polygon, ever fewer vertices on each, down to one in the middle.
    pub fn spanning(rim: &[DVec3]) -> Self {
        let n = rim.len();
        let middle = rim.iter().sum::<DVec3>() / n as f64;
        let mut turn = Vec::with_capacity(n);
        let mut length = 0.0;
        for i in 0..n {
            turn.push(length);
            length += rim[i].distance(rim[(i + 1) % n]);
        }
        for t in &mut turn {
            *t /= length.max(f64::MIN_POSITIVE);
        }
        let rings = ((n as f64 / TAU / 0.866).round() as usize).max(1);
        let mut plate = Self { points: rim.to_vec(), faces: Vec::new(), rim: n };
        let (mut outer, mut outer_turn) = ((0..n as u32).collect::<Vec<_>>(), turn.clone());
        for k in 1..=rings {
            let share = 1.0 - k as f64 / rings as f64;
            let count = if k == rings { 1 } else { ((n as f64 * share).round() as usize).max(3) };
            let inner_turn: Vec<f64> = (0..count).map(|i| i as f64 / count as f64).collect();
            let first = plate.points.len() as u32;
            plate.points.extend(inner_turn.iter().map(|&t| middle.lerp(at_turn(rim, &turn, t), share)));
            let inner: Vec<u32> = (first..first + count as u32).collect();
            zip(&outer, &outer_turn, &inner, &inner_turn, &mut plate.faces);
            (outer, outer_turn) = (inner, inner_turn);
        }
        plate
    }

    /// Puts the inner vertices on a ball and spreads them evenly over it.
    pub fn wrap(&mut self, center: DVec3, radius: f64) {
        let around = self.neighbours();
        for _ in 0..ROUNDS {
            for (v, around) in around.iter().enumerate().skip(self.rim) {
                let mean = around.iter().map(|&w| self.points[w as usize]).sum::<DVec3>() / around.len() as f64;
                self.points[v] = center + radius * (mean - center).normalize_or_zero();
            }
        }
    }

    /// Lets the inner vertices settle into the thin plate of least Σ |Δx|²/area, tangent to the rim's `ghosts`: points
    /// beyond the rim, one for each of its vertices.
    pub fn settle(&mut self, ghosts: &[DVec3]) {
        for round in 0..4 {
            // Weights come from the last shape, so the first is taken from the flat fan.
            self.bend(ghosts);
            if round < 3 {
                self.flip();
            }
        }
    }

    fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut around = vec![Vec::new(); self.points.len()];
        for f in &self.faces {
            for k in 0..3 {
                around[f[k] as usize].push(f[(k + 1) % 3]);
            }
        }
        around
    }

    /// One linear solve for the plate, with cotangent weights of the present shape.
    fn bend(&mut self, ghosts: &[DVec3]) {
        let n = self.rim;
        let all: Vec<DVec3> = self.points.iter().chain(ghosts).copied().collect();
        let beyond = self.points.len() as u32;
        let skirt = (0..n as u32).flat_map(|i| {
            let j = (i + 1) % n as u32;
            [[j, i, beyond + i], [j, beyond + i, beyond + j]]
        });
        let faces: Vec<[u32; 3]> = self.faces.iter().copied().chain(skirt).collect();
        let laplacian = Laplacian::of(&all, &faces, self.points.len());
        let mut x = all;
        laplacian.minimise(&mut x, n..self.points.len());
        x.truncate(self.points.len());
        self.points = x;
    }

    /// Flips inner edges until every pair of triangles has the smaller opposite angles.
    fn flip(&mut self) {
        for _ in 0..20 {
            let mut sides: FxHashMap<[u32; 2], usize> = FxHashMap::default();
            for (f, face) in self.faces.iter().enumerate() {
                for k in 0..3 {
                    sides.insert([face[k], face[(k + 1) % 3]], f);
                }
            }
            let mut touched = vec![false; self.faces.len()];
            let mut any = false;
            for f in 0..self.faces.len() {
                for k in 0..3 {
                    let [a, b, c] = [0, 1, 2].map(|i| self.faces[f][(k + i) % 3]);
                    let Some(&g) = sides.get(&[b, a]) else { continue };
                    if touched[f] || touched[g] {
                        continue;
                    }
                    let Some(d) = self.faces[g].iter().copied().find(|&v| v != a && v != b) else { continue };
                    let taken = sides.contains_key(&[c, d]) || sides.contains_key(&[d, c]);
                    let at = |v: u32| self.points[v as usize];
                    let angle = |p: u32| (at(a) - at(p)).angle_between(at(b) - at(p));
                    if !taken && angle(c) + angle(d) > std::f64::consts::PI + 1e-9 {
                        self.faces[f] = [c, d, b];
                        self.faces[g] = [d, c, a];
                        // Or another flip of this sweep could make the same edge again.
                        sides.insert([c, d], f);
                        sides.insert([d, c], g);
                        (touched[f], touched[g], any) = (true, true, true);
                    }
                }
            }
            if !any {
                break;
            }
        }
    }
}

/// The point of a closed polygon at a share of its length.
fn at_turn(rim: &[DVec3], turn: &[f64], t: f64) -> DVec3 {
    let i = turn.partition_point(|&x| x <= t).clamp(1, rim.len()) - 1;
    let end = turn.get(i + 1).copied().unwrap_or(1.0);
    let s = (t - turn[i]) / (end - turn[i]).max(f64::MIN_POSITIVE);
    rim[i].lerp(rim[(i + 1) % rim.len()], s.clamp(0.0, 1.0))
}

/// Triangles between two rings, both counter-clockwise, by their turns; the inner one may be a single vertex.
fn zip(outer: &[u32], outer_turn: &[f64], inner: &[u32], inner_turn: &[f64], faces: &mut Vec<[u32; 3]>) {
    let (n, m) = (outer.len(), inner.len());
    let turn_of = |turns: &[f64], i: usize| if i < turns.len() { turns[i] } else { 1.0 + turns[i - turns.len()] };
    let (mut i, mut j) = (0, 0);
    while i < n || (m > 1 && j < m) {
        let step_outer = m == 1 || j == m || (i < n && turn_of(outer_turn, i + 1) <= turn_of(inner_turn, j + 1));
        if step_outer {
            faces.push([outer[i % n], outer[(i + 1) % n], inner[j % m]]);
            i += 1;
        } else {
            faces.push([outer[i % n], inner[(j + 1) % m], inner[j % m]]);
            j += 1;
        }
    }
}

/// Cotangent Laplacians of the vertices that bear energy, in rows of (column, weight).
struct Laplacian {
    rows: Vec<Vec<(u32, f64)>>,
}

/// Least weight of an edge, so that obtuse triangles do not push.
const LEAST_WEIGHT: f64 = 0.02;

impl Laplacian {
    /// Rows for the first `bearing` vertices, each divided by the root of its share of the area.
    fn of(points: &[DVec3], faces: &[[u32; 3]], bearing: usize) -> Self {
        let mut weights: Vec<Vec<(u32, f64)>> = vec![Vec::new(); bearing];
        let mut areas = vec![0.0; bearing];
        for f in faces {
            let p = f.map(|v| points[v as usize]);
            let area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
            for k in 0..3 {
                let (a, b, c) = (f[k], f[(k + 1) % 3], p[(k + 2) % 3]);
                let (u, v) = (p[k] - c, p[(k + 1) % 3] - c);
                let cotangent = 0.5 * u.dot(v) / u.cross(v).length().max(f64::MIN_POSITIVE);
                for (from, to) in [(a, b), (b, a)] {
                    if let Some(row) = weights.get_mut(from as usize) {
                        match row.iter_mut().find(|e| e.0 == to) {
                            Some(entry) => entry.1 += cotangent,
                            None => row.push((to, cotangent)),
                        }
                    }
                }
                if let Some(share) = areas.get_mut(a as usize) {
                    *share += area / 3.0;
                }
            }
        }
        let rows = weights
            .into_iter()
            .zip(areas)
            .enumerate()
            .map(|(v, (row, area))| {
                let scale = 1.0 / area.max(f64::MIN_POSITIVE).sqrt();
                let mut row: Vec<_> = row.into_iter().map(|(w, c)| (w, scale * c.clamp(LEAST_WEIGHT, 20.0))).collect();
                let total: f64 = row.iter().map(|e| e.1).sum();
                row.push((v as u32, -total));
                row
            })
            .collect();
        Self { rows }
    }

    /// Moves the `free` vertices to where Σ |row · x|² is least: one factor of the normal equations, solved twice, the second time for
    /// what rounding left. Where they have no single solution nothing moves.
    fn minimise(&self, x: &mut [DVec3], free: std::ops::Range<usize>) {
        let n = free.len();
        let mut columns: Vec<Vec<(u32, f64)>> = vec![vec![]; n];
        for row in &self.rows {
            let own = || row.iter().filter(|e| free.contains(&(e.0 as usize)));
            for &(a, wa) in own() {
                let below = own().filter(|e| e.0 >= a).map(|&(b, wb)| (b - free.start as u32, wa * wb));
                columns[a as usize - free.start].extend(below);
            }
        }
        let mut lower = LowerTriangle::default();
        for mut column in columns {
            SparseRows::add_up(&mut column);
            lower.column(&column);
        }
        let Ok(factor) = Cholesky::new(&lower) else { return };
        for _ in 0..2 {
            let mut slope = vec![DVec3::ZERO; n];
            for row in &self.rows {
                let energy: DVec3 = row.iter().map(|&(v, w)| w * x[v as usize]).sum();
                for &(v, w) in row.iter().filter(|e| free.contains(&(e.0 as usize))) {
                    slope[v as usize - free.start] -= w * energy;
                }
            }
            for (x, step) in x[free.clone()].iter_mut().zip(factor.solve_points(&slope)) {
                *x += step;
            }
        }
    }
}
