//! Which vertices a smoothing may move, the surface seen from a place where numbers are of order one, and systems in what may move.

use crate::{Error, Frozen};
use glam::DVec3;
use mesh_core::{Adjacency, Bounds, FaceId, Faces, HalfedgeId, Positions, VertexId, VertexMap, dihedral_angle};
use mesh_operators::{HeldSystem, Unknowns, vertex_areas};

impl Frozen {
    /// Also holds the ends of all edges whose faces' normals are `angle` degrees or more apart. O(n).
    #[must_use]
    pub fn with_features<M: Adjacency + Positions>(mut self, mesh: &M, angle: f64) -> Self {
        let sharp = |&h: &HalfedgeId| dihedral_angle(mesh, h).is_some_and(|a| a.abs() >= angle.to_radians());
        for h in mesh.halfedge_ids().filter(sharp) {
            if self.vertices.is_empty() {
                self.vertices = VertexMap::filled(mesh.vertex_count(), false);
            }
            for v in [mesh.tail(h), mesh.head(h)] {
                if let Some(held) = self.vertices.as_mut_slice().get_mut(v.index()) {
                    *held = true;
                }
            }
        }
        self
    }
}

/// A surface whose points have been moved.
pub(super) struct Moved<'a, M> {
    pub mesh: &'a M,
    pub points: Vec<DVec3>,
}

impl<M: Faces> Faces for Moved<'_, M> {
    fn vertex_count(&self) -> usize {
        self.mesh.vertex_count()
    }
    fn face_count(&self) -> usize {
        self.mesh.face_count()
    }
    #[inline]
    fn corners(&self, f: FaceId) -> [VertexId; 3] {
        self.mesh.corners(f)
    }
}

impl<M: Adjacency> Adjacency for Moved<'_, M> {
    #[inline]
    fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        self.mesh.twin(h)
    }
    #[inline]
    fn outgoing(&self, v: VertexId) -> Option<HalfedgeId> {
        self.mesh.outgoing(v)
    }
}

impl<M> Positions for Moved<'_, M> {
    #[inline]
    fn position(&self, v: VertexId) -> DVec3 {
        self.points[v.index()]
    }
}

/// A surface moved to the origin and scaled to a box of diagonal 1, and the vertices that may move.
pub(super) struct Task<'a, M> {
    pub moved: Moved<'a, M>,
    pub unknowns: Unknowns,
    center: DVec3,
    pub scale: f64,
}

impl<'a, M: Adjacency + Positions> Task<'a, M> {
    /// All vertices are free but those on the boundary, those that are frozen, and corners of frozen faces.
    pub fn new(mesh: &'a M, frozen: &Frozen) -> Result<Self, Error> {
        for (name, found, expected) in [
            ("frozen vertices", frozen.vertices.len(), mesh.vertex_count()),
            ("frozen faces", frozen.faces.len(), mesh.face_count()),
        ] {
            if found != 0 && found != expected {
                return Err(Error::Count { name, found, expected });
            }
        }
        let mut free = vec![false; mesh.vertex_count()];
        for v in mesh.vertex_ids() {
            let p = mesh.position(v);
            if !(p.is_finite() && p.abs().max_element() < 1e100) {
                return Err(Error::NotFinite { vertex: v, place: p });
            }
            let inner = mesh.outgoing(v).is_some_and(|h| mesh.twin(h).is_some());
            free[v.index()] = inner && !frozen.vertices.get(v).is_some_and(|&f| f);
        }
        for (f, _) in mesh.face_ids().zip(frozen.faces.as_slice()).filter(|f| *f.1) {
            for v in mesh.corners(f) {
                free[v.index()] = false;
            }
        }
        let bounds = Bounds::of(mesh.vertex_ids().map(|v| mesh.position(v)));
        let (center, diagonal) = (if bounds.is_empty() { DVec3::ZERO } else { bounds.center() }, bounds.diagonal());
        let scale = if diagonal > 0.0 { diagonal } else { 1.0 };
        let points = mesh.vertex_ids().map(|v| (mesh.position(v) - center) / scale).collect();
        let unknowns = Unknowns::new(free.len(), |v| free[v]);
        Ok(Self { moved: Moved { mesh, points }, unknowns, center, scale })
    }

    /// The vertices that may move, ascending.
    pub fn free(&self) -> &[u32] {
        self.unknowns.free()
    }

    /// The system of the free vertices' rows; one that was prepared before, with entries at the same places, is renewed.
    ///
    /// # Errors
    /// [`Error::IllConditioned`].
    pub fn prepared(
        &self,
        before: Option<HeldSystem>,
        row: impl Fn(u32, &mut Vec<(u32, f64)>) + Sync,
    ) -> Result<HeldSystem, Error> {
        let found = match before {
            Some(before) => before.renew(row),
            None => HeldSystem::new(self.unknowns.clone(), row),
        };
        found.map_err(|e| Error::IllConditioned { at: self.moved.mesh.position(VertexId::from(e.unknown)) })
    }

    /// The points in the input's place and size; vertices that are not free have the input's bits.
    pub fn finish(self) -> Vec<DVec3> {
        let mesh = self.moved.mesh;
        let mut points: Vec<DVec3> = mesh.vertex_ids().map(|v| mesh.position(v)).collect();
        for &v in self.unknowns.free() {
            points[v as usize] = self.center + self.scale * self.moved.points[v as usize];
        }
        points
    }
}

/// Area around each inner vertex; 0 on the boundary, where the Laplacian of a surface that ends is not its bending.
pub(super) fn inner_areas<M: Adjacency + Positions + Sync>(mesh: &M) -> Vec<f64> {
    let mut areas = vertex_areas(mesh).into_vec();
    for v in mesh.vertex_ids() {
        if mesh.outgoing(v).is_none_or(|h| mesh.twin(h).is_none()) {
            areas[v.index()] = 0.0;
        }
    }
    areas
}
