//! The sides of vertices that lie on barriers.

use crate::id_hash::IdSet;
use crate::ids::{EdgeId, HalfedgeId, VertexId};
use crate::traits::Adjacency;

/// The sides of vertices on barriers. A side is named by its first corner, clockwise.
pub(crate) struct Sectors {
    barriers: IdSet<EdgeId>,
    split: IdSet<VertexId>,
}

impl Sectors {
    pub fn new<M: Adjacency>(mesh: &M, barriers: &[EdgeId]) -> Self {
        let known = barriers.iter().copied().filter(|e| e.index() < 3 * mesh.face_count());
        let ends = known.clone().map(|e| HalfedgeId(e.0)).flat_map(|h| [mesh.tail(h), mesh.head(h)]);
        Self { split: ends.collect(), barriers: known.collect() }
    }

    /// The name of the side on which the corner that `h` leaves lies.
    pub fn key<M: Adjacency>(&self, mesh: &M, h: HalfedgeId) -> u32 {
        let v = mesh.tail(h);
        let first = mesh.outgoing(v).unwrap_or(h);
        if self.split.is_empty() || !self.split.contains(&v) {
            return first.0;
        }
        let mut start = h;
        while !self.barriers.contains(&mesh.edge(start)) {
            match mesh.twin(start).map(HalfedgeId::next) {
                Some(before) if before != h => start = before,
                Some(_) => return first.0,
                None => break,
            }
        }
        start.0
    }

    /// The next corner counter-clockwise on the same side.
    pub fn turn<M: Adjacency>(&self, mesh: &M, h: HalfedgeId) -> Option<HalfedgeId> {
        let side = h.prev();
        let open = self.barriers.is_empty() || !self.barriers.contains(&mesh.edge(side));
        mesh.twin(side).filter(|_| open)
    }
}
