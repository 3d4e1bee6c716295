//! The ring of triangles around a curve that a blend takes: all that touch a vertex between the linkages.
//!
//! A vertex is *inner* if it lies between the linkages by more than a share of its edges; the region is made of all
//! triangles with an inner vertex. So no triangle has all its corners on one border, where it would be flattened, and
//! border vertices lie about as often before a linkage as beyond it. Where a border still has a chord, a pinch or a bay,
//! the vertex there is made inner too.

use super::refusal::Refusal;
use super::target::Target;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, VertexId, boundary_loops};
use param_conformal::{Error as MapError, Ring};
use spine::{BlendCurve, Rail};

/// A vertex nearer to its linkage than this share of its mean edge is for the border, even if it lies inside.
const BORDER_SHARE: f64 = 0.4;

/// How often a border is widened before it is given up.
const ROUNDS: usize = 12;

/// A region, as a mesh of its own.
pub(super) struct Region {
    /// The region's vertices, ascending: local vertex i is `vertices[i]` of the mesh.
    pub vertices: Vec<VertexId>,
    /// Its faces, ascending: local face i is `faces[i]`.
    pub faces: Vec<FaceId>,
    pub local: Connected<TriMesh>,
    /// Its loops; the bottom is that along the right linkage.
    pub ring: Ring,
    /// Where each vertex of the two loops lies along its linkage, as t; NaN for inner vertices.
    pub stations: Vec<f64>,
}

/// Where a vertex lies beside its linkage.
#[derive(Clone, Copy)]
struct Place {
    vertex: VertexId,
    /// 0 left of the curve, 1 right, 2 on it.
    side: u8,
    inner: bool,
    /// Sample near it.
    hint: u32,
    station: f64,
}

/// Scratch over a whole mesh, cleared after each region by undoing what it did.
pub(super) struct Places {
    /// Index in the region's list, for each vertex of the mesh.
    of_vertex: Vec<u32>,
    /// Whether a face is in the region.
    taken: Vec<bool>,
}

const NONE: u32 = u32::MAX;

impl Places {
    pub fn new(mesh: &impl Faces) -> Self {
        Self { of_vertex: vec![NONE; mesh.vertex_count()], taken: vec![false; mesh.face_count()] }
    }
}

impl Region {
    /// Grows the region around `curve`.
    pub fn around(
        mesh: &Connected<TriMesh>,
        curve: &BlendCurve,
        rail: &Rail,
        target: &Target,
        scratch: &mut Places,
    ) -> Result<Self, Refusal> {
        let mut growth = Growth { mesh, target, places: Vec::new(), faces: Vec::new(), scratch };
        let grown = growth.seed(curve, rail).and_then(|()| growth.finish());
        for place in &growth.places {
            growth.scratch.of_vertex[place.vertex.index()] = NONE;
        }
        for f in &growth.faces {
            growth.scratch.taken[f.index()] = false;
        }
        grown
    }
}

struct Growth<'a> {
    mesh: &'a Connected<TriMesh>,
    target: &'a Target,
    /// Every vertex met, in the order they were.
    places: Vec<Place>,
    faces: Vec<FaceId>,
    scratch: &'a mut Places,
}

