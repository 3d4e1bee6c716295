//! Blend curves: chains of mesh edges with a left and a right side.

use crate::Error;
use glam::DVec3;
use mesh_core::{Adjacency, Faces, HalfedgeId, Positions, VertexId};

/// A chain of mesh edges along which a ball is to roll.
///
/// Walking along the halfedges with the surface normal up, their own faces lie on the left and their twins' faces on
/// the right.
#[derive(Clone, Debug, PartialEq)]
pub struct BlendCurve {
    /// The chain, head to tail.
    pub halfedges: Vec<HalfedgeId>,
    /// Whether the last one's head is the first one's tail, and the ball rolls round.
    pub closed: bool,
}

/// Which side of the surface the ball rolls on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Convexity {
    /// The faces form a ridge: the ball rolls inside the solid and takes material away.
    Convex,
    /// The faces form a valley: the ball rolls outside and adds material.
    Concave,
}

impl Convexity {
    /// The other one.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Convex => Self::Concave,
            Self::Concave => Self::Convex,
        }
    }
}

impl BlendCurve {
    /// The chain through a closed cycle of vertices, each joined to the next by an edge with two faces.
    ///
    /// # Errors
    /// [`Error::NotAnEdge`] where two consecutive vertices are not so joined.
    pub fn from_vertices<M: Adjacency + Positions>(mesh: &M, cycle: &[VertexId]) -> Result<Self, Error> {
        let halfedge = |i: usize| {
            let (a, b) = (cycle[i], cycle[(i + 1) % cycle.len()]);
            let inner = mesh.halfedge(a, b).filter(|&h| mesh.twin(h).is_some());
            inner.ok_or_else(|| Error::NotAnEdge { from: a, to: b, at: mesh.position(a) })
        };
        let halfedges = (0..cycle.len()).map(halfedge).collect::<Result<_, _>>()?;
        Ok(Self { halfedges, closed: true })
    }

    /// The points of the chain; of a closed one the first is not repeated, of an open one the last is left out.
    pub fn points<M: Faces + Positions>(&self, mesh: &M) -> Vec<DVec3> {
        self.halfedges.iter().map(|&h| mesh.position(mesh.tail(h))).collect()
    }

    /// Length in model units.
    pub fn length<M: Faces + Positions>(&self, mesh: &M) -> f64 {
        self.halfedges.iter().map(|&h| mesh.edge_length(h)).sum()
    }

    /// Both ends of an open curve, each with the unit direction in which the curve leaves it; none of a closed one.
    pub fn ends<M: Faces + Positions>(&self, mesh: &M) -> Vec<(DVec3, DVec3)> {
        let (Some(&first), Some(&last), false) = (self.halfedges.first(), self.halfedges.last(), self.closed) else {
            return vec![];
        };
        let end = |at: VertexId, before: VertexId| {
            let at = mesh.position(at);
            (at, (at - mesh.position(before)).normalize_or_zero())
        };
        vec![end(mesh.tail(first), mesh.head(first)), end(mesh.head(last), mesh.tail(last))]
    }

    /// Ridge or valley. The signs of the edges are weighed by their lengths, since the slivers of a boolean seam have
    /// meaningless normals.
    ///
    /// # Errors
    /// [`Error::MixedConvexity`] when more than a tenth of the length disagrees with the rest.
    pub fn convexity<M: Adjacency + Positions>(&self, mesh: &M) -> Result<Convexity, Error> {
        let (mut ridge, mut valley) = ((0.0, DVec3::ZERO), (0.0, DVec3::ZERO));
        for &h in &self.halfedges {
            let Some(t) = mesh.twin(h) else { continue };
            let [a, b] = mesh.ends(h);
            let rise = (mesh.position(mesh.tail(h.prev())) - a).dot(face_normal(mesh, t));
            let kind = if rise > 0.0 { &mut valley } else { &mut ridge };
            if kind.0 == 0.0 {
                kind.1 = a;
            }
            kind.0 += a.distance(b);
        }
        let (kind, minor, major) =
            if valley.0 >= ridge.0 { (Convexity::Concave, ridge, valley) } else { (Convexity::Convex, valley, ridge) };
        if minor.0 > 0.1 * (minor.0 + major.0) {
            return Err(Error::MixedConvexity { at: minor.1, share: minor.0 / (minor.0 + major.0) });
        }
        Ok(kind)
    }
}

/// Unit normal of the face a halfedge bounds; zero when the face has no area.
pub(crate) fn face_normal<M: Faces + Positions>(mesh: &M, h: HalfedgeId) -> DVec3 {
    let [a, b, c] = mesh.triangle(h.face());
    (b - a).cross(c - a).normalize_or_zero()
}
