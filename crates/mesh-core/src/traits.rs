//! The five traits of the narrow mesh API. Ask for the weakest one that serves.

use crate::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use glam::DVec3;

/// Triangles as triples of vertices.
pub trait Faces {
    /// How many vertices; ids run from 0 to this.
    fn vertex_count(&self) -> usize;
    /// How many triangles; ids run from 0 to this.
    fn face_count(&self) -> usize;
    /// The corners of a triangle, counter-clockwise seen from outside.
    fn corners(&self, f: FaceId) -> [VertexId; 3];

    /// Every face id in order.
    fn face_ids(&self) -> impl ExactSizeIterator<Item = FaceId> + use<Self>
    where
        Self: Sized,
    {
        (0..self.face_count() as u32).map(FaceId)
    }

    /// Every vertex id in order.
    fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + use<Self>
    where
        Self: Sized,
    {
        (0..self.vertex_count() as u32).map(VertexId)
    }

    /// Every halfedge id in order.
    fn halfedge_ids(&self) -> impl ExactSizeIterator<Item = HalfedgeId> + use<Self>
    where
        Self: Sized,
    {
        (0..3 * self.face_count() as u32).map(HalfedgeId)
    }

    /// The vertex a halfedge leaves.
    #[inline]
    fn tail(&self, h: HalfedgeId) -> VertexId {
        self.corners(h.face())[h.corner()]
    }

    /// The vertex a halfedge points to.
    #[inline]
    fn head(&self, h: HalfedgeId) -> VertexId {
        self.corners(h.face())[(h.corner() + 1) % 3]
    }
}

/// Who lies beside whom, on an oriented 2-manifold, with or without boundary.
pub trait Adjacency: Faces {
    /// The oppositely directed halfedge of the neighbouring triangle; `None` on the boundary.
    fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId>;
    /// One halfedge leaving `v`, on the boundary if `v` is, so that turning by [`Adjacency::ring`] sees the whole
    /// one-ring; `None` where no triangle uses `v`.
    fn outgoing(&self, v: VertexId) -> Option<HalfedgeId>;

    /// The undirected edge of a halfedge.
    #[inline]
    fn edge(&self, h: HalfedgeId) -> EdgeId {
        EdgeId(self.twin(h).map_or(h.0, |t| t.0.min(h.0)))
    }

    /// The halfedges that leave `v`, counter-clockwise. One per triangle of the one-ring; the last neighbour of a
    /// boundary vertex is the tail of the last one's [`HalfedgeId::prev`].
    fn ring(&self, v: VertexId) -> Ring<'_, Self>
    where
        Self: Sized,
    {
        let start = self.outgoing(v);
        Ring { mesh: self, start, next: start }
    }

    /// The triangles across the sides of `f`.
    fn neighbours(&self, f: FaceId) -> impl Iterator<Item = FaceId>
    where
        Self: Sized,
    {
        f.halfedges().into_iter().filter_map(|h| self.twin(h)).map(HalfedgeId::face)
    }

    /// The halfedge from `a` to `b`, if they are neighbours.
    fn halfedge(&self, a: VertexId, b: VertexId) -> Option<HalfedgeId>
    where
        Self: Sized,
    {
        self.ring(a).find(|&h| self.head(h) == b)
    }
}

/// Turns around a vertex; see [`Adjacency::ring`].
pub struct Ring<'a, M> {
    mesh: &'a M,
    start: Option<HalfedgeId>,
    next: Option<HalfedgeId>,
}

impl<M: Adjacency> Iterator for Ring<'_, M> {
    type Item = HalfedgeId;
    #[inline]
    fn next(&mut self) -> Option<HalfedgeId> {
        let here = self.next?;
        self.next = self.mesh.twin(here.prev()).filter(|&h| Some(h) != self.start);
        Some(here)
    }
}

/// Points in space, in model units.
pub trait Positions {
    /// Where a vertex is.
    fn position(&self, v: VertexId) -> DVec3;

    /// The three corner points of a triangle.
    #[inline]
    fn triangle(&self, f: FaceId) -> [DVec3; 3]
    where
        Self: Faces + Sized,
    {
        self.corners(f).map(|v| self.position(v))
    }

    /// The points at a halfedge's tail and head.
    #[inline]
    fn ends(&self, h: HalfedgeId) -> [DVec3; 2]
    where
        Self: Faces + Sized,
    {
        [self.position(self.tail(h)), self.position(self.head(h))]
    }

    /// The length of a halfedge, in model units.
    #[inline]
    fn edge_length(&self, h: HalfedgeId) -> f64
    where
        Self: Faces + Sized,
    {
        let [a, b] = self.ends(h);
        a.distance(b)
    }
}

/// Takes a mesh as it is made. May refuse, which stops the maker.
pub trait MeshSink {
    /// Why the sink refuses.
    type Error;
    /// Adds a vertex and returns its id.
    ///
    /// # Errors
    /// Whatever makes the sink refuse, such as a full id space.
    fn vertex(&mut self, p: DVec3) -> Result<VertexId, Self::Error>;
    /// Adds a triangle of vertices added before and returns its id.
    ///
    /// # Errors
    /// Whatever makes the sink refuse.
    fn face(&mut self, corners: [VertexId; 3]) -> Result<FaceId, Self::Error>;
}

/// Watches and vetoes the edits of a remesher. `()` allows all and notes nothing.
pub trait EditObserver {
    /// Whether the edge between `a` and `b` may be split, collapsed or flipped.
    fn may_edit(&self, _a: VertexId, _b: VertexId) -> bool {
        true
    }
    /// `new` was put on the edge from `a` to `b` at parameter `t` in [0, 1].
    fn split(&mut self, _a: VertexId, _b: VertexId, _t: f64, _new: VertexId) {}
    /// `gone` was merged into `kept`.
    fn collapse(&mut self, _gone: VertexId, _kept: VertexId) {}
    /// The edge `a`–`b` was replaced by `c`–`d`.
    fn flip(&mut self, _a: VertexId, _b: VertexId, _c: VertexId, _d: VertexId) {}
}

impl EditObserver for () {}

impl<M: Faces> Faces for &M {
    fn vertex_count(&self) -> usize {
        (**self).vertex_count()
    }
    fn face_count(&self) -> usize {
        (**self).face_count()
    }
    #[inline]
    fn corners(&self, f: FaceId) -> [VertexId; 3] {
        (**self).corners(f)
    }
}

impl<M: Adjacency> Adjacency for &M {
    #[inline]
    fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        (**self).twin(h)
    }
    #[inline]
    fn outgoing(&self, v: VertexId) -> Option<HalfedgeId> {
        (**self).outgoing(v)
    }
}

impl<M: Positions> Positions for &M {
    #[inline]
    fn position(&self, v: VertexId) -> DVec3 {
        (**self).position(v)
    }
}
