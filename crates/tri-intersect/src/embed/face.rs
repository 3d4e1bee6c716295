//! The triangulation of one crossed face: a polygon of its corners and the points on its sides, with pieces of curve in it.

use super::arrange::{Arrangement, Segment};
use super::clash::Clash;
use super::small;
use glam::DVec3;
use mesh_core::{Adjacency, FaceId, HalfedgeId, Positions, SurfacePoint, VertexId};
use robust::{Coord, orient2d};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// The pieces of a face.
pub(super) struct Split {
    pub triangles: Vec<[VertexId; 3]>,
    /// Whether some piece has no positive area along the face's normal.
    pub flattened: bool,
}

/// Splits face `f` along all curves in it, or says what meets there.
pub(super) fn split<M: Adjacency + Positions>(mesh: &M, all: &Arrangement, f: FaceId) -> Result<Split, Vec<Clash>> {
    let polygon = Polygon::new(mesh, all, f);
    let projected = polygon.projected();
    let sound = projected
        .as_ref()
        .and_then(|points| polygon.triangulate_small(points).or_else(|| polygon.triangulate(points).ok()));
    let (triangles, flattened) = if let Some(triangles) = sound {
        (triangles, false)
    } else {
        let triangles = polygon.triangulate(&polygon.barycentric())?;
        let sound = projected.is_some_and(|points| triangles.iter().all(|t| positive(&points, *t)));
        (triangles, !sound)
    };
    let triangles = triangles.into_iter().map(|t| t.map(|k| polygon.vertices[k])).collect();
    Ok(Split { triangles, flattened })
}

type Flat = [f64; 2];

fn turn(points: &[Flat], [a, b, c]: [usize; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|k| Coord { x: points[k][0], y: points[k][1] });
    orient2d(a, b, c)
}

fn positive(points: &[Flat], t: [usize; 3]) -> bool {
    turn(points, t) > 0.0
}

/// Indices into `vertices` run along the sides first, counter-clockwise from corner 0, then over points inside.
struct Polygon<'a> {
    all: &'a Arrangement,
    face: FaceId,
    corners: [VertexId; 3],
    vertices: Vec<VertexId>,
    places: Vec<DVec3>,
    /// The sides (bits 0, 1, 2) that a boundary vertex is on. Its length is the number of boundary vertices.
    sides: Vec<u8>,
    segments: &'a [Segment],
    /// The segments' ends as indices into `vertices`.
    ends: Vec<[usize; 2]>,
}

impl<'a> Polygon<'a> {
    fn new<M: Adjacency + Positions>(mesh: &M, all: &'a Arrangement, face: FaceId) -> Self {
        let corners = mesh.corners(face);
        let segments = all.segments_in(face);
        let (mut vertices, mut sides) = (Vec::with_capacity(8), Vec::with_capacity(8));
        for (k, corner) in corners.into_iter().enumerate() {
            vertices.push(corner);
            sides.push(1 << k | 1 << ((k + 2) % 3));
            let h = HalfedgeId::new(face, k);
            let lower = HalfedgeId(mesh.edge(h).0);
            let points = all.on_edge(lower).iter().map(|p| p.vertex);
            if lower == h {
                vertices.extend(points);
            } else {
                vertices.extend(points.rev());
            }
            sides.resize(vertices.len(), 1 << k);
        }
        let mut inside: Vec<_> = segments
            .iter()
            .flat_map(|s| s.ends)
            .filter(|&v| matches!(all.address(v), SurfacePoint::Face { .. }))
            .collect();
        inside.sort_unstable();
        inside.dedup();
        let boundary = vertices.len();
        let index_of = |v: VertexId| match inside.binary_search(&v) {
            Ok(k) => boundary + k,
            Err(_) => vertices.iter().position(|&w| w == v).unwrap_or(0),
        };
        let ends = segments.iter().map(|s| s.ends.map(index_of)).collect();
        vertices.extend(inside);
        let places = vertices.iter().map(|&v| all.position(mesh, v)).collect();
        Self { all, face, corners, vertices, places, sides, segments, ends }
    }

