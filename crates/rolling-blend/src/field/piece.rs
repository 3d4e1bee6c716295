//! What lies between the linkages as a mesh of its own, to be reshaped and put back.

use crate::strip::Piece;
use crate::trouble::Trouble;
use mesh_core::{
    Adjacency, Connected, FaceMap, Faces, HalfedgeId, TriMesh, VertexId, Watch, boundary_loops, components,
};
use remesh::{Frozen, Projection, Sizing, graded_sizes};
use std::collections::BTreeSet;

/// Some faces of a mesh by themselves.
pub(crate) struct CutOut {
    /// The faces; the first vertices are those on the boundary.
    pub mesh: TriMesh,
    /// For each boundary vertex its id in the whole.
    pub rim: Vec<VertexId>,
}

/// The chosen faces; `rims` are the chains of vertices that bound them.
pub(crate) fn cut_out(whole: &TriMesh, chosen: &FaceMap<bool>, rims: &[Vec<VertexId>]) -> CutOut {
    let mut new = vec![u32::MAX; whole.vertex_count()];
    let mut mesh = TriMesh::default();
    let mut add = |v: VertexId, positions: &mut Vec<glam::DVec3>| {
        if new[v.index()] == u32::MAX {
            new[v.index()] = positions.len() as u32;
            positions.push(whole.positions[v.index()]);
        }
        VertexId(new[v.index()])
    };
    let rim: Vec<VertexId> = rims.concat();
    for &v in &rim {
        add(v, &mut mesh.positions);
    }
    for f in whole.face_ids().filter(|&f| chosen[f]) {
        mesh.faces.push(whole.corners(f).map(|v| add(v, &mut mesh.positions)));
    }
    CutOut { mesh, rim }
}

impl CutOut {
    /// Its connected pieces, in the order of their first faces.
    pub fn pieces(&self) -> Vec<Self> {
        let all = components(&self.mesh);
        let mut own = vec![u32::MAX; self.mesh.positions.len()];
        let mut pieces: Vec<Self> =
            all.face_counts.iter().map(|_| Self { mesh: TriMesh::default(), rim: vec![] }).collect();
        let mut label_of = vec![u32::MAX; own.len()];
        for (f, &label) in self.mesh.faces.iter().zip(all.labels.as_slice()) {
            for v in f {
                label_of[v.index()] = label;
            }
        }
        // Vertices in order, so that those of the boundary come first again.
        for (v, &label) in label_of.iter().enumerate().filter(|l| *l.1 != u32::MAX) {
            let piece = &mut pieces[label as usize];
            own[v] = piece.mesh.positions.len() as u32;
            piece.mesh.positions.push(self.mesh.positions[v]);
            piece.rim.extend(self.rim.get(v));
        }
        for (f, &label) in self.mesh.faces.iter().zip(all.labels.as_slice()) {
            pieces[label as usize].mesh.faces.push(f.map(|v| VertexId(own[v.index()])));
        }
        pieces
    }
}

/// The reshaped piece in the numbers that sewing expects: those of the whole on the boundary, from `first_new` on within.
pub(crate) fn put_back(rim: &[VertexId], made: &TriMesh, first_new: u32) -> Piece {
    let m = rim.len() as u32;
    let id = |v: VertexId| if v.0 < m { rim[v.index()] } else { VertexId(first_new + v.0 - m) };
    Piece { faces: made.faces.iter().map(|f| f.map(id)).collect(), points: made.positions[rim.len()..].to_vec() }
}

/// The edges of the kept faces between boundary vertices of the piece, in the piece's numbers, low first.
pub(crate) fn kept_chords(
    whole: &Connected<&TriMesh>,
    removed: &FaceMap<bool>,
    rim: &[VertexId],
) -> BTreeSet<[VertexId; 2]> {
    let mut own = vec![u32::MAX; whole.vertex_count()];
    for (i, v) in rim.iter().enumerate() {
        own[v.index()] = i as u32;
    }
    let kept = |h: HalfedgeId| !removed[h.face()];
    let inner = |h: &HalfedgeId| kept(*h) && whole.twin(*h).is_some_and(kept);
    rim.iter()
        .flat_map(|&v| whole.ring(v).filter(inner).map(move |h| [v, whole.head(h)]))
        .map(|e| e.map(|v| own[v.index()]))
        .filter(|e| e[1] != u32::MAX && e[0] < e[1])
        .map(|e| e.map(VertexId))
        .collect()
}

