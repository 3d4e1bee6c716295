//! Constrained Delaunay triangulation of one cut face, in the plane it faces.
//!
//! Points on the face's sides are inserted by name, each splitting the border edge it lies on, because their rounded
//! places are not exactly on the side. Points inside and constraints are placed by exact predicates on the rounded
//! places. Every triangle that comes out turns left strictly, or the attempt fails and says which two points are in
//! each other's way.

use crate::predicate::turn2;
use robust::Coord;

mod conflict;
mod constrain;
pub(crate) use conflict::Conflict;

const NONE: u32 = u32::MAX;

/// A triangle with its neighbours: `next[i]` lies across the edge from `v[i]` to `v[i+1]`.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    v: [u32; 3],
    next: [u32; 3],
    fixed: [bool; 3],
}

/// Reusable working memory.
#[derive(Default)]
pub(crate) struct Triangulator {
    xy: Vec<[f64; 2]>,
    triangles: Vec<Triangle>,
    /// Some triangle at each point.
    at: Vec<u32>,
    stack: Vec<(u32, u32)>,
    crossed: Vec<[u32; 2]>,
    /// How far rounding may have moved a point.
    grain: f64,
}

impl Triangulator {
    /// Triangulates the polygon of `sides`, each the local points strictly within a side of the triangle 0, 1, 2 in
    /// order, with `inner` points and `constraints`. `xy` must turn left at the corners. Each result turns left.
    /// Points may have been moved by rounding, but by no more than `grain`.
    pub(crate) fn run(
        &mut self,
        xy: &[[f64; 2]],
        sides: &[Vec<u32>; 3],
        inner: &[u32],
        constraints: &[[u32; 2]],
        grain: f64,
        out: &mut Vec<[u32; 3]>,
    ) -> Result<(), Conflict> {
        self.grain = grain;
        self.attempt(xy, sides, inner, constraints, out).map_err(|conflict| match conflict {
            Conflict::Crossing(_) => self.closest_pair().unwrap_or(conflict),
            named => named,
        })
    }

    fn attempt(
        &mut self,
        xy: &[[f64; 2]],
        sides: &[Vec<u32>; 3],
        inner: &[u32],
        constraints: &[[u32; 2]],
        out: &mut Vec<[u32; 3]>,
    ) -> Result<(), Conflict> {
        self.xy.clear();
        self.xy.extend_from_slice(xy);
        self.triangles.clear();
        self.triangles.push(Triangle { v: [0, 1, 2], next: [NONE; 3], fixed: [true; 3] });
        self.at.clear();
        self.at.resize(xy.len(), 0);
        for (k, side) in sides.iter().enumerate() {
            self.split_side(k as u32, (k as u32 + 1) % 3, side);
        }
        if !inner.is_empty() || sides.iter().map(Vec::len).sum::<usize>() > 2 {
            self.relax_all();
        }
        let mut from = 0;
        for &p in inner {
            from = self.insert(p, from)?;
        }
        for &c in constraints {
            self.constrain(c)?;
        }
        self.relax_all();
        for t in &self.triangles {
            if self.turn(t.v[0], t.v[1], t.v[2]) <= 0 {
                let sides = [0, 1, 2].map(|i| (t.fixed[i], ([t.v[i], t.v[(i + 1) % 3]], t.v[(i + 2) % 3])));
                let fixed: Vec<_> = sides.iter().filter(|s| s.0).map(|s| s.1).collect();
                return Err(if fixed.is_empty() { Conflict::Crossing(t.v[0]) } else { self.conflict(&fixed) });
            }
            out.push(t.v);
        }
        Ok(())
    }

    fn turn(&self, a: u32, b: u32, c: u32) -> i8 {
        turn2(self.xy[a as usize], self.xy[b as usize], self.xy[c as usize])
    }

    /// Sets a triangle and tells its neighbours and corners.
    fn set(&mut self, t: u32, triangle: Triangle) {
        self.triangles[t as usize] = triangle;
        for i in 0..3 {
            self.at[triangle.v[i] as usize] = t;
            let n = triangle.next[i];
            if n != NONE {
                let (a, b) = (triangle.v[i], triangle.v[(i + 1) % 3]);
                let other = &mut self.triangles[n as usize];
                if let Some(j) = (0..3).find(|&j| other.v[j] == b && other.v[(j + 1) % 3] == a) {
                    other.next[j] = t;
                }
            }
        }
    }

