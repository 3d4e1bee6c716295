//! Matching of opposite halfedges, in parallel, and the one fan of each vertex.

use crate::edge_groups::{range_len, visit_edges};
use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::not_manifold::NotManifold;
use crate::traits::{Faces, Positions};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

pub(crate) const NONE: u32 = u32::MAX;

/// Twin of each halfedge and one outgoing halfedge of each vertex (`u32::MAX` for none).
#[expect(clippy::result_large_err, reason = "built once per mesh, and its lists are public")]
pub(crate) fn connect<M: Faces + Positions + Sync>(mesh: &M) -> Result<(Vec<u32>, Vec<u32>), NotManifold> {
    let mut defects = NotManifold {
        edges: vec![],
        misoriented: vec![],
        vertices: vec![],
        degenerate: vec![],
        out_of_range: vec![],
        place: None,
    };
    // `3·f + corner` must stay below the `NONE` mark.
    if mesh.face_count() >= (NONE / 3) as usize {
        defects.out_of_range.push(FaceId(NONE / 3));
        return Err(defects);
    }
    let faces = mesh.face_count() as u32;
    defects.out_of_range =
        (0..faces).into_par_iter().map(FaceId).filter(|&f| !in_range(mesh, mesh.corners(f))).collect();
    defects.degenerate = (0..faces)
        .into_par_iter()
        .map(FaceId)
        .filter(|&f| in_range(mesh, mesh.corners(f)) && !distinct(mesh.corners(f)))
        .collect();
    if defects.out_of_range.is_empty() && defects.degenerate.is_empty() {
        let twins = pair(mesh, &mut defects);
        if defects.edges.is_empty() && defects.misoriented.is_empty() {
            match fans(mesh, &twins) {
                Ok(outgoing) => return Ok((twins, outgoing)),
                Err(vertices) => defects.vertices = vertices,
            }
        }
    }
    defects.place = defects
        .edges
        .first()
        .or(defects.misoriented.first())
        .map(|e| 0.5 * (mesh.position(e[0]) + mesh.position(e[1])))
        .or(defects.vertices.first().map(|&v| mesh.position(v)))
        .or(defects.degenerate.first().map(|&f| mesh.position(mesh.corners(f)[0])));
    Err(defects)
}

pub(crate) fn in_range<M: Faces>(mesh: &M, c: [VertexId; 3]) -> bool {
    c[0].max(c[1]).max(c[2]).index() < mesh.vertex_count()
}

pub(crate) fn distinct([a, b, c]: [VertexId; 3]) -> bool {
    a != b && b != c && c != a
}

/// Offending edges: non-manifold, misoriented.
type Lists = (Vec<[VertexId; 2]>, Vec<[VertexId; 2]>);

fn pair<M: Faces + Sync>(mesh: &M, defects: &mut NotManifold) -> Vec<u32> {
    // Relaxed atomics: every halfedge lies in one edge, so no two tasks write the same slot.
    let twins: Vec<AtomicU32> =
        (0..3 * mesh.face_count() as u32).into_par_iter().map(|_| AtomicU32::new(NONE)).collect();
    let lists = visit_edges(
        mesh,
        |_| true,
        |(edges, misoriented): &mut Lists, group| match group.len() {
            1 => {}
            2 => {
                let (h, t) = (group.halfedge(0), group.halfedge(1));
                if mesh.tail(h) == mesh.tail(t) {
                    misoriented.push(group.ends);
                } else {
                    twins[h.index()].store(t.0, Ordering::Relaxed);
                    twins[t.index()].store(h.0, Ordering::Relaxed);
                }
            }
            _ => edges.push(group.ends),
        },
    );
    for (edges, misoriented) in lists {
        defects.edges.extend(edges);
        defects.misoriented.extend(misoriented);
    }
    defects.edges.sort_unstable();
    defects.misoriented.sort_unstable();
    twins.into_iter().map(AtomicU32::into_inner).collect()
}

/// The first halfedge of each vertex' fan; or else the vertices with more than one fan.
pub(crate) fn fans<M: Faces + Sync>(mesh: &M, twins: &[u32]) -> Result<Vec<u32>, Vec<VertexId>> {
    let range = range_len(mesh);
    let mut outgoing = vec![NONE; mesh.vertex_count()];
    let seen: usize = outgoing
        .par_chunks_mut(range)
        .enumerate()
        .map(|(task, chunk)| {
            lowest_outgoing(mesh, (task * range) as u32, chunk);
            chunk.iter_mut().map(|h| turn_to_start(twins, h)).sum::<usize>()
        })
        .sum();
    // Each fan's corners were counted once; corners left over belong to second fans.
    if seen == twins.len() {
        return Ok(outgoing);
    }
    let mut degree = vec![0; mesh.vertex_count()];
    for f in mesh.face_ids() {
        for v in mesh.corners(f) {
            degree[v.index()] += 1;
        }
    }
    let broken = |&v: &VertexId| turn_to_start(twins, &mut { outgoing[v.index()] }) != degree[v.index()];
    Err(mesh.vertex_ids().filter(broken).collect())
}

fn lowest_outgoing<M: Faces>(mesh: &M, low: u32, chunk: &mut [u32]) {
    for f in mesh.face_ids() {
        for (k, v) in mesh.corners(f).into_iter().enumerate() {
            if let Some(slot) = chunk.get_mut(v.0.wrapping_sub(low) as usize) {
                *slot = (*slot).min(HalfedgeId::new(f, k).0);
            }
        }
    }
}

/// Moves `start` clockwise to the boundary, if its fan has one, and returns how many corners the fan has.
pub(crate) fn turn_to_start(twins: &[u32], start: &mut u32) -> usize {
    if *start == NONE {
        return 0;
    }
    let (first, mut count) = (*start, 1);
    loop {
        let twin = twins[*start as usize];
        if twin == NONE {
            break;
        }
        *start = HalfedgeId(twin).next().0;
        if *start == first {
            return count;
        }
        count += 1;
    }
    let mut h = first;
    loop {
        h = twins[HalfedgeId(h).prev().index()];
        if h == NONE {
            return count;
        }
        count += 1;
    }
}