    /// The points along the coordinate axis nearest to the normal, turned counter-clockwise; `None` if the face has no area there.
    /// All coordinates are scaled by one power of two, which is exact.
    fn projected(&self) -> Option<Vec<Flat>> {
        let largest = self.places.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        if !(largest > 0.0 && self.places.iter().all(|p| p.is_finite())) {
            return None;
        }
        let scale = 2f64.powi(-largest.log2().floor().clamp(-1000.0, 1000.0) as i32);
        let corner = |v: VertexId| self.vertices.iter().position(|&w| w == v).map(|k| self.places[k] * scale);
        let [a, b, c] = [corner(self.corners[0])?, corner(self.corners[1])?, corner(self.corners[2])?];
        let normal = (b - a).cross(c - a).abs();
        let (x, y) = match normal.max_position() {
            0 => (1, 2),
            1 => (2, 0),
            _ => (0, 1),
        };
        // spade takes no coordinate between 0 and 2^-142.
        let flush = |x: f64| if x.abs() < 1e-42 { 0.0 } else { x };
        let flat = |p: DVec3| [flush(p[x]), flush(p[y])];
        let area = turn(&[flat(a), flat(b), flat(c)], [0, 1, 2]);
        let points = self.places.iter().map(|&p| flat(p * scale));
        if area > 0.0 {
            Some(points.collect())
        } else if area < 0.0 {
            Some(points.map(|[x, y]| [y, x]).collect())
        } else {
            None
        }
    }

    /// The points by their addresses alone, on the triangle (0, 0), (1, 0), (0, 1).
    fn barycentric(&self) -> Vec<Flat> {
        let corner = |v: VertexId| match self.corners.iter().position(|&c| c == v) {
            Some(1) => [1.0, 0.0],
            Some(2) => [0.0, 1.0],
            _ => [0.0, 0.0],
        };
        let mut points: Vec<_> = self
            .vertices
            .iter()
            .map(|&v| match self.all.address(v) {
                SurfacePoint::Face { barycentric: [_, x, y], .. } => [x, y],
                _ => corner(v),
            })
            .collect();
        for (k, point) in points.iter_mut().enumerate().take(self.sides.len()) {
            if let SurfacePoint::Edge { t, .. } = self.all.address(self.vertices[k]) {
                let side = self.sides[k].trailing_zeros() as usize;
                let (tail, head) = (self.corners[side], self.corners[(side + 1) % 3]);
                let t = if self.runs_with(k) { t } else { 1.0 - t };
                let (a, b) = (corner(tail), corner(head));
                *point = [0, 1].map(|i| (1.0 - t) * a[i] + t * b[i]);
            }
        }
        points
    }

    /// Whether the parameter of boundary vertex `k` grows counter-clockwise.
    fn runs_with(&self, k: usize) -> bool {
        match self.all.address(self.vertices[k]) {
            SurfacePoint::Edge { halfedge, .. } => halfedge.face() == self.face,
            _ => true,
        }
    }

    /// The common case, few chains from side to side.
    fn triangulate_small(&self, points: &[Flat]) -> Option<Vec<[usize; 3]>> {
        let mut triangles = Vec::with_capacity(2 * self.vertices.len() - self.sides.len());
        let score = |t: [usize; 3]| {
            if !self.on_one_side(t) && turn(points, t) > 0.0 { self.roundness(t) } else { 0.0 }
        };
        for part in small::divide(self.sides.len(), &self.ends)? {
            small::triangulate(&part, score, &mut triangles)?;
        }
        Some(triangles)
    }

    /// Whether all three corners lie on one side of the face.
    fn on_one_side(&self, t: [usize; 3]) -> bool {
        t.iter().fold(7, |m, &k| m & self.sides.get(k).copied().unwrap_or(0)) != 0
    }

