//! What of the zero set is wanted: the part beyond the rims, and the curves along which it ends.

use crate::error::Error;
use crate::rim::{Near, REACH, Rims};
use mesh_core::{TriMesh, VertexId, centroid};
use rayon::prelude::*;

/// The zero set around the rims, told apart.
pub(crate) struct Trimmed {
    /// Which faces are wanted.
    pub kept: Vec<bool>,
    /// Where each vertex is, seen from the nearest rim.
    pub near: Vec<Option<Near>>,
    /// The border of the wanted faces as closed curves of vertices, with the gap on the left.
    pub borders: Vec<Vec<u32>>,
}

/// Components with fewer faces than this are left to the gap.
const LEAST_FACES: u32 = 6;

/// Keeps the faces whose vertices are all beyond every rim by `width` or out of its reach.
pub(crate) fn trim(mesh: &TriMesh, rims: &Rims, width: f64, cell: f64) -> Result<Trimmed, Error> {
    let near: Vec<Option<Near>> = mesh.positions.par_iter().map(|&p| rims.near(p)).collect();
    let mut wanted: Vec<bool> =
        near.par_iter().map(|n| n.is_none_or(|n| n.side > 0.0 && n.distance >= width)).collect();
    for face in &mesh.faces {
        let behind = |v: &VertexId| near[v.index()].filter(|n| n.side <= 0.0 && n.distance >= width);
        // A face across a rim is as wide as a cell's diagonal at most; what is wider came from behind.
        let beyond = |n: &Near, v: &VertexId| {
            wanted[v.index()] && near[v.index()].is_none_or(|m| m.distance + n.distance > REACH * cell)
        };
        if let Some(n) = face.iter().find_map(behind).filter(|n| face.iter().any(|v| beyond(n, v))) {
            let rim = rims.samples[n.sample as usize].rim as usize;
            return Err(Error::Leak { rim, at: centroid(face.map(|v| mesh.positions[v.index()])) });
        }
    }
    let all = |wanted: &[bool], f: &[VertexId; 3]| f.iter().all(|v| wanted[v.index()]);
    let mut kept: Vec<bool> = mesh.faces.iter().map(|f| all(&wanted, f)).collect();
    // Every round drops something or is the last.
    loop {
        let mut dirty = drop_small(mesh, &mut kept);
        let border = border_halfedges(mesh, &kept);
        let mut leaving = vec![0u8; mesh.positions.len()];
        for &[a, _] in &border {
            leaving[a as usize] = leaving[a as usize].saturating_add(1);
        }
        let mut sides = vec![0u8; mesh.faces.len()];
        for (f, face) in mesh.faces.iter().enumerate().filter(|(f, _)| kept[*f]) {
            for k in 0..3 {
                let e = [face[k].0, face[(k + 1) % 3].0];
                sides[f] += u8::from(border.binary_search(&e).is_ok());
            }
        }
        for (v, _) in leaving.iter().enumerate().filter(|(_, n)| **n > 1) {
            wanted[v] = false;
            dirty = true;
        }
        for (f, face) in mesh.faces.iter().enumerate().filter(|(f, _)| kept[*f]).collect::<Vec<_>>() {
            if sides[f] > 1 || !all(&wanted, face) {
                kept[f] = false;
                dirty = true;
            }
        }
        if !dirty {
            let borders = chain(&border);
            return Ok(Trimmed { kept, near, borders });
        }
    }
}

/// Drops components of a few faces; whether there were any.
fn drop_small(mesh: &TriMesh, kept: &mut [bool]) -> bool {
    let mut parents: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let mut counts = vec![0u32; mesh.positions.len()];
    for (face, _) in mesh.faces.iter().zip(&*kept).filter(|(_, k)| **k) {
        join(&mut parents, face[0].0, face[1].0);
        join(&mut parents, face[1].0, face[2].0);
    }
    for (face, _) in mesh.faces.iter().zip(&*kept).filter(|(_, k)| **k) {
        counts[root(&mut parents, face[0].0) as usize] += 1;
    }
    let mut dropped = false;
    for (face, k) in mesh.faces.iter().zip(kept).filter(|(_, k)| **k) {
        if counts[root(&mut parents, face[0].0) as usize] < LEAST_FACES {
            (*k, dropped) = (false, true);
        }
    }
    dropped
}

/// The halfedges of kept faces without a kept face beside them, sorted.
fn border_halfedges(mesh: &TriMesh, kept: &[bool]) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 3]> = Vec::new();
    for (face, _) in mesh.faces.iter().zip(kept).filter(|(_, k)| **k) {
        for k in 0..3 {
            let (a, b) = (face[k].0, face[(k + 1) % 3].0);
            edges.push([a.min(b), a.max(b), u32::from(a > b)]);
        }
    }
    edges.par_sort_unstable();
    let mut border: Vec<[u32; 2]> = edges
        .chunk_by(|x, y| x[..2] == y[..2])
        .filter(|same| same.len() == 1)
        .map(|same| if same[0][2] == 0 { [same[0][0], same[0][1]] } else { [same[0][1], same[0][0]] })
        .collect();
    border.sort_unstable();
    border
}

/// Closed curves from border halfedges, each vertex left once, turned round.
fn chain(border: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut seen = vec![false; border.len()];
    let mut curves = vec![];
    for start in 0..border.len() {
        let mut curve = vec![];
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            curve.push(border[at][0]);
            match border.binary_search_by_key(&border[at][1], |e| e[0]) {
                Ok(next) => at = next,
                Err(_) => break,
            }
        }
        if !curve.is_empty() {
            curve.reverse();
            curves.push(curve);
        }
    }
    curves
}

/// The least element of a set, halving the way there.
pub(crate) fn root(parents: &mut [u32], mut v: u32) -> u32 {
    while parents[v as usize] != v {
        parents[v as usize] = parents[parents[v as usize] as usize];
        v = parents[v as usize];
    }
    v
}

/// Joins two sets.
pub(crate) fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}
