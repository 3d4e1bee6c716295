//! The gap between the rims and the wanted part of the zero set: which curves bound one piece of it, and its triangles.

use crate::bridge::{irregularity, polygon, strip};
use crate::error::Error;
use crate::rim::Rims;
use crate::trim::{Trimmed, join, root};
use glam::DVec3;
use mesh_core::{TriMesh, VertexId, triangle_normal};
use std::collections::BTreeSet;

/// The vertices of rims and borders together, and the curves over them, all with the gap on the left.
pub(crate) struct Curves<'a> {
    pub positions: &'a [DVec3],
    pub normals: &'a [DVec3],
    /// The rims first, then the borders.
    pub closed: &'a [Vec<u32>],
    /// Edges of the wanted faces between border vertices, low vertex first, sorted: no diagonal may repeat them.
    pub taken: &'a [[u32; 2]],
    pub cell: f64,
}

/// Sets of curves that bound one piece of the gap each, as indices: rims from 0, then borders.
///
/// Curves belong together if unwanted faces in front of the rims join them, or if rims face each other more closely
/// than two `width`s, where no wanted face can be.
pub(crate) fn groups(mesh: &TriMesh, rims: &Rims, trimmed: &Trimmed, width: f64) -> Vec<Vec<usize>> {
    let (vertices, rim_count) = (mesh.positions.len() as u32, rims.starts.len());
    let mut parents: Vec<u32> = (0..vertices + rim_count as u32).collect();
    let mut on_border = vec![false; mesh.positions.len()];
    for &v in trimmed.borders.iter().flatten() {
        on_border[v as usize] = true;
    }
    // A vertex behind a rim connects nothing; one of the border belongs to the gap only by its curve, and one that was
    // dropped farther out may be nearer to a rim beyond the wanted faces.
    let rim_of = |v: usize| {
        let near = trimmed.near[v].filter(|n| !on_border[v] && n.side > 0.0 && n.distance < width)?;
        Some(vertices + rims.samples[near.sample as usize].rim)
    };
    let behind = |v: usize| !on_border[v] && trimmed.near[v].is_some_and(|n| n.side <= 0.0);
    for (face, _) in mesh.faces.iter().zip(&trimmed.kept).filter(|(_, kept)| !**kept) {
        let open: Vec<u32> = face.iter().filter(|v| !behind(v.index())).map(|v| v.0).collect();
        open.windows(2).for_each(|w| join(&mut parents, w[0], w[1]));
        for &v in &open {
            if let Some(rim) = rim_of(v as usize) {
                join(&mut parents, v, rim);
            }
        }
        // A face across a rim, seen from its vertices behind: what is in front belongs to that rim.
        for near in face.iter().filter(|v| behind(v.index())).filter_map(|v| trimmed.near[v.index()]) {
            let s = &rims.samples[near.sample as usize];
            for w in face {
                let rim = trimmed.near[w.index()].map_or(s.rim, |n| rims.samples[n.sample as usize].rim);
                if (mesh.positions[w.index()] - s.point).dot(s.conormal) > 0.0 && (rim != s.rim || !behind(w.index())) {
                    let other = if behind(w.index()) { vertices + rim } else { w.0 };
                    join(&mut parents, vertices + s.rim, other);
                }
            }
        }
    }
    for curve in &trimmed.borders {
        curve.windows(2).for_each(|w| join(&mut parents, w[0], w[1]));
    }
    for s in &rims.samples {
        rims.visit(s.point, |i| {
            let t = &rims.samples[i as usize];
            let offset = t.point - s.point;
            if t.rim > s.rim
                && offset.length() < 2.0 * width
                && offset.dot(s.conormal) > 0.0
                && offset.dot(t.conormal) < 0.0
                && s.normal.dot(t.normal) > 0.0
            {
                join(&mut parents, vertices + s.rim, vertices + t.rim);
            }
        });
    }
    for curve in &trimmed.borders {
        // Across a narrow gap faces may have no vertex in it, which leaves a border alone.
        let alone = |parents: &mut [u32]| {
            let own = root(parents, curve[0]);
            (vertices..vertices + rim_count as u32).all(|r| root(parents, r) != own)
        };
        if alone(&mut parents) {
            for near in curve.iter().filter_map(|&v| trimmed.near[v as usize]) {
                join(&mut parents, curve[0], vertices + rims.samples[near.sample as usize].rim);
            }
        }
    }
    let rim_ends = (0..rim_count as u32).map(|r| vertices + r);
    let ends: Vec<u32> = rim_ends.chain(trimmed.borders.iter().map(|c| c[0])).collect();
    let roots: Vec<u32> = ends.into_iter().map(|v| root(&mut parents, v)).collect();
    let mut groups: Vec<Vec<usize>> = vec![];
    for i in 0..roots.len() {
        match groups.iter_mut().find(|g| roots[g[0]] == roots[i]) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

/// Triangles for one piece of the gap.
pub(crate) fn fill(group: &[usize], rims: usize, all: &Curves) -> Result<Vec<[u32; 3]>, Error> {
    let curves: Vec<&[u32]> = group.iter().map(|&i| &*all.closed[i]).collect();
    let here = |i: usize| all.positions[all.closed[i][0] as usize];
    if group[0] >= rims {
        return Err(Error::Leak { rim: 0, at: here(group[0]) });
    }
    let longest = curves.iter().flat_map(|c| sides(c)).map(|[a, b]| all.length(a, b)).fold(0.0, f64::max);
    let mut reaches = std::iter::successors(Some(4.0 * all.cell + longest), |r| Some(3.0 * r)).take(4);
    let made = if let [p, q] = curves[..] {
        reaches.find_map(|reach| all.strip(p, q, reach))
    } else {
        let corners = all.bridged(&curves);
        reaches.find_map(|reach| all.patch(&corners, &curves, reach))
    };
    made.ok_or(Error::Gap { rim: group[0], at: here(group[0]) })
}

fn sides(curve: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    (0..curve.len()).map(|i| [curve[i], curve[(i + 1) % curve.len()]])
}

impl Curves<'_> {
    fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    fn length(&self, a: u32, b: u32) -> f64 {
        self.at(a).distance(self.at(b))
    }

    /// Irregular triangles and such that turn away from the surface's normals are dear.
    fn cost(&self, t: [u32; 3]) -> f64 {
        let corners = t.map(|v| self.at(v));
        let normal = t.iter().map(|&v| self.normals[v as usize]).sum::<DVec3>().normalize_or_zero();
        irregularity(corners) + 2.0 * (1.0 - normal.dot(triangle_normal(corners)))
    }

    /// The nearest pair of places of two curves.
    fn nearest(&self, p: &[u32], q: &[u32]) -> (usize, usize, f64) {
        let mut best = (0, 0, f64::INFINITY);
        for (i, &a) in p.iter().enumerate() {
            for (j, &b) in q.iter().enumerate() {
                let d = self.at(a).distance_squared(self.at(b));
                if d < best.2 {
                    best = (i, j, d);
                }
            }
        }
        best
    }

    /// A strip between two curves, the best of some that start near their nearest vertices.
    fn strip(&self, p: &[u32], q: &[u32], reach: f64) -> Option<Vec<[u32; 3]>> {
        const STARTS: [usize; 3] = [0, 1, 2];
        let cost = |t: [u32; 3]| {
            let far = |a: u32, b: u32| self.at(a).distance_squared(self.at(b)) > reach * reach;
            if far(t[0], t[2]) || far(t[1], t[2]) { f64::INFINITY } else { self.cost(t) }
        };
        let (i, j, _) = self.nearest(p, q);
        let turned = |c: &[u32], by: usize| [&c[by..], &c[..by]].concat();
        let first = turned(p, i);
        let mut best: Option<(f64, Vec<[u32; 3]>)> = None;
        for shift in STARTS {
            let second = turned(q, (j + q.len() + shift - 1) % q.len());
            if let Some(made) = strip(&first, &second, &cost).filter(|m| best.as_ref().is_none_or(|b| m.0 < b.0)) {
                best = Some(made);
            }
        }
        best.map(|b| b.1)
    }

    /// Any number of curves as one polygon, by bridges between the nearest of them, each passed twice.
    fn bridged(&self, curves: &[&[u32]]) -> Vec<u32> {
        // What is left, with the nearest vertex of the polygon, the place nearest to it, and how far they are apart.
        let link = |from: &[u32], to: &[u32]| {
            let (i, j, distance) = self.nearest(from, to);
            (from[i], j, distance)
        };
        let mut corners = curves[0].to_vec();
        let mut left: Vec<_> = curves[1..].iter().map(|&c| (c, link(curves[0], c))).collect();
        while let Some(k) = (0..left.len()).min_by(|&a, &b| left[a].1.2.total_cmp(&left[b].1.2)) {
            let (curve, (vertex, place, _)) = left.remove(k);
            // Round the polygon to its end of the bridge, across, round the curve and back across.
            let end = corners.iter().position(|&v| v == vertex).unwrap_or(0);
            corners.rotate_left(end);
            corners.push(corners[0]);
            corners.extend(curve.iter().cycle().skip(place).take(curve.len() + 1));
            for (other, best) in &mut left {
                let new = link(curve, other);
                if new.2 < best.2 {
                    *best = new;
                }
            }
        }
        corners
    }

    /// The polygon triangulated at least cost.
    fn patch(&self, corners: &[u32], curves: &[&[u32]], reach: f64) -> Option<Vec<[u32; 3]>> {
        let mut bordering: Vec<[u32; 2]> =
            curves.iter().flat_map(|c| sides(c)).map(|[a, b]| [a.min(b), a.max(b)]).collect();
        bordering.sort_unstable();
        let may_join = |i: usize, j: usize| {
            let e = [corners[i].min(corners[j]), corners[i].max(corners[j])];
            self.length(e[0], e[1]) <= reach
                && bordering.binary_search(&e).is_err()
                && self.taken.binary_search(&e).is_err()
        };
        let faces = polygon(corners, may_join, &|t| self.cost(t))?;
        let mut used = BTreeSet::new();
        let fresh = faces.iter().all(|t| (0..3).all(|k| used.insert([t[k], t[(k + 1) % 3]])));
        fresh.then_some(faces)
    }
}

/// Edges of faces that join two vertices of the border without being part of it, low vertex first, sorted.
pub(crate) fn chords(faces: &[[VertexId; 3]], on_border: &[bool]) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> = faces
        .iter()
        .flat_map(|f| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]])
        .filter(|e| e.iter().all(|v| on_border[v.index()]))
        .map(|[a, b]| [a.0.min(b.0), a.0.max(b.0)])
        .collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
