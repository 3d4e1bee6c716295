//! Matching of opposite halfedges by counting sort on the lower vertex of each edge.

use crate::connected::NotManifold;
use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::traits::{Faces, Positions};

const NONE: u32 = u32::MAX;

/// Twin of each halfedge and one outgoing halfedge of each vertex (`u32::MAX` for none).
pub(crate) fn connect<M: Faces + Positions>(mesh: &M) -> Result<(Vec<u32>, Vec<u32>), NotManifold> {
    let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
    let mut defects = NotManifold {
        edges: vec![],
        misoriented: vec![],
        vertices: vec![],
        degenerate: vec![],
        out_of_range: vec![],
        place: None,
    };
    // `3·f + corner` must stay below the `NONE` mark.
    if faces >= (NONE / 3) as usize {
        defects.out_of_range.push(FaceId(NONE / 3));
        return Err(defects);
    }
    for f in mesh.face_ids() {
        let [a, b, c] = mesh.corners(f);
        if [a, b, c].iter().any(|v| v.index() >= vertices) {
            defects.out_of_range.push(f);
        } else if a == b || b == c || c == a {
            defects.degenerate.push(f);
        }
    }
    if defects.out_of_range.is_empty() && defects.degenerate.is_empty() {
        let buckets = Buckets::fill(mesh);
        let twins = buckets.pair(mesh, &mut defects);
        if defects.edges.is_empty() && defects.misoriented.is_empty() {
            let outgoing = fans(mesh, &twins, &mut defects);
            if defects.vertices.is_empty() {
                return Ok((twins, outgoing));
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

/// Halfedges grouped by the lower vertex of their edge, in halfedge order within a group.
struct Buckets {
    starts: Vec<u32>,
    halfedges: Vec<(u32, u32)>, // (higher vertex, halfedge)
}

impl Buckets {
    fn fill<M: Faces>(mesh: &M) -> Self {
        let mut starts = vec![0u32; mesh.vertex_count() + 1];
        for f in mesh.face_ids() {
            let c = mesh.corners(f);
            for k in 0..3 {
                starts[c[k].min(c[(k + 1) % 3]).index() + 1] += 1;
            }
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut halfedges = vec![(0, 0); 3 * mesh.face_count()];
        for f in mesh.face_ids() {
            let c = mesh.corners(f);
            for k in 0..3 {
                let (a, b) = (c[k], c[(k + 1) % 3]);
                let slot = &mut next[a.min(b).index()];
                halfedges[*slot as usize] = (a.max(b).0, HalfedgeId::new(f, k).0);
                *slot += 1;
            }
        }
        Self { starts, halfedges }
    }

    fn pair<M: Faces>(mut self, mesh: &M, defects: &mut NotManifold) -> Vec<u32> {
        let mut twins = vec![NONE; self.halfedges.len()];
        for low in 0..self.starts.len() - 1 {
            let group = &mut self.halfedges[self.starts[low] as usize..self.starts[low + 1] as usize];
            group.sort_unstable();
            for edge in group.chunk_by(|a, b| a.0 == b.0) {
                match *edge {
                    [_] => {}
                    [(_, h), (_, t)] if mesh.tail(HalfedgeId(h)) != mesh.tail(HalfedgeId(t)) => {
                        twins[h as usize] = t;
                        twins[t as usize] = h;
                    }
                    [(high, _), _] => defects.misoriented.push([VertexId(low as u32), VertexId(high)]),
                    _ => defects.edges.push([VertexId(low as u32), VertexId(edge[0].0)]),
                }
            }
        }
        twins
    }
}

/// Picks the first halfedge of each fan and finds vertices with more than one fan.
fn fans<M: Faces>(mesh: &M, twins: &[u32], defects: &mut NotManifold) -> Vec<u32> {
    let mut outgoing = vec![NONE; mesh.vertex_count()];
    let mut degree = vec![0u32; mesh.vertex_count()];
    for f in mesh.face_ids() {
        for (k, v) in mesh.corners(f).into_iter().enumerate() {
            let h = HalfedgeId::new(f, k);
            degree[v.index()] += 1;
            if outgoing[v.index()] == NONE || twins[h.index()] == NONE {
                outgoing[v.index()] = h.0;
            }
        }
    }
    for v in 0..outgoing.len() {
        let (mut h, mut seen) = (outgoing[v], 0);
        while h != NONE {
            seen += 1;
            h = twins[HalfedgeId(h).prev().index()];
            if h == outgoing[v] {
                break;
            }
        }
        if seen != degree[v] {
            defects.vertices.push(VertexId(v as u32));
        }
    }
    outgoing
}
