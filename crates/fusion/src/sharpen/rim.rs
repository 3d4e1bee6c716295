//! The rim of a rounding: where it leaves the two sides, and where it ends at creases.

use super::Refusal;
use super::rounding::Rounding;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, VertexId, area_vector, one_sided_normal};
use std::collections::BTreeSet;

/// The border of a rounding on one side.
pub(super) struct Side {
    /// In the order in which the rounding is on the left; the first is not repeated at the end of a closed one.
    pub vertices: Vec<VertexId>,
    pub points: Vec<DVec3>,
    /// Normals of the side, without the rounding.
    pub normals: Vec<DVec3>,
}

/// The border of a rounding at a crease, from one side to the other.
pub(super) struct End {
    pub vertices: Vec<VertexId>,
    /// Unit normal of the surface beyond.
    pub normal: DVec3,
}

/// The whole rim.
pub(super) struct Rim {
    pub sides: [Side; 2],
    /// The first lies between the end of side 0 and the beginning of side 1. None where the rounding is closed.
    pub ends: Option<[End; 2]>,
}

impl Rim {
    /// Walks round a rounding, which must be a band: a ring, or a strip from crease to crease.
    pub fn around(mesh: &Connected<TriMesh>, rounding: &Rounding) -> Result<Self, Refusal> {
        let loops = loops(mesh, rounding)?;
        let at = loops.first().map_or(DVec3::ZERO, |l| mesh.position(mesh.tail(l[0])));
        let crease = |h: &HalfedgeId| rounding.is_crease(mesh, *h);
        let refuse = |ends: usize| Err(Refusal::NotABand { at, loops: loops.len(), ends });
        if let [one, other] = &loops[..] {
            let ends = loops.iter().flatten().filter(|h| crease(h)).count();
            if ends > 0 {
                return refuse(ends);
            }
            let side = |walk: &[HalfedgeId]| Side::of(mesh, rounding, walk, true);
            return Ok(Self { sides: [side(one), side(other)], ends: None });
        }
        let [walk] = &loops[..] else { return refuse(0) };
        // Turned to begin with a side.
        let n = walk.len();
        let Some(first) = (0..n).find(|&i| !crease(&walk[i]) && crease(&walk[(i + n - 1) % n])) else {
            return refuse(0);
        };
        let mut walk = walk.clone();
        walk.rotate_left(first);
        let runs: Vec<&[HalfedgeId]> = walk.chunk_by(|a, b| crease(a) == crease(b)).collect();
        let &[one, between, other, back] = &runs[..] else { return refuse(runs.len() / 2) };
        Ok(Self {
            sides: [Side::of(mesh, rounding, one, false), Side::of(mesh, rounding, other, false)],
            ends: Some([End::of(mesh, between), End::of(mesh, back)]),
        })
    }
}

impl Side {
    fn of(mesh: &Connected<TriMesh>, rounding: &Rounding, walk: &[HalfedgeId], closed: bool) -> Self {
        let mut vertices: Vec<VertexId> = walk.iter().map(|&h| mesh.tail(h)).collect();
        vertices.extend(walk.last().filter(|_| !closed).map(|&h| mesh.head(h)));
        let normal = |&v: &VertexId| {
            let faces = mesh.ring(v).map(HalfedgeId::face);
            one_sided_normal(mesh, v, faces.filter(|&f| rounding.of[f] == 1))
        };
        let (points, normals) =
            (vertices.iter().map(|&v| mesh.position(v)).collect(), vertices.iter().map(normal).collect());
        Self { vertices, points, normals }
    }
}

impl End {
    fn of(mesh: &Connected<TriMesh>, walk: &[HalfedgeId]) -> Self {
        let mut vertices: Vec<VertexId> = walk.iter().map(|&h| mesh.tail(h)).collect();
        vertices.extend(walk.last().map(|&h| mesh.head(h)));
        let beyond = walk.iter().filter_map(|&h| mesh.twin(h)).map(|t| area_vector(mesh.triangle(t.face())));
        Self { vertices, normal: beyond.sum::<DVec3>().normalize_or_zero() }
    }
}

/// The loops of border halfedges, each with the rounding on its left.
fn loops(mesh: &Connected<TriMesh>, rounding: &Rounding) -> Result<Vec<Vec<HalfedgeId>>, Refusal> {
    let inside = |h: HalfedgeId| mesh.twin(h).is_some_and(|t| rounding.of[t.face()] == 2);
    let own = rounding.faces.iter().flat_map(|f| f.halfedges());
    let border: BTreeSet<HalfedgeId> = own.filter(|&h| !inside(h)).collect();
    if let Some(&h) = border.iter().find(|&&h| mesh.twin(h).is_none()) {
        return Err(Refusal::Boundary { at: mesh.position(mesh.tail(h)) });
    }
    let (mut left, mut all) = (border, vec![]);
    let mut met = BTreeSet::new();
    while let Some(&first) = left.first() {
        let (mut walk, mut h) = (vec![], first);
        while left.remove(&h) {
            if !met.insert(mesh.tail(h)) {
                return Err(Refusal::NotABand { at: mesh.position(mesh.tail(h)), loops: 1, ends: 0 });
            }
            walk.push(h);
            h = h.next();
            while let Some(twin) = mesh.twin(h).filter(|t| rounding.of[t.face()] == 2) {
                h = twin.next();
            }
        }
        all.push(walk);
    }
    Ok(all)
}
