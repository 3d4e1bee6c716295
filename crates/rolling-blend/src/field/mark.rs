//! Which part of the surface the ball sweeps over: a scalar on a refined copy of the mesh.

use super::sides::Sides;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceMap, Faces, HalfedgeId, Positions, TriMesh, VertexId};
use rayon::prelude::*;
use spine::RadiusField;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// Beyond this share of the radius the scalar need not be known.
const BAND: f64 = 0.6;
/// Length over which the scalar is smoothed, in radii.
const SIGMA: f64 = 0.25;
/// What is nearer to the seam than this share of the radius is always inside.
const LEAST: f64 = 0.12;
/// Pieces of the surface within the region that are smaller than this, in radii, are swallowed.
const SPECK: f64 = 0.5;

/// The scalar at every vertex, in radii: negative where the ball sweeps over the surface.
///
/// A ball that touches a side at p, with its centre at p + r·n, blends there when it also reaches into the other side:
/// where d(p + r·n) < r. That is the level set b = c·r of the canal field, in a form that needs no division and that
/// rough normals disturb less. It is smoothed along the surface, and made one region around each seam.
pub(crate) fn scalar(
    mesh: &Connected<TriMesh>,
    of: &FaceMap<u8>,
    seam: &[VertexId],
    sides: &Sides<'_>,
    radius: &RadiusField,
) -> Vec<f64> {
    let raw = scan(mesh, of, seam, sides, radius);
    let mut value = smoothed(mesh, &raw, SIGMA * radius.base);
    let far = 0.5 * radius.base;
    for (v, d) in reach(mesh, seam, far) {
        let r = radius.at(mesh.position(v)).0;
        value[v.index()] = value[v.index()].min(d / r - LEAST);
    }
    one_region(mesh, &mut value, seam, radius);
    value
}

/// d(p + r·n) − r over r around the seam, as far as it is below [`BAND`]; infinite beyond.
fn scan(
    mesh: &Connected<TriMesh>,
    of: &FaceMap<u8>,
    seam: &[VertexId],
    sides: &Sides<'_>,
    radius: &RadiusField,
) -> Vec<f64> {
    let measure = |v: VertexId| {
        let p = mesh.position(v);
        let r = radius.at(p).0;
        let Some(own) = mesh.outgoing(v).map(|h| usize::from(of[h.face()])).filter(|&k| k < 2) else { return 1.0 };
        sides.seen(own, p).map_or(1.0, |s| sides.distance(1 - own, p + r * s.normal) / r - 1.0).clamp(-1.0, 1.0)
    };
    let mut value = vec![f64::NAN; mesh.vertex_count()];
    let mut next = seam.to_vec();
    while !next.is_empty() {
        let found: Vec<f64> = next.par_iter().with_min_len(32).map(|&v| measure(v)).collect();
        for (v, f) in next.iter().zip(&found) {
            value[v.index()] = *f;
        }
        let front = next.iter().zip(&found).filter(|(_, f)| **f < BAND).map(|(v, _)| *v);
        let mut beyond: Vec<VertexId> =
            front.flat_map(|v| mesh.ring(v).map(|h| mesh.head(h))).filter(|n| value[n.index()].is_nan()).collect();
        beyond.sort_unstable();
        beyond.dedup();
        next = beyond;
    }
    // The seam itself is always under the ball.
    for v in seam {
        value[v.index()] = value[v.index()].min(-0.1);
    }
    value.iter_mut().filter(|f| f.is_nan()).for_each(|f| *f = f64::INFINITY);
    value
}

/// One implicit step of the heat equation to time σ² over the vertices that have a value: (M + σ²L)·u = M·f.
fn smoothed(mesh: &Connected<TriMesh>, value: &[f64], sigma: f64) -> Vec<f64> {
    let ids: Vec<VertexId> = mesh.vertex_ids().filter(|v| value[v.index()].is_finite()).collect();
    let mut own = vec![u32::MAX; value.len()];
    for (i, v) in ids.iter().enumerate() {
        own[v.index()] = i as u32;
    }
    let mut mass = vec![0.0; ids.len()];
    let (mut columns, mut starts) = (Vec::<(u32, f64)>::new(), vec![0]);
    for (i, &v) in ids.iter().enumerate() {
        for h in mesh.ring(v) {
            let corners = mesh.triangle(h.face());
            mass[i] += mesh_core::area_vector(corners).length() / 3.0;
            let j = own[mesh.head(h).index()];
            if j != u32::MAX {
                let weight = cotangent(mesh, h) + mesh.twin(h).map_or(0.0, |t| cotangent(mesh, t));
                columns.push((j, 0.5 * sigma * sigma * weight));
            }
        }
        starts.push(columns.len());
    }
    let apply = |x: &[f64]| -> Vec<f64> {
        let row = |i: usize| {
            let flow: f64 = columns[starts[i]..starts[i + 1]].iter().map(|&(j, w)| w * (x[i] - x[j as usize])).sum();
            mass[i] * x[i] + flow
        };
        (0..x.len()).into_par_iter().with_min_len(1024).map(row).collect()
    };
    let diagonal: Vec<f64> =
        (0..ids.len()).map(|i| mass[i] + columns[starts[i]..starts[i + 1]].iter().map(|c| c.1).sum::<f64>()).collect();
    let mut x: Vec<f64> = ids.iter().map(|v| value[v.index()]).collect();
    let right: Vec<f64> = x.iter().zip(&mass).map(|(f, m)| f * m).collect();
    conjugate_gradients(&apply, &diagonal, &right, &mut x);
    let mut smoothed = value.to_vec();
    for (v, x) in ids.iter().zip(x) {
        smoothed[v.index()] = x;
    }
    smoothed
}

