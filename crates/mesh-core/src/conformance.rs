//! What every implementor of the traits must keep, as checks to run on yours. Behind the feature `conformance`.
//!
//! ```
//! # #[cfg(feature = "conformance")] {
//! let mesh = mesh_core::Connected::new(mesh_core::shapes::torus(2.0, 0.5, 8, 6)).unwrap();
//! assert_eq!(mesh_core::conformance::adjacency(&mesh), Ok(()));
//! # }
//! ```

use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::traits::{Adjacency, Faces, MeshSink, Positions};
use glam::DVec3;

macro_rules! require {
    ($holds:expr, $($what:tt)+) => {
        if !$holds {
            return Err(format!($($what)+));
        }
    };
}

/// Ids run from zero, and halfedges agree with corners.
///
/// # Errors
/// The first broken promise, in words.
pub fn faces<M: Faces>(mesh: &M) -> Result<(), String> {
    require!(mesh.face_ids().eq((0..mesh.face_count() as u32).map(FaceId)), "face_ids does not count the faces");
    require!(
        mesh.vertex_ids().eq((0..mesh.vertex_count() as u32).map(VertexId)),
        "vertex_ids does not count the vertices"
    );
    for f in mesh.face_ids() {
        let c = mesh.corners(f);
        for k in 0..3 {
            let h = HalfedgeId::new(f, k);
            require!(mesh.tail(h) == c[k] && mesh.head(h) == c[(k + 1) % 3], "tail or head of {h} is no corner of {f}");
        }
    }
    Ok(())
}

/// Twins are mutual and opposite, rings are whole, boundary rings start at the boundary.
///
/// # Errors
/// The first broken promise, in words.
pub fn adjacency<M: Adjacency>(mesh: &M) -> Result<(), String> {
    faces(mesh)?;
    let mut degree = vec![0usize; mesh.vertex_count()];
    for h in (0..3 * mesh.face_count() as u32).map(HalfedgeId) {
        let v = mesh.tail(h);
        require!(v.index() < degree.len(), "face {} names vertex {v} of {}", h.face(), degree.len());
        degree[v.index()] += 1;
        let t = mesh.twin(h);
        require!(mesh.edge(h).0 == t.map_or(h.0, |t| t.0.min(h.0)), "edge of {h} is not its lower halfedge");
        if let Some(t) = t {
            require!(t != h && mesh.twin(t) == Some(h), "the twin of {h} is {t}, whose twin is another");
            require!(mesh.tail(t) == mesh.head(h) && mesh.head(t) == v, "{h} and its twin {t} are not opposite");
        }
    }
    for v in mesh.vertex_ids() {
        let ring: Vec<HalfedgeId> = mesh.ring(v).take(degree[v.index()] + 1).collect();
        require!(ring.first().copied() == mesh.outgoing(v), "the ring of {v} does not start at `outgoing`");
        require!(ring.iter().all(|&h| mesh.tail(h) == v), "the ring of {v} has halfedges that leave elsewhere");
        require!(ring.len() == degree[v.index()], "the ring of {v} has not its {} faces", degree[v.index()]);
        let mut once = ring.clone();
        once.sort_unstable();
        once.dedup();
        require!(once.len() == ring.len(), "the ring of {v} passes a face twice");
        require!(
            ring.iter().skip(1).all(|&h| mesh.twin(h).is_some()),
            "the ring of {v} does not start at the boundary"
        );
    }
    Ok(())
}

/// A sink numbers from zero and gives back what it took.
///
/// # Errors
/// The first broken promise, in words; a refusal counts as one.
pub fn sink<S: MeshSink + Faces + Positions>(empty: &mut S) -> Result<(), String> {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.1, -0.0, 1e300)];
    for (i, &p) in points.iter().enumerate() {
        let v = empty.vertex(p).map_err(|_| "the sink refused a vertex")?;
        require!(v == VertexId::from(i), "vertex {i} got the id {v}");
    }
    for (i, c) in [[0, 1, 2], [0, 3, 1]].into_iter().enumerate() {
        let corners = c.map(VertexId);
        let f = empty.face(corners).map_err(|_| "the sink refused a face")?;
        require!(f == FaceId::from(i), "face {i} got the id {f}");
        require!(empty.corners(f) == corners, "face {i} came back with other corners");
    }
    let same = points
        .iter()
        .enumerate()
        .all(|(i, p)| empty.position(VertexId::from(i)).to_array().map(f64::to_bits) == p.to_array().map(f64::to_bits));
    require!(same, "a point came back with other bits");
    require!(empty.vertex_count() == 4 && empty.face_count() == 2, "the sink does not count what it took");
    faces(empty)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, TriMesh, shapes};

    #[test]
    fn our_own_types_conform() {
        assert_eq!(sink(&mut TriMesh::default()), Ok(()));
        for mesh in [shapes::torus(2.0, 1.0, 9, 7), shapes::grid(1.0, 1.0, 4, 3), shapes::teapot(3).handle] {
            assert_eq!(faces(&mesh), Ok(()));
            assert_eq!(adjacency(&&Connected::new(&mesh).unwrap()), Ok(()));
        }
        assert_eq!(adjacency(&Connected::new(TriMesh::default()).unwrap()), Ok(()));
    }

    /// A torus whose ring walks start in the wrong place, and one whose twins are not mutual.
    struct Broken(Connected<TriMesh>, bool);

    impl Faces for Broken {
        fn vertex_count(&self) -> usize {
            self.0.vertex_count()
        }
        fn face_count(&self) -> usize {
            self.0.face_count()
        }
        fn corners(&self, f: FaceId) -> [VertexId; 3] {
            self.0.corners(f)
        }
    }

    impl Adjacency for Broken {
        fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId> {
            self.0.twin(h).filter(|_| self.1 || h.0 != 5)
        }
        fn outgoing(&self, v: VertexId) -> Option<HalfedgeId> {
            self.0.outgoing(v).map(|h| if self.1 { h.next() } else { h })
        }
    }

    #[test]
    fn broken_ones_are_told() {
        let torus = || Connected::new(shapes::torus(2.0, 1.0, 9, 7)).unwrap();
        assert!(adjacency(&Broken(torus(), true)).unwrap_err().contains("leave elsewhere"));
        assert!(adjacency(&Broken(torus(), false)).unwrap_err().contains("whose twin is another"));
    }
}
