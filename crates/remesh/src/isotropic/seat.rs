//! Points put back onto the input, found from where they were before.

use glam::DVec3;
use mesh_core::{Adjacency, FaceId, HalfedgeId, Positions};
use mesh_query::{TriBvh, closest_point_on_triangle};
use std::sync::OnceLock;

/// A place on the input.
#[derive(Clone, Copy)]
pub(crate) struct Seat {
    pub face: u32,
    pub barycentric: [f64; 3],
    pub point: DVec3,
    pub distance: f64,
}

/// The surface that points are put back onto.
///
/// A walk downhill from the last face is faster than a search from the top, and does not jump to another sheet of the
/// surface that happens to be near. Where it gets stuck far away, a search decides.
pub(crate) struct Ground<'a, M> {
    mesh: &'a M,
    tree: OnceLock<Option<TriBvh>>,
}

/// Steps of a walk before a search takes over.
const FAR: usize = 200;

impl<'a, M: Adjacency + Positions + Sync> Ground<'a, M> {
    pub fn new(mesh: &'a M) -> Self {
        Self { mesh, tree: OnceLock::new() }
    }

    fn corners(&self, f: FaceId) -> [DVec3; 3] {
        self.mesh.corners(f).map(|v| self.mesh.position(v))
    }

    fn seat(&self, p: DVec3, f: FaceId) -> Seat {
        let (point, barycentric) = closest_point_on_triangle(p, self.corners(f));
        Seat { face: f.0, barycentric, point, distance: p.distance(point) }
    }

    /// The place near `p`, starting at face `start`. A place farther than `doubtful` is compared with what a search
    /// finds where the surface faces along `normal`.
    pub fn settle(&self, p: DVec3, start: u32, normal: DVec3, doubtful: f64) -> Seat {
        let mut best = self.seat(p, FaceId(start));
        for _ in 0..FAR {
            let nearer = self
                .across(&best)
                .map(|f| self.seat(p, f))
                .fold(best, |a, b| if b.distance < a.distance { b } else { a });
            if nearer.face == best.face {
                break;
            }
            best = nearer;
        }
        if best.distance <= doubtful {
            return best;
        }
        let tree = self.tree.get_or_init(|| TriBvh::build(self.mesh).ok()).as_ref();
        match tree.and_then(|tree| tree.closest_point_within(self.mesh, p, best.distance)) {
            Some(near) if mesh_core::face_normal(self.mesh, near.face).dot(normal) > 0.0 => {
                Seat { face: near.face.0, barycentric: near.barycentric, point: near.point, distance: near.distance }
            }
            _ => best,
        }
    }

    /// The faces on the other sides of the vertex or edge that a seat lies on; none inside a face.
    fn across(&self, seat: &Seat) -> impl Iterator<Item = FaceId> + '_ {
        let (f, w) = (FaceId(seat.face), seat.barycentric);
        let corner = w.iter().position(|&x| x >= 1.0);
        let vertex = corner.map(|k| self.mesh.corners(f)[k]);
        let edge = if corner.is_some() { None } else { w.iter().position(|&x| x <= 0.0) };
        let beyond = edge.and_then(|k| self.mesh.twin(HalfedgeId::new(f, (k + 1) % 3))).map(HalfedgeId::face);
        vertex.into_iter().flat_map(|v| self.mesh.ring(v)).map(HalfedgeId::face).chain(beyond)
    }
}
