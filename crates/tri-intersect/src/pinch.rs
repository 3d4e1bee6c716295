//! Where sheets of the result touch along an edge or at a vertex: gives each sheet its own copies.

use crate::assemble::Assembly;
use mesh_core::{FaceId, FaceOrigin, VertexId, VertexMap, VertexOrigin};
use std::collections::HashMap;

/// Splits vertices of the result where more than one fan of faces meets, among the vertices for which `suspect` holds.
/// Where four faces share an edge, faces of one part stay together. Returns the new copies' first ids.
pub(crate) fn split(assembly: &mut Assembly, suspect: &[bool]) -> Vec<VertexId> {
    let near: Vec<u32> = (0..assembly.mesh.faces.len())
        .filter(|&f| assembly.mesh.faces[f].iter().any(|v| suspect[v.index()]))
        .map(|f| f as u32)
        .collect();
    let corners = |i: usize| assembly.mesh.faces[near[i] as usize];
    let mut edges: Vec<([VertexId; 2], bool, bool, u32)> = vec![];
    for (i, &f) in near.iter().enumerate() {
        let c = corners(i);
        for k in 0..3 {
            let (u, v) = (c[k], c[(k + 1) % 3]);
            edges.push(([u.min(v), u.max(v)], assembly.is_of_b(f), u < v, (3 * i + k) as u32));
        }
    }
    edges.sort_unstable();
    // Partners at edges with more than two faces.
    let mut pinched: Vec<[u32; 2]> = vec![];
    let mut fans: Vec<u32> = (0..3 * near.len() as u32).collect();
    for group in edges.chunk_by(|x, y| x.0 == y.0) {
        let mut open: Vec<(bool, bool, u32)> = group.iter().map(|e| (e.1, e.2, e.3)).collect();
        // First within a part, then across.
        for across in [false, true] {
            let mut i = 0;
            while i < open.len() {
                let x = open[i];
                let partner = (i + 1..open.len()).find(|&j| open[j].1 != x.1 && (across || open[j].0 == x.0));
                // Two faces alone are partners whatever their parts.
                if let Some(j) = partner {
                    let y = open.remove(j);
                    open.remove(i);
                    let next = |h: u32| h - h % 3 + (h + 1) % 3;
                    if group.len() > 2 {
                        pinched.push([x.2, y.2]);
                    }
                    join(&mut fans, x.2, next(y.2));
                    join(&mut fans, next(x.2), y.2);
                } else {
                    i += 1;
                }
            }
        }
    }
    // The fan of the lowest corner keeps the vertex.
    let mut owner: Vec<(VertexId, u32)> = vec![];
    for i in 0..near.len() {
        for (k, v) in corners(i).into_iter().enumerate() {
            if suspect[v.index()] {
                owner.push((v, root(&fans, (3 * i + k) as u32)));
            }
        }
    }
    owner.sort_unstable();
    owner.dedup();
    let mut copies = vec![];
    let mut replaced: Vec<(u32, VertexId)> = vec![];
    for group in owner.chunk_by(|x, y| x.0 == y.0) {
        for &(v, fan) in &group[1..] {
            let copy = VertexId::from(assembly.mesh.positions.len());
            assembly.mesh.positions.push(assembly.mesh.positions[v.index()]);
            assembly.nodes.push(assembly.nodes[v.index()]);
            copies.push(v);
            replaced.push((fan, copy));
        }
    }
    replaced.sort_unstable();
    for (i, &f) in near.iter().enumerate() {
        for k in 0..3 {
            let fan = root(&fans, (3 * i + k) as u32);
            if let Ok(j) = replaced.binary_search_by_key(&fan, |r| r.0) {
                assembly.mesh.faces[f as usize][k] = replaced[j].1;
            }
        }
    }
    let mut origins: Vec<VertexOrigin> = assembly.origins.vertices.as_slice().to_vec();
    origins.extend(copies.iter().map(|v| assembly.origins.vertices[*v]));
    assembly.origins.vertices = VertexMap::from(origins);
    copies.extend(part_edges(assembly, &pinched, &near));
    copies
}

/// Where sheets part at neither end of a common edge, their copies of the edge are one still. Puts a vertex in the middle
/// of each copy.
fn part_edges(assembly: &mut Assembly, pinched: &[[u32; 2]], near: &[u32]) -> Vec<VertexId> {
    let ends = |a: &Assembly, h: u32| {
        let c = a.mesh.faces[near[h as usize / 3] as usize];
        (c[h as usize % 3], c[(h as usize + 1) % 3])
    };
    let mut edges: Vec<([VertexId; 2], [u32; 2])> = pinched
        .iter()
        .map(|&pair| {
            let (u, v) = ends(assembly, pair[0]);
            ([u.min(v), u.max(v)], pair)
        })
        .collect();
    edges.sort_unstable();
    let mut heirs: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut middles = vec![];
    let shared = edges.chunk_by(|x, y| x.0 == y.0).filter(|group| group.len() > 1);
    for &([u, v], pair) in shared.flatten() {
        let middle = VertexId::from(assembly.mesh.positions.len());
        middles.push(u);
        assembly
            .mesh
            .positions
            .push(0.5 * assembly.mesh.positions[u.index()] + 0.5 * assembly.mesh.positions[v.index()]);
        assembly.nodes.push(assembly.nodes[u.index()]);
        assembly.origins.vertices.push(VertexOrigin::New { stage: "contact" });
        for h in pair {
            let first = near[h as usize / 3];
            let family = heirs.entry(first).or_insert_with(|| vec![first]);
            let side = |f: &&u32| {
                let c = assembly.mesh.faces[**f as usize];
                (0..3).any(|k| [c[k], c[(k + 1) % 3]] == [u, v] || [c[k], c[(k + 1) % 3]] == [v, u])
            };
            let Some(&f) = family.iter().find(side) else { continue };
            let c = assembly.mesh.faces[f as usize];
            let Some(k) = (0..3).find(|&k| c[k] != u && c[k] != v) else { continue };
            let (apex, from, to) = (c[k], c[(k + 1) % 3], c[(k + 2) % 3]);
            family.push(assembly.mesh.faces.len() as u32);
            assembly.extra.push(u8::from(assembly.is_of_b(f)));
            assembly.mesh.faces[f as usize] = [apex, from, middle];
            assembly.mesh.faces.push([apex, middle, to]);
            let origin = match assembly.origins.faces[FaceId(f)] {
                FaceOrigin::Input { part, face } => FaceOrigin::Piece { part, face },
                other => other,
            };
            assembly.origins.faces[FaceId(f)] = origin;
            assembly.origins.faces.push(origin);
        }
    }
    middles
}

fn root(fans: &[u32], mut x: u32) -> u32 {
    while fans[x as usize] != x {
        x = fans[x as usize];
    }
    x
}

fn join(fans: &mut [u32], x: u32, y: u32) {
    let (x, y) = (root(fans, x), root(fans, y));
    let (low, high) = (x.min(y), x.max(y));
    fans[high as usize] = low;
}