    /// Area over squared longest side: 0 for a needle, 0.43 for an equilateral triangle.
    fn roundness(&self, t: [usize; 3]) -> f64 {
        let [a, b, c] = t.map(|k| self.places[k]);
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        if longest > 0.0 { 0.5 * (b - a).cross(c - a).length() / longest } else { 0.0 }
    }

    /// Constrained Delaunay triangulation of the polygon.
    fn triangulate(&self, points: &[Flat]) -> Result<Vec<[usize; 3]>, Vec<Clash>> {
        let boundary = self.sides.len();
        let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>, (), Piece>::new();
        let mut handles = Vec::with_capacity(points.len());
        for &[x, y] in points {
            match cdt.insert(Point2::new(x, y)) {
                Ok(h) if h.index() == handles.len() => handles.push(h),
                Ok(h) => return Err(vec![self.clash_of_vertices(handles.len(), h.index())]),
                Err(_) => return Err(vec![self.clash_of_vertices(0, 0)]),
            }
        }
        for k in 0..boundary {
            let next = (k + 1) % boundary;
            if cdt.try_add_constraint(handles[k], handles[next]).len() != 1 {
                return Err(vec![self.clash_of_vertices(k, next)]);
            }
        }
        let mut clashes = vec![];
        for (s, &[a, b]) in self.ends.iter().enumerate() {
            let laid = cdt.try_add_constraint(handles[a], handles[b]);
            if laid.len() == 1 {
                cdt.undirected_edge_data_mut(laid[0].as_undirected()).data_mut().0 = s + 1;
            } else if let Some(&edge) = laid.first() {
                clashes.push(self.clash_at_vertex(s, cdt.directed_edge(edge).to().index()));
            } else {
                let met = cdt
                    .get_conflicting_edges_between_vertices(handles[a], handles[b])
                    .map(|e| e.as_undirected().data().data().0)
                    .collect::<Vec<_>>();
                if met.is_empty() {
                    clashes.push(self.clash_of_vertices(a, b));
                }
                clashes.extend(met.into_iter().map(|other| self.clash_of_segments(points, s, other.checked_sub(1))));
            }
        }
        if !clashes.is_empty() {
            return Err(clashes);
        }
        // What rounding has left between a side and the chain of its points has all three corners on that side.
        let triangles: Vec<_> =
            cdt.inner_faces().map(|f| f.vertices().map(|v| v.index())).filter(|t| !self.on_one_side(*t)).collect();
        if triangles.len() == 2 * (points.len() - boundary) + boundary - 2 {
            Ok(triangles)
        } else {
            Err(vec![self.clash_of_vertices(0, 0)])
        }
    }

    fn clash_of_vertices(&self, a: usize, b: usize) -> Clash {
        let sites = [a, b].map(|k| self.all.site_of(self.vertices[k]));
        Clash { place: self.places[a], face: self.face, sites: if a == b { [None; 2] } else { sites } }
    }

    fn clash_at_vertex(&self, segment: usize, vertex: usize) -> Clash {
        let sites = [Some(self.segments[segment].site), self.all.site_of(self.vertices[vertex])];
        Clash { place: self.places[vertex], face: self.face, sites }
    }

    fn clash_of_segments(&self, points: &[Flat], segment: usize, other: Option<usize>) -> Clash {
        let [a, b] = self.ends[segment];
        let share = other.map_or(0.5, |other| {
            let [c, d] = self.ends[other];
            let (p, q) = (turn(points, [c, d, a]), turn(points, [c, d, b]));
            if p == q { 0.5 } else { (p / (p - q)).clamp(0.0, 1.0) }
        });
        Clash {
            place: self.places[a].lerp(self.places[b], share),
            face: self.face,
            sites: [Some(self.segments[segment].site), other.map(|k| self.segments[k].site)],
        }
    }
}

/// The segment (counted from 1) that a constraint edge belongs to; 0 for the face's own sides.
#[derive(Clone, Copy, Default)]
struct Piece(usize);