impl Growth<'_> {
    /// Takes the curve's own vertices and spreads from them to either side.
    fn seed(&mut self, curve: &BlendCurve, rail: &Rail) -> Result<(), Refusal> {
        let mesh = self.mesh;
        let n = curve.halfedges.len();
        let mut hint = 0;
        let centers: Vec<DVec3> = rail.samples.iter().map(|s| s.center).collect();
        for (k, &h) in curve.halfedges.iter().enumerate() {
            let vertex = mesh.tail(h);
            let p = mesh.position(vertex);
            hint = if k == 0 { nearest(&centers, p) } else { descend(&centers, hint, p) };
            if self.scratch.of_vertex[vertex.index()] != NONE {
                return Err(Refusal::Overlap { at: p });
            }
            self.scratch.of_vertex[vertex.index()] = self.places.len() as u32;
            self.places.push(Place { vertex, side: 2, inner: true, hint: hint as u32, station: f64::NAN });
        }
        for (k, &ahead) in curve.halfedges.iter().enumerate() {
            let back = mesh.twin(curve.halfedges[(k + n - 1) % n]);
            // Counter-clockwise from the way ahead: first the left side, from the way back on the right one.
            let (mut side, mut h) = (0, ahead);
            loop {
                if Some(h) == back {
                    side = 1;
                }
                self.take(h.face(), side, self.places[k].hint);
                h = mesh.twin(h.prev()).ok_or(Refusal::Boundary { at: mesh.position(mesh.tail(h)) })?;
                if h == ahead {
                    break;
                }
            }
        }
        let mut next = n;
        while let Some(&place) = self.places.get(next) {
            next += 1;
            if place.inner {
                self.take_star(place)?;
            }
        }
        Ok(())
    }

    fn take_star(&mut self, place: Place) -> Result<(), Refusal> {
        for h in self.mesh.ring(place.vertex) {
            if self.mesh.twin(h.prev()).is_none() {
                return Err(Refusal::Boundary { at: self.mesh.position(place.vertex) });
            }
            self.take(h.face(), place.side, place.hint);
        }
        Ok(())
    }

    /// Adds a face, and finds the places of its vertices.
    fn take(&mut self, face: FaceId, side: u8, hint: u32) {
        if std::mem::replace(&mut self.scratch.taken[face.index()], true) {
            return;
        }
        self.faces.push(face);
        for vertex in self.mesh.corners(face) {
            if self.scratch.of_vertex[vertex.index()] == NONE {
                self.scratch.of_vertex[vertex.index()] = self.places.len() as u32;
                let place = self.place(vertex, side.min(1), hint as usize);
                self.places.push(place);
            }
        }
    }

    fn place(&self, vertex: VertexId, side: u8, hint: usize) -> Place {
        let (mesh, p) = (self.mesh, self.mesh.position(vertex));
        let feet = &self.target.feet[side as usize];
        let outward = &self.target.outward[side as usize];
        let stations = &self.target.stations;
        let n = feet.len() - 1;
        let hint = descend(&feet[..n], hint, p);
        let mut best = (f64::INFINITY, 0.0, 0.0);
        for i in [(hint + n - 1) % n, hint] {
            let (a, b) = (feet[i], feet[i + 1]);
            let s = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let s = if s.is_nan() { 0.0 } else { s };
            let q = a.lerp(b, s);
            let d = p.distance_squared(q);
            if d < best.0 {
                let past = (p - q).dot(outward[i].lerp(outward[i + 1], s));
                best = (d, past, stations[i] + s * (stations[i + 1] - stations[i]));
            }
        }
        let (mut sum, mut count) = (0.0, 0.0);
        for h in mesh.ring(vertex) {
            sum += p.distance(mesh.position(mesh.head(h)));
            count += 1.0;
        }
        let inner = best.1 * count < -BORDER_SHARE * sum;
        Place { vertex, side, inner, hint: hint as u32, station: best.2 }
    }

    /// Makes the region a ring with clean borders.
    fn finish(&mut self) -> Result<Region, Refusal> {
        for _ in 0..ROUNDS {
            self.faces.sort_unstable();
            let (vertices, local) = self.local();
            let pinched = |e: mesh_core::NotManifold| e.vertices;
            let mut widen: Vec<VertexId> = match Connected::new(local).map_err(pinched) {
                Err(pinches) => pinches.into_iter().map(|v| vertices[v.index()]).collect(),
                Ok(local) => {
                    let loops = boundary_loops(&local);
                    let found = self.bays_and_chords(&vertices, &local, &loops);
                    if found.is_empty() {
                        return self.region(vertices, local);
                    }
                    found
                }
            };
            widen.sort_unstable();
            widen.dedup();
            for v in widen {
                let i = self.scratch.of_vertex[v.index()] as usize;
                if self.places[i].inner {
                    return Err(Refusal::Pinched { vertex: v, at: self.mesh.position(v) });
                }
                self.places[i].inner = true;
                self.take_star(self.places[i])?;
            }
        }
        let at = self.places[0].vertex;
        Err(Refusal::Pinched { vertex: at, at: self.mesh.position(at) })
    }

    /// The region as a mesh, vertices in the order of their ids.
    fn local(&self) -> (Vec<VertexId>, TriMesh) {
        let mut vertices: Vec<VertexId> = self.faces.iter().flat_map(|&f| self.mesh.corners(f)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut of_place = vec![0u32; self.places.len()];
        for (i, v) in (0..).zip(&vertices) {
            of_place[self.scratch.of_vertex[v.index()] as usize] = i;
        }
        let corner = |v: VertexId| of_place[self.scratch.of_vertex[v.index()] as usize];
        let positions = vertices.iter().map(|&v| self.mesh.position(v)).collect();
        let mesh = TriMesh::from_arrays(positions, self.faces.iter().map(|&f| self.mesh.corners(f).map(corner)));
        (vertices, mesh)
    }

    /// Border vertices that are to become inner: one of each chord's ends, and those whose outer triangles have nothing
    /// but border vertices.
    fn bays_and_chords(
        &self,
        vertices: &[VertexId],
        local: &Connected<TriMesh>,
        loops: &[Vec<HalfedgeId>],
    ) -> Vec<VertexId> {
        let mut on_loop = vec![NONE; vertices.len()];
        for (k, walk) in (0..).zip(loops) {
            for &h in walk {
                on_loop[local.tail(h).index()] = k;
            }
        }
        let mut found = Vec::new();
        for h in local.halfedge_ids() {
            let (a, b) = (local.tail(h), local.head(h));
            let chord = on_loop[a.index()] != NONE && on_loop[a.index()] == on_loop[b.index()];
            if chord && local.twin(h).is_some_and(|t| h < t) {
                found.push(vertices[a.min(b).index()]);
            }
        }
        let loop_of = |v: VertexId| vertices.binary_search(&v).map_or(NONE, |i| on_loop[i]);
        for &h in loops.iter().flatten() {
            let v = vertices[local.tail(h).index()];
            let mine = loop_of(v);
            for g in self.mesh.ring(v).filter(|g| !self.scratch.taken[g.face().index()]) {
                let [a, b] = [self.mesh.head(g), self.mesh.tail(g.prev())];
                if loop_of(a) == mine && loop_of(b) == mine {
                    found.push(self.middle_of([v, a, b]));
                }
            }
        }
        found
    }

    /// Of three border vertices of one triangle the one that comes between the others.
    fn middle_of(&self, corners: [VertexId; 3]) -> VertexId {
        let p = corners.map(|v| self.mesh.position(v));
        let facing = |k: usize| p[(k + 1) % 3].distance_squared(p[(k + 2) % 3]);
        let widest = (0..3).max_by(|&i, &j| facing(i).total_cmp(&facing(j)).then(corners[j].cmp(&corners[i])));
        corners[widest.unwrap_or(0)]
    }

    fn region(&self, vertices: Vec<VertexId>, local: Connected<TriMesh>) -> Result<Region, Refusal> {
        let at = self.mesh.position(self.places[0].vertex);
        let ring = Ring::new(&local).map_err(|e| match e {
            MapError::NotARing { pieces, loops, .. } => Refusal::NotARing { at, loops, pieces },
            source => Refusal::Map { at, source },
        })?;
        let place = |v: VertexId| &self.places[self.scratch.of_vertex[vertices[v.index()].index()] as usize];
        let sides = ring.loops().each_ref().map(|walk| place(local.tail(walk[0])).side);
        let ring = match sides {
            [1, 0] => ring,
            [0, 1] => ring.turned(),
            _ => return Err(Refusal::NotARing { at, loops: 2, pieces: 1 }),
        };
        let mut stations = vec![f64::NAN; vertices.len()];
        for &h in ring.loops().iter().flatten() {
            stations[local.tail(h).index()] = place(local.tail(h)).station;
        }
        Ok(Region { vertices, faces: self.faces.clone(), local, ring, stations })
    }
}

/// The index of the nearest point.
fn nearest(points: &[DVec3], p: DVec3) -> usize {
    let closer = |&i: &usize, &j: &usize| points[i].distance_squared(p).total_cmp(&points[j].distance_squared(p));
    (0..points.len()).min_by(closer).unwrap_or(0)
}

/// Walks along a closed chain from `start` to a locally nearest point of it, looking a few points ahead each way.
fn descend(points: &[DVec3], start: usize, p: DVec3) -> usize {
    let n = points.len();
    let mut best = (start, points[start].distance_squared(p));
    loop {
        let here = best.0;
        for step in [1, 2, 4] {
            for i in [(here + step) % n, (here + n - step % n) % n] {
                let d = points[i].distance_squared(p);
                if d < best.1 {
                    best = (i, d);
                }
            }
        }
        if best.0 == here {
            return here;
        }
    }
}
