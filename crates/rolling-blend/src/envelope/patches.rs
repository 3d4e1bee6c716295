//! The smooth patches between sharp edges, and normals that turn evenly from facet to facet within each.

use super::sides::Sides;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, FaceMap, Faces, HalfedgeId, Positions, TriMesh, face_normals};
use spine::BlendCurve;

/// Edges that turn by at least this are walls between patches, in radians, whether they are blended or not: 30 degrees.
const CREASE: f64 = 0.524;
/// Faces whose normals differ by no more than this, in radians, form one facet.
const FLAT: f64 = 2e-3;
/// Faces of one patch that turn by more than this against each other, in radians, may block the ball for each other.
const FACING: f64 = 0.9;

/// Smooth patches of a mesh. A drilled hole, say, is one patch of many facets.
pub(crate) struct Patches {
    /// The patch of each face.
    of: FaceMap<u32>,
    normals: FaceMap<DVec3>,
    /// The facet of each face.
    facet: FaceMap<u32>,
    facets: Vec<Facet>,
    /// Both halfedges of each edge between patches.
    walls: Vec<bool>,
    sides: Sides,
}

/// Coplanar faces of one patch.
struct Facet {
    normal: DVec3,
    bands: Vec<Band>,
}

/// A strip of a facet along an edge, on which the normal turns towards that of the neighbour.
struct Band {
    ends: [DVec3; 2],
    width: f64,
    /// Half the difference of the two normals, reached at the edge.
    turn: DVec3,
}

impl Patches {
    /// The patches between `chosen` edges, those of `curves` among them, and creases. A patch on both sides of a curve is
    /// told apart there as far as a ball of radius `r` reaches.
    pub fn new<'a>(
        mesh: &Connected<TriMesh>,
        chosen: &[bool],
        curves: impl IntoIterator<Item = &'a BlendCurve>,
        r: f64,
    ) -> Self {
        let normals = face_normals(mesh);
        let turn = |h: HalfedgeId, t: HalfedgeId| normals[h.face()].dot(normals[t.face()]);
        let crease = CREASE.cos();
        let is_wall = |h: HalfedgeId| {
            chosen[h.index()] || mesh.twin(h).is_some_and(|t| turn(h, t) < crease && !degenerate(&normals, [h, t]))
        };
        let walls: Vec<bool> = mesh.halfedge_ids().map(is_wall).collect();
        let of = flood(mesh, |_, h, _| !walls[h.index()]);
        let flat = FLAT.cos();
        let facet = flood(mesh, |seed: FaceId, h, t: HalfedgeId| {
            !walls[h.index()] && turn(h, t) > flat && normals[seed].dot(normals[t.face()]) > flat
        });
        let facets = facets(mesh, &normals, &facet, &walls);
        let sides = Sides::new(mesh, curves, &of, &walls, r);
        Self { of, normals, facet, facets, walls, sides }
    }

    /// Whether an edge parts two patches.
    pub fn is_wall(&self, h: HalfedgeId) -> bool {
        self.walls[h.index()]
    }

    /// The patch of a face.
    pub fn of(&self, face: FaceId) -> u32 {
        self.of[face]
    }

    /// Whether two faces lie in one patch, and not on different sides of a curve.
    pub fn join(&self, f: FaceId, g: FaceId) -> bool {
        self.of[f] == self.of[g] && !self.sides.part(f, g)
    }

    /// The facet of a face: coplanar faces of one patch.
    pub fn facet(&self, face: FaceId) -> u32 {
        self.facet[face]
    }

    /// The outward normal at a point of a face, averaged with the neighbours' near the edges between facets. Zero where a
    /// face has none.
    pub fn normal(&self, face: FaceId, p: DVec3) -> DVec3 {
        let facet = &self.facets[self.facet[face] as usize];
        let mut sum = facet.normal;
        for band in &facet.bands {
            let share = 1.0 - to_segment(p, band.ends) / band.width;
            if share > 0.0 {
                sum += share * band.turn;
            }
        }
        sum.normalize_or(self.normals[face])
    }

    /// The normal of the face alone.
    pub fn face_normal(&self, face: FaceId) -> DVec3 {
        self.normals[face]
    }

    /// Whether a ball at rest on `face` may be stopped by `other`.
    pub fn may_block(&self, face: FaceId, other: FaceId) -> bool {
        !self.join(face, other) || self.normals[face].dot(self.normals[other]) < FACING.cos()
    }
}