fn conjugate_gradients(apply: &impl Fn(&[f64]) -> Vec<f64>, diagonal: &[f64], right: &[f64], x: &mut [f64]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(p, q)| p * q).sum::<f64>();
    let mut residual: Vec<f64> = apply(x).iter().zip(right).map(|(a, b)| b - a).collect();
    let scale = |r: &[f64]| -> Vec<f64> { r.iter().zip(diagonal).map(|(r, d)| r / d.max(f64::MIN_POSITIVE)).collect() };
    let mut scaled = scale(&residual);
    let mut direction = scaled.clone();
    let mut size = dot(&residual, &scaled);
    let enough = 1e-16 * size;
    for _ in 0..400 {
        if size <= enough {
            break;
        }
        let image = apply(&direction);
        let step = size / dot(&direction, &image);
        for i in 0..x.len() {
            x[i] += step * direction[i];
            residual[i] -= step * image[i];
        }
        scaled = scale(&residual);
        let next = dot(&residual, &scaled);
        for (d, s) in direction.iter_mut().zip(&scaled) {
            *d = s + next / size * *d;
        }
        size = next;
    }
}

/// Cotangent of the angle opposite to `h` in its face.
fn cotangent(mesh: &Connected<TriMesh>, h: HalfedgeId) -> f64 {
    let [a, b, c] = [mesh.tail(h), mesh.head(h), mesh.tail(h.prev())].map(|v| mesh.position(v));
    let (u, v) = (a - c, b - c);
    // Clamping negative ones would spoil linear functions; the sum is definite as it is.
    u.dot(v) / u.cross(v).length().max(1e-4 * (u.length_squared() + v.length_squared())).max(f64::MIN_POSITIVE)
}

/// Distances from the seam along edges, up to `far`.
fn reach(mesh: &Connected<TriMesh>, seam: &[VertexId], far: f64) -> Vec<(VertexId, f64)> {
    // Non-negative floats are ordered as their bits are.
    let mut best = vec![f64::INFINITY; mesh.vertex_count()];
    let mut queue: BinaryHeap<Reverse<(u64, VertexId)>> = seam.iter().map(|&v| Reverse((0, v))).collect();
    for v in seam {
        best[v.index()] = 0.0;
    }
    let mut found = vec![];
    while let Some(Reverse((bits, v))) = queue.pop() {
        let d = f64::from_bits(bits);
        if d > best[v.index()] {
            continue;
        }
        found.push((v, d));
        for h in mesh.ring(v) {
            let n = mesh.head(h);
            let there = d + mesh.position(v).distance(mesh.position(n));
            if there < best[n.index()] && there < far {
                best[n.index()] = there;
                queue.push(Reverse((there.to_bits(), n)));
            }
        }
    }
    found
}

/// What does not hang together with the seam is outside, and specks within the region are inside.
fn one_region(mesh: &Connected<TriMesh>, value: &mut [f64], seam: &[VertexId], radius: &RadiusField) {
    const SLIGHT: f64 = 0.02;
    let neighbours = |v: VertexId| mesh.ring(v).map(|h| mesh.head(h));
    let mut reached = vec![false; value.len()];
    let mut queue: VecDeque<VertexId> = seam.iter().copied().collect();
    while let Some(v) = queue.pop_front() {
        if !std::mem::replace(&mut reached[v.index()], true) {
            queue.extend(neighbours(v).filter(|n| value[n.index()] < 0.0 && !reached[n.index()]));
        }
    }
    for (f, _) in value.iter_mut().zip(&reached).filter(|(f, r)| **f < 0.0 && !**r) {
        *f = SLIGHT;
    }
    let inside = reached;
    let mut seen = inside.clone();
    for start in mesh.vertex_ids() {
        if seen[start.index()] || mesh.outgoing(start).is_none() {
            continue;
        }
        let p: DVec3 = mesh.position(start);
        let near = SPECK * radius.at(p).0;
        let (mut piece, mut at, mut small) = (vec![start], 0, true);
        seen[start.index()] = true;
        while at < piece.len() {
            small &= mesh.position(piece[at]).distance(p) < near;
            for n in neighbours(piece[at]) {
                if !std::mem::replace(&mut seen[n.index()], true) {
                    piece.push(n);
                }
            }
            at += 1;
        }
        if small {
            for v in piece {
                value[v.index()] = -SLIGHT;
            }
        }
    }
    // Zeros would put curves through vertices.
    value.iter_mut().filter(|f| **f == 0.0).for_each(|f| *f = 1e-6);
}