/// Splits inner edges that join two of the first `rim` vertices, where they are longer than `long`, since a strip one
/// triangle wide has no vertex to bend at, or where the rest of the mesh has such an edge too.
pub(crate) fn split_chords(mesh: &mut TriMesh, rim: usize, taken: &BTreeSet<[VertexId; 2]>, long: f64) {
    let edge = |a: VertexId, b: VertexId| [a.min(b), a.max(b)];
    let Ok(connected) = Connected::new(&*mesh) else { return };
    let bounding: BTreeSet<[VertexId; 2]> =
        boundary_loops(&connected).concat().iter().map(|&h| edge(connected.tail(h), connected.head(h))).collect();
    let is_chord = |a: VertexId, b: VertexId| {
        a.index() < rim
            && b.index() < rim
            && !bounding.contains(&edge(a, b))
            && (taken.contains(&edge(a, b)) || mesh.positions[a.index()].distance(mesh.positions[b.index()]) > long)
    };
    let chords: BTreeSet<[VertexId; 2]> = mesh
        .faces
        .iter()
        .flat_map(|f| (0..3).map(|k| (f[k], f[(k + 1) % 3])))
        .filter(|&(a, b)| is_chord(a, b))
        .map(|(a, b)| edge(a, b))
        .collect();
    let is_chord = |a: VertexId, b: VertexId| chords.contains(&edge(a, b));
    let mut middles = std::collections::BTreeMap::new();
    let mut faces = Vec::with_capacity(mesh.faces.len());
    let (old, mut positions) = (std::mem::take(&mut mesh.faces), std::mem::take(&mut mesh.positions));
    for face in old {
        let middle = [0, 1, 2].map(|k| {
            let (a, b) = (face[k], face[(k + 1) % 3]);
            is_chord(a, b).then(|| {
                *middles.entry(edge(a, b)).or_insert_with(|| {
                    positions.push(positions[a.index()].midpoint(positions[b.index()]));
                    VertexId::from(positions.len() - 1)
                })
            })
        });
        // Corners and middles in order around the face.
        let around: Vec<VertexId> = (0..3).flat_map(|k| std::iter::once(face[k]).chain(middle[k])).collect();
        match (around.len(), middle) {
            (3, _) => faces.push(face),
            (6, [Some(x), Some(y), Some(z)]) => {
                faces.extend([[face[0], x, z], [x, face[1], y], [z, y, face[2]], [x, y, z]]);
            }
            _ => {
                // Begin the fan at a middle: at a corner it could be flat.
                let first = around.iter().position(|v| !face.contains(v)).unwrap_or(0);
                let n = around.len();
                let at = |k: usize| around[(first + k) % n];
                faces.extend((1..n - 1).map(|k| [at(0), at(k), at(k + 1)]));
            }
        }
    }
    mesh.faces = faces;
    mesh.positions = positions;
}

/// How evenly a piece is remeshed.
#[derive(Clone, Copy)]
pub(crate) struct Evenness {
    /// Rounds of remeshing.
    pub rounds: usize,
    /// Change of edge length with distance from the rim.
    pub slope: f64,
    /// Least share of the edge length that is wanted beside short edges of the rim: where it passes close by vertices, small
    /// triangles would crumple.
    pub finest: f64,
}

/// Remeshes a piece with edges about `edge` long; its rim stays.
pub(crate) fn even_out(mesh: TriMesh, edge: f64, how: Evenness, watch: &Watch) -> Result<TriMesh, Trouble> {
    let at = mesh.positions.first().copied();
    let failed = |_| Trouble::at("the blend cannot be tessellated", at.into_iter().collect());
    let connected =
        Connected::new(mesh).map_err(|e| Trouble::at("the contact curves touch", e.place.into_iter().collect()))?;
    let mut sizes = graded_sizes(&connected, edge, how.slope).map_err(failed)?;
    sizes.as_mut_slice().iter_mut().for_each(|s| *s = s.max(how.finest * edge));
    let params = remesh::Params { feature_angle: 180.0, rounds: how.rounds, ..remesh::Params::new(edge) };
    match remesh::remesh(&connected, &Frozen::default(), Sizing::PerVertex(&sizes), &params, Projection::Input, watch) {
        Ok(made) => Ok(made.mesh),
        Err(remesh::Error::Cancelled(c)) => Err(Trouble::Cancelled(c)),
        Err(e) => Err(failed(e)),
    }
}