fn degenerate(normals: &FaceMap<DVec3>, pair: [HalfedgeId; 2]) -> bool {
    pair.iter().any(|h| normals[h.face()] == DVec3::ZERO)
}

/// Labels for what is joined across edges; `joins` gets the first face of the label and the edge's two halfedges.
fn flood(mesh: &Connected<TriMesh>, joins: impl Fn(FaceId, HalfedgeId, HalfedgeId) -> bool) -> FaceMap<u32> {
    let mut of = FaceMap::filled(mesh.face_count(), u32::MAX);
    let mut label = 0;
    for seed in mesh.face_ids() {
        if of[seed] != u32::MAX {
            continue;
        }
        of[seed] = label;
        let mut stack = vec![seed];
        while let Some(f) = stack.pop() {
            for h in f.halfedges() {
                let Some(t) = mesh.twin(h).filter(|t| of[t.face()] == u32::MAX) else { continue };
                if joins(seed, h, t) {
                    of[t.face()] = label;
                    stack.push(t.face());
                }
            }
        }
        label += 1;
    }
    of
}

/// The facets with the bands along their smooth edges.
fn facets(mesh: &Connected<TriMesh>, normals: &FaceMap<DVec3>, facet: &FaceMap<u32>, walls: &[bool]) -> Vec<Facet> {
    let count = facet.as_slice().iter().max().map_or(0, |m| *m as usize + 1);
    let mut all: Vec<Facet> = (0..count).map(|_| Facet { normal: DVec3::ZERO, bands: vec![] }).collect();
    let mut points: Vec<Vec<DVec3>> = vec![vec![]; count];
    let mut smooth = vec![];
    for f in mesh.face_ids() {
        let own = facet[f] as usize;
        all[own].normal += mesh_core::area_vector(mesh.triangle(f));
        for h in f.halfedges() {
            points[own].push(mesh.position(mesh.tail(h)));
            if let Some(t) = mesh.twin(h).filter(|t| !walls[h.index()] && facet[t.face()] != facet[f]) {
                smooth.push((h, t));
            }
        }
    }
    for (facet, f) in facet.as_slice().iter().zip(mesh.face_ids()) {
        if all[*facet as usize].normal.length_squared() == 0.0 {
            all[*facet as usize].normal = normals[f];
        }
    }
    for f in &mut all {
        f.normal = f.normal.normalize_or_zero();
    }
    let width = |h: HalfedgeId| {
        let [a, b] = mesh.ends(h);
        let along = (b - a).normalize_or_zero();
        let off = |p: &DVec3| (*p - a).reject_from_normalized(along).length();
        if along == DVec3::ZERO { 0.0 } else { points[facet[h.face()] as usize].iter().map(off).fold(0.0, f64::max) }
    };
    for (h, t) in smooth {
        let [own, next] = [h, t].map(|h| facet[h.face()] as usize);
        let narrower = 0.5 * width(h).min(width(t));
        if narrower > 0.0 {
            let turn = 0.5 * (all[next].normal - all[own].normal);
            all[own].bands.push(Band { ends: mesh.ends(h), width: narrower, turn });
        }
    }
    all
}

/// Distance of a point from a segment.
pub(crate) fn to_segment(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    on_segment(p, [a, b]).distance(p)
}

/// The point of a segment nearest to `p`.
pub(super) fn on_segment(p: DVec3, [a, b]: [DVec3; 2]) -> DVec3 {
    let t = (p - a).dot(b - a) / (b - a).length_squared();
    // A segment without length gives NaN; its start serves.
    a + if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) } * (b - a)
}