    fn new_triangle(&mut self) -> u32 {
        self.triangles.push(Triangle { v: [NONE; 3], next: [NONE; 3], fixed: [false; 3] });
        self.triangles.len() as u32 - 1
    }

    /// Puts points on the border edge from `u` to `v`.
    fn split_side(&mut self, u: u32, v: u32, points: &[u32]) {
        let on = |t: &Triangle| (0..3).find(|&i| t.next[i] == NONE && t.v[i] == u && t.v[(i + 1) % 3] == v);
        let found = self.triangles.iter().enumerate().find_map(|(t, tri)| on(tri).map(|i| (t as u32, i)));
        let Some((mut t, mut i)) = found else { return };
        for &p in points {
            (t, i) = self.split_edge(t, i, p);
        }
    }

    /// Splits triangle `t` at `p` on its border edge `i`; returns the half at the edge's far end and that edge.
    fn split_edge(&mut self, t: u32, i: usize, p: u32) -> (u32, usize) {
        let old = self.triangles[t as usize];
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (u, v, w) = (old.v[i], old.v[j], old.v[k]);
        let n = self.new_triangle();
        self.set(n, Triangle { v: [p, v, w], next: [NONE, old.next[j], t], fixed: [true, old.fixed[j], false] });
        self.set(t, Triangle { v: [u, p, w], next: [NONE, n, old.next[k]], fixed: [true, false, old.fixed[k]] });
        (n, 0)
    }

    /// Inserts an inner point, walking from a triangle; returns one at the point.
    fn insert(&mut self, p: u32, from: u32) -> Result<u32, Conflict> {
        let mut t = from;
        let mut steps = 0;
        loop {
            let tri = self.triangles[t as usize];
            let s = [0, 1, 2].map(|i| self.turn(tri.v[i], tri.v[(i + 1) % 3], p));
            // Starting from another side each step keeps the walk from going round in circles.
            if let Some(i) = (0..3).map(|i| (i + steps) % 3).find(|&i| s[i] < 0) {
                t = tri.next[i];
                steps += 1;
                if t == NONE || steps > 4 * self.triangles.len() + 16 {
                    return Err(self.conflict(&[([tri.v[i], tri.v[(i + 1) % 3]], p)]));
                }
                continue;
            }
            match [0, 1, 2].map(|i| s[i] == 0) {
                [false, false, false] => self.split_face(t, p),
                [true, false, false] => self.split_inner_edge(t, 0, p)?,
                [false, true, false] => self.split_inner_edge(t, 1, p)?,
                [false, false, true] => self.split_inner_edge(t, 2, p)?,
                [true, _, true] => return Err(Conflict::Merge(tri.v[0].min(p), tri.v[0].max(p))),
                [true, true, _] => return Err(Conflict::Merge(tri.v[1].min(p), tri.v[1].max(p))),
                [_, true, true] => return Err(Conflict::Merge(tri.v[2].min(p), tri.v[2].max(p))),
            }
            self.relax();
            return Ok(self.at[p as usize]);
        }
    }

    fn split_face(&mut self, t: u32, p: u32) {
        let old = self.triangles[t as usize];
        let [a, b, c] = old.v;
        let (n1, n2) = (self.new_triangle(), self.new_triangle());
        let [x, y, z] = old.next;
        let [fx, fy, fz] = old.fixed;
        self.set(t, Triangle { v: [a, b, p], next: [x, n1, n2], fixed: [fx, false, false] });
        self.set(n1, Triangle { v: [b, c, p], next: [y, n2, t], fixed: [fy, false, false] });
        self.set(n2, Triangle { v: [c, a, p], next: [z, t, n1], fixed: [fz, false, false] });
        self.stack.extend([(a, b), (b, c), (c, a)]);
    }

