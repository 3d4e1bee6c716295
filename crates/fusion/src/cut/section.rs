//! The contours in which a plane meets a mesh.

use super::{Error, PlaneCut};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, Faces, HalfedgeId, Positions, SurfacePoint, TriMesh, VertexId};
use tri_intersect::embed::{EmbedError, SurfaceCurve};

/// A mesh seen from a plane. Every vertex has one sign, which alone decides where contours run, so that they are closed
/// whatever rounding does.
pub(super) struct Section<'a> {
    mesh: &'a Connected<TriMesh>,
    /// Signed distance of each vertex, in model units.
    heights: Vec<f64>,
}

impl<'a> Section<'a> {
    pub(super) fn new(mesh: &'a Connected<TriMesh>, plane: &PlaneCut) -> Result<Self, Error> {
        let PlaneCut { point, normal, .. } = *plane;
        // Normals of any length: scaled first, so that squares neither overflow nor vanish.
        let unit = (normal / normal.abs().max_element()).try_normalize().filter(|_| point.is_finite());
        let Some(unit) = unit else { return Err(Error::NoPlane { point, normal }) };
        let heights: Vec<f64> = mesh.mesh().positions.iter().map(|&p| (p - point).dot(unit)).collect();
        Ok(Self { mesh, heights })
    }

    /// A section by heights of any kind.
    pub(super) const fn of_heights(mesh: &'a Connected<TriMesh>, heights: Vec<f64>) -> Self {
        Self { mesh, heights }
    }

    /// Signed distance of a vertex from the plane, in model units.
    pub(super) fn height(&self, v: VertexId) -> f64 {
        self.heights.get(v.index()).copied().unwrap_or(0.0)
    }

    /// Whether a vertex goes: those in the plane do, so that each has one side only.
    fn goes(&self, v: VertexId) -> bool {
        self.heights[v.index()] >= 0.0
    }

    /// Whether a contour enters the face of `h` over it: contours have what stays on their left.
    fn enters(&self, h: HalfedgeId) -> bool {
        !self.goes(self.mesh.tail(h)) && self.goes(self.mesh.head(h))
    }

    fn crossing(&self, h: HalfedgeId) -> SurfacePoint {
        let (a, b) = (self.heights[self.mesh.tail(h).index()], self.heights[self.mesh.head(h).index()]);
        let t = a / (a - b);
        if t <= 0.0 {
            SurfacePoint::Vertex(self.mesh.tail(h))
        } else if t < 1.0 {
            SurfacePoint::Edge { halfedge: h, t }
        } else {
            SurfacePoint::Vertex(self.mesh.head(h))
        }
    }

    /// All contours in order of their first face, or the one nearest to `seed`.
    pub(super) fn contours(&self, seed: Option<DVec3>) -> Result<Vec<SurfaceCurve>, Error> {
        let faces = self.mesh.face_count();
        let halfedges = || (0..3 * faces as u32).map(HalfedgeId);
        let mut seen = vec![false; faces];
        let mut all = vec![];
        // Those that begin on the mesh's own boundary first: begun elsewhere they would look closed to one side only.
        for h in halfedges().filter(|&h| self.mesh.twin(h).is_none()).chain(halfedges()) {
            if !seen[h.face().index()] && self.enters(h) {
                all.extend(self.follow(h, &mut seen));
            }
        }
        if all.is_empty() {
            let (low, high) =
                self.heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
            return Err(Error::Misses { low, high });
        }
        if let Some(seed) = seed {
            let far = |c: &SurfaceCurve| self.distance(c, seed);
            let nearest = (0..all.len()).min_by(|&a, &b| far(&all[a]).total_cmp(&far(&all[b]))).unwrap_or(0);
            all = vec![all.swap_remove(nearest)];
        }
        Ok(all)
    }

    /// Follows a contour from the halfedge over which it enters a face; `None` for one that only touches a vertex.
    fn follow(&self, start: HalfedgeId, seen: &mut [bool]) -> Option<SurfaceCurve> {
        let mut points = vec![];
        let mut add = |p: SurfacePoint| {
            if points.last() != Some(&p) {
                points.push(p);
            }
        };
        let mut entry = start;
        let closed = loop {
            seen[entry.face().index()] = true;
            add(self.crossing(entry));
            let exit = if self.goes(self.mesh.head(entry.next())) { entry.prev() } else { entry.next() };
            match self.mesh.twin(exit) {
                None => {
                    add(self.crossing(exit));
                    break false;
                }
                Some(next) if next == start => break true,
                Some(next) => entry = next,
            }
        };
        if closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        (points.len() > if closed { 2 } else { 1 }).then_some(SurfaceCurve { points, closed })
    }

    /// Distance of a point from a contour, in model units.
    fn distance(&self, curve: &SurfaceCurve, p: DVec3) -> f64 {
        let places: Vec<DVec3> = curve.points.iter().map(|q| q.position(self.mesh)).collect();
        let last = if curve.closed { places.len() } else { places.len() - 1 };
        let to_piece = |i: usize| {
            let (a, b) = (places[i], places[(i + 1) % places.len()]);
            let t = ((p - a).dot(b - a) / a.distance_squared(b)).clamp(0.0, 1.0);
            p.distance(if t.is_finite() { a.lerp(b, t) } else { a })
        };
        (0..last).map(to_piece).fold(f64::INFINITY, f64::min)
    }

    /// Contours of one plane meet each other only where the plane touches a saddle.
    pub(super) fn explain(&self, error: EmbedError) -> Error {
        match error {
            EmbedError::Crossings(crossings) => {
                let at = crossings.first().map_or_else(|| self.mesh.position(VertexId(0)), |c| c.place);
                Error::Pinched { at }
            }
            EmbedError::Cancelled(c) => c.into(),
            other => other.into(),
        }
    }

    /// Whether a face that no contour touches lies beyond the plane.
    pub(super) fn is_beyond(&self, mesh: &Connected<TriMesh>, f: FaceId) -> bool {
        mesh.corners(f).iter().any(|&v| self.height(v) > 0.0)
    }
}
