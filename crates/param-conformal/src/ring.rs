//! Rings, and the seam that opens one into a rectangle.

use crate::error::Error;
use mesh_core::{Adjacency, HalfedgeId, Positions, VertexId, VertexMap, boundary_loops, shortest_path, topology};

/// The two boundary loops of a surface that is known to be a ring (an annulus).
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    loops: [Vec<HalfedgeId>; 2],
}

impl Ring {
    /// Looks at the topology. O(n).
    ///
    /// # Errors
    /// [`Error::NotARing`].
    pub fn new<M: Adjacency>(mesh: &M) -> Result<Self, Error> {
        let counts = topology(mesh);
        let euler = counts.euler_characteristic();
        let loops = boundary_loops(mesh);
        let refused = Error::NotARing { pieces: counts.components, loops: loops.len(), characteristic: euler };
        match <[_; 2]>::try_from(loops) {
            Ok(loops) if counts.components == 1 && euler == 0 => Ok(Self { loops }),
            _ => Err(refused),
        }
    }

    /// The bottom and the top loop, each with the surface on its left. The bottom one holds the lowest boundary halfedge.
    pub fn loops(&self) -> &[Vec<HalfedgeId>; 2] {
        &self.loops
    }

    /// The ring with bottom and top exchanged.
    #[must_use]
    pub fn turned(self) -> Self {
        let [bottom, top] = self.loops;
        Self { loops: [top, bottom] }
    }

    /// The shortest chain of edges from `from` on the bottom to `to` on the top that touches the boundary nowhere else.
    /// Dijkstra's algorithm; ties go to lower ids.
    ///
    /// # Errors
    /// [`Error::NoSeam`] where there is none, or an end is not on its loop.
    pub fn seam<M: Adjacency + Positions>(
        &self,
        mesh: &M,
        from: VertexId,
        to: VertexId,
    ) -> Result<Vec<HalfedgeId>, Error> {
        let mut rim = VertexMap::filled(mesh.vertex_count(), false);
        self.loops.iter().flatten().for_each(|&h| rim[mesh.tail(h)] = true);
        let inside = |v: VertexId| v == from || v == to || !rim[v];
        let cost = |h: HalfedgeId| {
            // A boundary edge is no inner one even where it joins the ends.
            if mesh.twin(h).is_some() && inside(mesh.head(h)) && inside(mesh.tail(h)) {
                mesh.edge_length(h)
            } else {
                f64::NAN
            }
        };
        let on = |side: usize, v: VertexId| self.loops[side].iter().any(|&h| mesh.tail(h) == v);
        let refused = || {
            let at = if from.index() < mesh.vertex_count() { mesh.position(from) } else { glam::DVec3::NAN };
            Error::NoSeam { from, at }
        };
        if !on(0, from) || !on(1, to) {
            return Err(refused());
        }
        shortest_path(mesh, from, to, cost).ok_or_else(refused)
    }

    /// Opens the ring along `seam`, which leads from the bottom to the top: seen with the bottom below and the normals
    /// towards the eye, the surface then lies to the right of it, and all round comes back to its left.
    ///
    /// # Errors
    /// [`Error::BadSeam`].
    pub fn cut<M: Adjacency>(&self, mesh: &M, seam: Vec<HalfedgeId>) -> Result<CutRing, Error> {
        let halfedges = 3 * mesh.face_count();
        if let Some(step) = seam.iter().position(|h| h.index() >= halfedges || mesh.twin(*h).is_none()) {
            return Err(Error::BadSeam { step });
        }
        if let Some(step) = seam.windows(2).position(|w| mesh.head(w[0]) != mesh.tail(w[1])) {
            return Err(Error::BadSeam { step: step + 1 });
        }
        let mut met = VertexMap::filled(mesh.vertex_count(), false);
        self.loops.iter().flatten().for_each(|&h| met[mesh.tail(h)] = true);
        let [Some(&first), Some(&last)] = [seam.first(), seam.last()] else { return Err(Error::BadSeam { step: 0 }) };
        for (step, &h) in seam.iter().enumerate().skip(1) {
            if std::mem::replace(&mut met[mesh.tail(h)], true) {
                return Err(Error::BadSeam { step });
            }
        }
        let from = |side: usize, v: VertexId| {
            let walk = &self.loops[side];
            let start = walk.iter().position(|&h| mesh.tail(h) == v)?;
            Some((0..walk.len()).map(|i| mesh.tail(walk[(start + i) % walk.len()])).collect::<Vec<_>>())
        };
        let bottom = from(0, mesh.tail(first)).ok_or(Error::BadSeam { step: 0 })?;
        let mut top = from(1, mesh.head(last)).ok_or(Error::BadSeam { step: seam.len() - 1 })?;
        // Its loop runs backwards as seen from the bottom.
        top[1..].reverse();
        let left = left_corners(mesh, &seam);
        Ok(CutRing { seam, bottom, top, left })
    }
}

/// The halfedges that leave a vertex of the seam within a triangle to the left of the seam, ascending.
fn left_corners<M: Adjacency>(mesh: &M, seam: &[HalfedgeId]) -> Vec<HalfedgeId> {
    let mut left = Vec::new();
    for i in 0..=seam.len() {
        let (back, ahead) = (i.checked_sub(1).map(|k| seam[k]), seam.get(i).copied());
        let Some(start) = ahead.or(back.and_then(|b| mesh.outgoing(mesh.head(b)))) else { continue };
        // Counter-clockwise from the way ahead (at the top, from the boundary) to the way back or the boundary.
        let stop = back.and_then(|b| mesh.twin(b));
        let mut here = Some(start);
        while let Some(h) = here.filter(|&h| Some(h) != stop) {
            left.push(h);
            here = mesh.twin(h.prev());
        }
    }
    left.sort_unstable();
    left
}

/// A ring opened along a seam.
#[derive(Clone, Debug, PartialEq)]
pub struct CutRing {
    seam: Vec<HalfedgeId>,
    bottom: Vec<VertexId>,
    top: Vec<VertexId>,
    left: Vec<HalfedgeId>,
}

impl CutRing {
    /// The chain of halfedges from bottom to top.
    pub fn seam(&self) -> &[HalfedgeId] {
        &self.seam
    }

    /// The bottom loop's vertices from the seam on, the surface on the left.
    pub fn bottom(&self) -> &[VertexId] {
        &self.bottom
    }

    /// The top loop's vertices from the seam on, the surface on the right: the same way round as the bottom.
    pub fn top(&self) -> &[VertexId] {
        &self.top
    }

    /// Whether the corner that `h` leaves lies on the seam, in a triangle to the left of it: there, a coordinate that
    /// grows around the ring is one period higher than at the seam's right.
    pub fn is_left(&self, h: HalfedgeId) -> bool {
        self.left.binary_search(&h).is_ok()
    }

    /// All such corners, ascending.
    pub fn left_corners(&self) -> &[HalfedgeId] {
        &self.left
    }
}