    fn split_inner_edge(&mut self, t: u32, i: usize, p: u32) -> Result<(), Conflict> {
        let old = self.triangles[t as usize];
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (u, v, w) = (old.v[i], old.v[j], old.v[k]);
        let m = old.next[i];
        if m == NONE || old.fixed[i] {
            return Err(self.conflict(&[([u, v], p)]));
        }
        let other = self.triangles[m as usize];
        let Some(l) = (0..3).find(|&l| other.next[l] == t && other.v[l] == v) else {
            return Err(Conflict::Crossing(p));
        };
        let x = other.v[(l + 2) % 3];
        let (n1, n2) = (self.new_triangle(), self.new_triangle());
        let (o1, o2) = ((l + 1) % 3, (l + 2) % 3);
        self.set(t, Triangle { v: [u, p, w], next: [m, n1, old.next[k]], fixed: [false, false, old.fixed[k]] });
        self.set(n1, Triangle { v: [p, v, w], next: [n2, old.next[j], t], fixed: [false, old.fixed[j], false] });
        self.set(m, Triangle { v: [p, u, x], next: [t, other.next[o1], n2], fixed: [false, other.fixed[o1], false] });
        self.set(n2, Triangle { v: [v, p, x], next: [n1, m, other.next[o2]], fixed: [false, false, other.fixed[o2]] });
        self.stack.extend([(v, w), (w, u), (u, x), (x, v)]);
        Ok(())
    }

    /// The triangle with the directed edge `a`–`b`, by turning around `a`.
    fn find(&self, a: u32, b: u32) -> Option<(u32, usize)> {
        self.around(a, |tri, i| (tri.v[(i + 1) % 3] == b).then_some(i))
    }

    /// Visits the triangles around `a`; `visit` gets each with the corner that is `a`.
    fn around<R>(&self, a: u32, mut visit: impl FnMut(&Triangle, usize) -> Option<R>) -> Option<(u32, R)> {
        let start = self.at[a as usize];
        let mut t = start;
        for clockwise in [false, true] {
            while t != NONE {
                let tri = &self.triangles[t as usize];
                let i = tri.v.iter().position(|&v| v == a)?;
                if let Some(r) = visit(tri, i) {
                    return Some((t, r));
                }
                t = tri.next[if clockwise { i } else { (i + 2) % 3 }];
                if t == start {
                    return None;
                }
            }
            // The border was met: go back to the start and turn the other way.
            let tri = &self.triangles[start as usize];
            let i = tri.v.iter().position(|&v| v == a)?;
            t = tri.next[i];
        }
        None
    }

    /// Replaces the edge `i` of `t` by the other diagonal of its two triangles.
    fn flip(&mut self, t: u32, i: usize) -> [u32; 2] {
        let old = self.triangles[t as usize];
        let m = old.next[i];
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let (u, v, w) = (old.v[i], old.v[j], old.v[k]);
        let other = self.triangles[m as usize];
        let l = (0..3).find(|&l| other.v[l] == v && other.v[(l + 1) % 3] == u).unwrap_or(0);
        let (o1, o2) = ((l + 1) % 3, (l + 2) % 3);
        let x = other.v[o2];
        self.set(
            t,
            Triangle {
                v: [u, x, w],
                next: [other.next[o1], m, old.next[k]],
                fixed: [other.fixed[o1], false, old.fixed[k]],
            },
        );
        self.set(
            m,
            Triangle {
                v: [x, v, w],
                next: [other.next[o2], old.next[j], t],
                fixed: [other.fixed[o2], old.fixed[j], false],
            },
        );
        [w, x]
    }

    /// The corners around edge `i` of `t` (u, v, then apexes w and x), if it may be flipped without folding.
    fn quad(&self, t: u32, i: usize) -> Option<[u32; 4]> {
        let tri = &self.triangles[t as usize];
        let m = tri.next[i];
        if m == NONE || tri.fixed[i] {
            return None;
        }
        let (u, v, w) = (tri.v[i], tri.v[(i + 1) % 3], tri.v[(i + 2) % 3]);
        let x = *self.triangles[m as usize].v.iter().find(|&&q| q != u && q != v)?;
        (self.turn(u, x, w) > 0 && self.turn(x, v, w) > 0).then_some([u, v, w, x])
    }

