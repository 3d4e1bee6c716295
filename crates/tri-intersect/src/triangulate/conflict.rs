//! What rounding made of a face's points: which of them are to be merged, which edges bent.

use super::Triangulator;

/// What rounding brought too close to tell apart, and how to make a triangulation possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Conflict {
    /// Two points that should be one.
    Merge(u32, u32),
    /// A border edge or constraint that should go through a point.
    Bend { edge: [u32; 2], via: u32 },
    /// Points farther apart than rounding explains are in each other's way near this one.
    Crossing(u32),
}

impl Triangulator {
    /// The two closest points, if rounding may have confused them.
    pub(super) fn closest_pair(&self) -> Option<Conflict> {
        let mut order: Vec<u32> = (0..self.xy.len() as u32).collect();
        order.sort_by(|&a, &b| self.xy[a as usize][0].total_cmp(&self.xy[b as usize][0]));
        let mut best = (self.grain, None);
        for (i, &a) in order.iter().enumerate() {
            let near = |b: &&u32| self.xy[**b as usize][0] - self.xy[a as usize][0] <= self.grain;
            for &b in order[i + 1..].iter().take_while(near) {
                if self.distance(a, b) < best.0 {
                    best = (self.distance(a, b), Some(Conflict::Merge(a.min(b), a.max(b))));
                }
            }
        }
        best.1
    }

    pub(super) fn distance(&self, a: u32, b: u32) -> f64 {
        let (p, q) = (self.xy[a as usize], self.xy[b as usize]);
        (p[0] - q[0]).hypot(p[1] - q[1])
    }

    /// Distance of `v` from the segment between p and q, if its foot is within.
    pub(super) fn off_edge(&self, [p, q]: [u32; 2], v: u32) -> f64 {
        let [p, q, v] = [p, q, v].map(|i| self.xy[i as usize]);
        let (d, e) = ([q[0] - p[0], q[1] - p[1]], [v[0] - p[0], v[1] - p[1]]);
        let length = d[0].hypot(d[1]);
        let along = (d[0] * e[0] + d[1] * e[1]) / length;
        if along < 0.0 || along > length { f64::INFINITY } else { (d[0] * e[1] - d[1] * e[0]).abs() / length }
    }

    /// The smallest change that lets points pass edges: each candidate is an edge and a point in its way.
    pub(super) fn conflict(&self, candidates: &[([u32; 2], u32)]) -> Conflict {
        let mut best = (self.grain, Conflict::Crossing(candidates[0].1));
        for &([p, q], v) in candidates {
            for end in [p, q] {
                if end != v && self.distance(end, v) < best.0 {
                    best = (self.distance(end, v), Conflict::Merge(end.min(v), end.max(v)));
                }
            }
        }
        if let Conflict::Merge(..) = best.1 {
            return best.1;
        }
        for &(edge, via) in candidates {
            if self.off_edge(edge, via) < best.0 {
                best = (self.off_edge(edge, via), Conflict::Bend { edge, via });
            }
        }
        best.1
    }

    /// Two edges that cross.
    pub(super) fn clash(&self, e: [u32; 2], f: [u32; 2]) -> Conflict {
        self.conflict(&[(e, f[0]), (e, f[1]), (f, e[0]), (f, e[1])])
    }
}
