//! Where points lie along the edges that carry them: by pairs of doubles with a bound on the error, and exactly where
//! that does not tell two points apart.

use super::part::{Key, Part, Simplex};
use crate::exact::{Expansion, PAIR_ERROR, Pair, cross2, volume, volume_pair};
use crate::predicate::{facing, project};
use glam::DVec3;
use mesh_core::{HalfedgeId, Positions};
use std::cmp::Ordering;

/// A node within an edge.
pub(super) struct OnEdge {
    pub edge: u32,
    pub node: u32,
    /// What of the other part meets the edge there.
    carrier: Simplex,
    t: Pair,
    error: f64,
}

impl OnEdge {
    pub fn new(parts: &[Part; 2], which: usize, edge: u32, carrier: Simplex, node: u32) -> Self {
        let (t, error) = parameter(parts, which, edge, carrier);
        Self { edge, node, carrier, t, error }
    }

    /// Which of two points comes first along their common edge: by pairs of doubles if their error allows, else exactly.
    pub fn compare(&self, other: &Self, parts: &[Part; 2], which: usize) -> Ordering {
        let gap = self.t.sub(other.t).hi;
        if gap.abs() > self.error + other.error {
            return gap.total_cmp(&0.0);
        }
        let [(n, d), (m, e)] = [self, other].map(|p| exact_parameter(parts, which, p.edge, p.carrier));
        let order = n.mul(&e).sub(&m.mul(&d)).sign();
        let order = if d.sign() == e.sign() { order } else { order.reverse() };
        // Equal places under different names: only where a mesh meets itself. Any fixed order will do.
        order.then(self.carrier.cmp(&other.carrier))
    }
}

/// The place of a point in which two faces touch.
pub(super) fn touched_place(parts: &[Part; 2], key: &Key) -> DVec3 {
    match *key {
        [Simplex::Vertex(v), _] => parts[0].mesh.mesh().positions[v as usize],
        [_, Simplex::Vertex(v)] => parts[1].mesh.mesh().positions[v as usize],
        _ => place(parts, key).1,
    }
}

/// The place of a new point, and its parameter on the edge that carries it.
pub(super) fn place(parts: &[Part; 2], key: &Key) -> (f64, DVec3) {
    let (which, edge) = match *key {
        [Simplex::Edge(e), _] => (0, e),
        [_, Simplex::Edge(e)] => (1, e),
        _ => return (0.0, DVec3::ZERO),
    };
    let (t, _) = parameter(parts, which, edge, key[1 - which]);
    let [p, q] = parts[which].mesh.ends(HalfedgeId(edge));
    let x = |i: usize| Pair::sum(q[i], -p[i]).mul(t).add(Pair { hi: p[i], lo: 0.0 }).hi;
    (t.hi, DVec3::new(x(0), x(1), x(2)))
}

/// Where along an edge (0 at its tail, 1 at its head) a simplex of the other part meets it, and a bound on the error.
fn parameter(parts: &[Part; 2], which: usize, edge: u32, carrier: Simplex) -> (Pair, f64) {
    let [p, q] = parts[which].ends(edge);
    let other = &parts[1 - which];
    let (n, d, error) = match carrier {
        Simplex::Face(f) => {
            let t = other.triangle(f);
            let ((n, en), (m, em)) = (volume_pair(t[0], t[1], t[2], p), volume_pair(t[0], t[1], t[2], q));
            (n, n.sub(m), 2.0 * en + em)
        }
        Simplex::Edge(e) => {
            let [r, s] = other.ends(e);
            let [p, q, r, s] = planar(p, q, r, s);
            let cross = |u: [Pair; 2], v: [Pair; 2]| u[0].mul(v[1]).sub(u[1].mul(v[0]));
            let difference = |u: [f64; 2], v: [f64; 2]| [0, 1].map(|i| Pair::sum(u[i], -v[i]));
            let size = |u: [Pair; 2]| u[0].hi.abs() + u[1].hi.abs();
            let (pr, pq, rs) = (difference(r, p), difference(q, p), difference(s, r));
            (cross(pr, rs), cross(pq, rs), PAIR_ERROR * (size(pr) + 2.0 * size(pq)) * size(rs))
        }
        Simplex::Vertex(v) => {
            let k = longest_axis(q - p);
            let v = other.points[v as usize];
            (Pair::sum(v[k], -p[k]), Pair::sum(q[k], -p[k]), PAIR_ERROR * (q[k] - p[k]).abs())
        }
    };
    let error = error / d.hi.abs();
    if error < 1e-22 {
        return (n.div(d), error);
    }
    let (n, d) = exact_parameter(parts, which, edge, carrier);
    (n.rounded().div(d.rounded()), PAIR_ERROR)
}

/// The same as an exact fraction.
fn exact_parameter(parts: &[Part; 2], which: usize, edge: u32, carrier: Simplex) -> (Expansion, Expansion) {
    let [p, q] = parts[which].ends(edge);
    let other = &parts[1 - which];
    match carrier {
        Simplex::Face(f) => {
            let t = other.triangle(f);
            let n = volume(t[0], t[1], t[2], p);
            let d = n.sub(&volume(t[0], t[1], t[2], q));
            (n, d)
        }
        Simplex::Edge(e) => {
            let [r, s] = other.ends(e);
            let [p, q, r, s] = planar(p, q, r, s);
            (cross2(p, r, r, s), cross2(p, q, r, s))
        }
        Simplex::Vertex(v) => {
            let k = longest_axis(q - p);
            let v = other.points[v as usize];
            (Expansion::difference(v[k], p[k]), Expansion::difference(q[k], p[k]))
        }
    }
}

/// Four coplanar points, not all on one line, seen along an axis that keeps them so.
fn planar(p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> [[f64; 2]; 4] {
    let (axis, _) = facing(&[p, q, r]).or(facing(&[p, q, s])).unwrap_or((2, 1));
    [p, q, r, s].map(|x| project(axis, x))
}

fn longest_axis(d: DVec3) -> usize {
    let a = d.abs();
    if a.x >= a.y && a.x >= a.z {
        0
    } else if a.y >= a.z {
        1
    } else {
        2
    }
}