    fn relax_all(&mut self) {
        for t in 0..self.triangles.len() {
            let tri = self.triangles[t];
            for i in 0..3 {
                if !tri.fixed[i] && tri.v[i] < tri.v[(i + 1) % 3] {
                    self.stack.push((tri.v[i], tri.v[(i + 1) % 3]));
                }
            }
        }
        self.relax();
    }

    /// Flips edges on the stack until all are locally Delaunay.
    fn relax(&mut self) {
        let mut budget = 64 + 16 * self.triangles.len() + self.triangles.len() * self.triangles.len();
        while let Some((a, b)) = self.stack.pop() {
            let Some((t, i)) = self.find(a, b) else { continue };
            let Some([u, v, w, x]) = self.quad(t, i) else { continue };
            let c = |p: u32| Coord { x: self.xy[p as usize][0], y: self.xy[p as usize][1] };
            // A flat or turned triangle is always worth flipping away; the test of circles needs one that turns left.
            let bad =
                self.turn(u, v, w) <= 0 || self.turn(v, u, x) <= 0 || robust::incircle(c(u), c(v), c(w), c(x)) > 0.0;
            if bad && budget > 0 {
                budget -= 1;
                self.flip(t, i);
                self.stack.extend([(u, x), (x, v), (v, w), (w, u)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area2(xy: &[[f64; 2]], t: [u32; 3]) -> f64 {
        let [a, b, c] = t.map(|i| xy[i as usize]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    proptest! {
        /// Random points, and a random path as constraints: the triangles tile the face and contain the path.
        #[test]
        fn tiles_the_face_and_keeps_the_constraints(
            inner in proptest::collection::vec((0.05f64..0.9, 0.05f64..0.9), 0..40),
            on in proptest::collection::vec((0usize..3, 0.01f64..0.99), 0..12),
        ) {
            let mut xy = vec![[0.0, 0.0], [1.0, 0.1], [0.2, 1.0]];
            let mut sides = [vec![], vec![], vec![]];
            let mut on = on;
            on.sort_by(|a, b| a.1.total_cmp(&b.1));
            on.dedup_by(|a, b| a.1 == b.1);
            for (k, t) in on {
                let (p, q) = (xy[k], xy[(k + 1) % 3]);
                sides[k].push(xy.len() as u32);
                xy.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
            }
            let first = xy.len() as u32;
            // Sorted by angle around a point these make a star-shaped path, which does not cross itself.
            let mut points: Vec<[f64; 2]> = inner
                .into_iter()
                .map(|(s, t)| (s * (1.0 - t), t * 0.98 + 0.01))
                .map(|(s, t)| [s + 0.2 * t, 0.1 * s + t])
                .collect();
            points.sort_by(|a, b| (a[1] - 0.35).atan2(a[0] - 0.4).total_cmp(&(b[1] - 0.35).atan2(b[0] - 0.4)));
            points.dedup();
            xy.extend(&points);
            let inner: Vec<u32> = (first..xy.len() as u32).collect();
            let constraints: Vec<[u32; 2]> = inner.windows(2).map(|w| [w[0], w[1]])
                .filter(|c| turn2(xy[c[0] as usize], xy[c[1] as usize], [0.4, 0.35]) > 0).collect();
            let mut out = vec![];
            let result = Triangulator::default().run(&xy, &sides, &inner, &constraints, 1e-15, &mut out);
            prop_assert!(result.is_ok(), "{result:?}");
            let border = 3 + sides.iter().map(Vec::len).sum::<usize>();
            prop_assert_eq!(out.len(), border - 2 + 2 * inner.len());
            let total: f64 = out.iter().map(|&t| area2(&xy, t)).sum();
            prop_assert!((total - area2(&xy, [0, 1, 2])).abs() < 1e-12);
            prop_assert!(out.iter().all(|&t| area2(&xy, t) > 0.0));
            for c in constraints {
                let has = |t: &[u32; 3]| (0..3).any(|i| [t[i], t[(i + 1) % 3]] == c);
                prop_assert!(out.iter().any(has), "{c:?} missing");
            }
        }
    }
}
