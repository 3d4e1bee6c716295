//! Where sheets of the result touch along an edge or at a vertex: gives each sheet its own copies.

use crate::assemble::Assembly;
use mesh_core::{VertexId, VertexMap, VertexOrigin};

/// Splits vertices of the result where more than one fan of faces meets, among the vertices for which `suspect` holds.
/// Where four faces share an edge, faces of one part stay together. Returns the new copies' first ids.
pub(crate) fn split(assembly: &mut Assembly, suspect: &[bool]) -> Vec<VertexId> {
    let of_b = |f: usize, a: &Assembly| {
        let whole_a = a.whole[0].len();
        (f >= whole_a && f < a.pieces[0]) || f >= a.pieces[1]
    };
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
            edges.push(([u.min(v), u.max(v)], of_b(f as usize, assembly), u < v, (3 * i + k) as u32));
        }
    }
    edges.sort_unstable();
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
    if copies.is_empty() {
        return copies;
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
    copies
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
