//! Collapses edges along the seam that are shorter than a stated length, where the surface neither folds nor pinches.

use crate::arrange::{Arrangement, Part};
use crate::assemble::Assembly;
use crate::predicate::{facing, turn};
use mesh_core::{Adjacency, FaceId, FaceOrigin, Faces, TriMesh, VertexId};
use std::collections::HashMap;

/// Edges of pieces no longer than `length` with a new vertex, shortest first. The vertex to go is the first one.
pub(crate) fn short_edges(result: &Assembly, first_new: u32, length: f64) -> Vec<[VertexId; 2]> {
    let mut short: Vec<(f64, [VertexId; 2])> = vec![];
    for t in &result.mesh.faces[result.pieces[0]..result.pieces[2]] {
        for k in 0..3 {
            let (u, v) = (t[k].max(t[(k + 1) % 3]), t[k].min(t[(k + 1) % 3]));
            let d = result.mesh.positions[u.index()].distance(result.mesh.positions[v.index()]);
            // New vertices have the highest ids, and only they may go.
            if d <= length && result.nodes[u.index()] >= first_new {
                short.push((d, [u, v]));
            }
        }
    }
    short.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    short.dedup();
    short.into_iter().map(|s| s.1).collect()
}

/// Collapses the listed edges as far as possible; returns how many went.
pub(crate) fn collapse(
    result: &mut Assembly,
    arrangement: &Arrangement,
    parts: &[Part; 2],
    edges: &[[VertexId; 2]],
    length: f64,
) -> usize {
    let (start, end) = (result.pieces[0], result.pieces[2]);
    let mut around: HashMap<VertexId, Vec<u32>> = HashMap::new();
    for f in start..end {
        result.mesh.faces[f].iter().for_each(|v| around.entry(*v).or_default().push(f as u32));
    }
    let mut gone = vec![false; end - start];
    let mut into: HashMap<VertexId, VertexId> = HashMap::new();
    let find = |into: &HashMap<VertexId, VertexId>, mut v: VertexId| {
        while let Some(&next) = into.get(&v) {
            v = next;
        }
        v
    };
    for &[u, v] in edges {
        let (u, v) = (find(&into, u), find(&into, v));
        let (u, v) = (u.max(v), u.min(v));
        let far = result.mesh.positions[u.index()].distance(result.mesh.positions[v.index()]) > length;
        let first_new = arrangement.counts[0] + arrangement.counts[1];
        if u == v || far || result.nodes[u.index()] < first_new {
            continue;
        }
        if !may_collapse(result, arrangement, parts, &around, u, v) {
            continue;
        }
        let faces = around.remove(&u).unwrap_or_default();
        for f in faces {
            let c = &mut result.mesh.faces[f as usize];
            if c.contains(&v) {
                gone[f as usize - start] = true;
                c.iter().filter(|w| **w != u).for_each(|w| {
                    if let Some(list) = around.get_mut(w) {
                        list.retain(|g| *g != f);
                    }
                });
            } else {
                c.iter_mut().filter(|w| **w == u).for_each(|w| *w = v);
                around.entry(v).or_default().push(f);
            }
        }
        into.insert(u, v);
    }
    if !into.is_empty() {
        compact(result, &gone, &into);
    }
    into.len()
}

/// Whether `u`, all of whose faces are pieces, may be pulled onto its neighbour `v`.
fn may_collapse(
    result: &Assembly,
    arrangement: &Arrangement,
    parts: &[Part; 2],
    around: &HashMap<VertexId, Vec<u32>>,
    u: VertexId,
    v: VertexId,
) -> bool {
    let (Some(of_u), Some(of_v)) = (around.get(&u), around.get(&v)) else { return false };
    let corners = |f: &u32| result.mesh.faces[*f as usize];
    let mut apexes = vec![];
    let mut others = vec![];
    for f in of_u {
        let c = corners(f);
        let ends = c.iter().copied().filter(|w| *w != u && *w != v);
        if c.contains(&v) { apexes.extend(ends) } else { others.extend(ends) }
    }
    others.retain(|w| !apexes.contains(w));
    let node = result.nodes[v.index()];
    let [na, nb] = arrangement.counts;
    let whole_edge = |w: VertexId| {
        let m = result.nodes[w.index()];
        let of = |part: usize, low: u32, high: u32| {
            let inside = |n: u32| (low..high).contains(&n);
            let mesh = parts[part].mesh;
            inside(node) && inside(m) && mesh.ring(VertexId(node - low)).any(|h| mesh.head(h) == VertexId(m - low))
        };
        of(0, 0, na) || of(1, na, na + nb)
    };
    // The link condition: no neighbour in common but the two apexes.
    if apexes.len() != 2
        || apexes[0] == apexes[1]
        || others.iter().any(|w| of_v.iter().any(|f| corners(f).contains(w)) || whole_edge(*w))
    {
        return false;
    }
    let at = |w: VertexId| arrangement.scaled_position(parts, result.nodes[w.index()]);
    of_u.iter().filter(|f| !corners(f).contains(&v)).all(|f| {
        let (FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face }) = result.origins.faces[FaceId(*f)]
        else {
            return false;
        };
        let before = corners(f);
        let after = before.map(|w| if w == u { v } else { w });
        facing(&parts[part as usize].triangle(face.0)).is_some_and(|(axis, _)| {
            let way = |c: [VertexId; 3]| turn(axis, at(c[0]), at(c[1]), at(c[2]));
            way(before) != 0 && way(before) == way(after)
        })
    })
}

/// Drops faces and vertices that are gone.
fn compact(result: &mut Assembly, gone: &[bool], into: &HashMap<VertexId, VertexId>) {
    let [start, middle, _] = result.pieces;
    let mut new_id = vec![];
    let mut kept = 0;
    for v in 0..result.nodes.len() {
        new_id.push(VertexId(kept));
        kept += u32::from(!into.contains_key(&VertexId::from(v)));
    }
    let stays = |v: usize| !into.contains_key(&VertexId::from(v));
    let filter = |i: &usize| *i < start || !gone[*i - start];
    let face_ids: Vec<usize> = (0..result.mesh.faces.len()).filter(filter).collect();
    let gone_a = gone[..middle - start].iter().filter(|g| **g).count();
    let gone_all = gone.iter().filter(|g| **g).count();
    let vertex_ids: Vec<usize> = (0..result.nodes.len()).filter(|&v| stays(v)).collect();
    let faces = face_ids.iter().map(|&f| result.mesh.faces[f].map(|v| new_id[v.index()])).collect();
    result.origins.faces = face_ids.iter().map(|&f| result.origins.faces[FaceId::from(f)]).collect::<Vec<_>>().into();
    result.origins.vertices =
        vertex_ids.iter().map(|&v| result.origins.vertices[VertexId::from(v)]).collect::<Vec<_>>().into();
    result.mesh = TriMesh { positions: vertex_ids.iter().map(|&v| result.mesh.positions[v]).collect(), faces };
    result.nodes = vertex_ids.iter().map(|&v| result.nodes[v]).collect();
    result.vertices.fill(u32::MAX);
    for (v, &n) in result.nodes.iter().enumerate() {
        result.vertices[n as usize] = v as u32;
    }
    result.pieces = [start, middle - gone_a, result.pieces[2] - gone_all];
}
