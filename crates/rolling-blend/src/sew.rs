//! What lies between the linkages is removed and the strips are put in its place.

use crate::linkage::Opened;
use crate::strip::Piece;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, FaceOrigin, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId,
    VertexOrigin,
};
use spine::BlendCurve;
use tri_intersect::embed::flood;

/// The stage that new vertices and faces are marked with.
pub(crate) const STAGE: &str = "blend";

/// Finds the faces between the linkages of the cut mesh: all that is reached from the blend curves without crossing a
/// linkage. Each linkage must come out with the removed side towards its rail and the kept side away from it.
pub(crate) fn between(
    mesh: &Connected<TriMesh>,
    cut: &Connected<&TriMesh>,
    opened: &Opened,
    curves: &[BlendCurve],
) -> Result<FaceMap<bool>, Trouble> {
    let walls = opened.loops.iter().flat_map(|c| c.windows(2).map(|w| [w[0], w[1]]));
    let mut seeds = Vec::new();
    for curve in curves {
        let whole = curve.halfedges.iter().find_map(|&h| cut.halfedge(mesh.tail(h), mesh.head(h)));
        let Some(h) = whole.or_else(|| longest_piece(mesh, cut, &opened.embedded.origins, curve)) else {
            let at = curve.halfedges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.tail(h)));
            return Err(Trouble::at("a linkage crosses the blend curve", vec![at]));
        };
        seeds.push(h.face());
    }
    let removed = flood(cut, walls, &seeds);
    let mut leaks = Vec::new();
    for w in opened.loops.iter().flat_map(|c| c.windows(2)) {
        // Every loop has what stays on its left.
        let gone = |a: VertexId, b: VertexId| cut.halfedge(a, b).map(|h| removed[h.face()]);
        if gone(w[0], w[1]) != Some(false) || gone(w[1], w[0]) != Some(true) {
            leaks.push(cut.position(w[0]));
        }
    }
    if leaks.is_empty() { Ok(removed) } else { Err(Trouble::at("the linkages do not enclose the blend curve", leaks)) }
}

/// The longest piece of a curve each of whose edges is cut: one that runs out at both ends has little of it beyond.
fn longest_piece(
    mesh: &Connected<TriMesh>,
    cut: &Connected<&TriMesh>,
    origins: &Origins,
    curve: &BlendCurve,
) -> Option<HalfedgeId> {
    let pieces = curve.halfedges.iter().flat_map(|&h| {
        let edge = [mesh.tail(h), mesh.head(h)];
        let on_edge = |v: &VertexId| matches!(origins.vertices[*v], VertexOrigin::Edge { ends, .. } if ends == edge || ends == [edge[1], edge[0]]);
        let mut points: Vec<VertexId> = cut.vertex_ids().filter(on_edge).chain(edge).collect();
        let from = mesh.position(edge[0]);
        points.sort_by(|&a, &b| cut.position(a).distance(from).total_cmp(&cut.position(b).distance(from)));
        points.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>()
    });
    let length = |[a, b]: &[VertexId; 2]| cut.position(*a).distance(cut.position(*b));
    let [a, b] = pieces.max_by(|a, b| length(a).total_cmp(&length(b)))?;
    cut.halfedge(a, b)
}

/// The sewn mesh.
pub(crate) struct Sewn {
    pub mesh: TriMesh,
    /// With respect to the mesh that was blended, as part 0.
    pub origins: Origins,
    /// First face of the strips; they are the last ones.
    pub first_new_face: FaceId,
    /// For each vertex of the cut mesh, its id here if it is left.
    kept: Vec<VertexId>,
    /// How many of them are left.
    shift: u32,
}

impl Sewn {
    /// The id of a vertex of the cut mesh or of a piece.
    pub fn id(&self, v: VertexId) -> VertexId {
        renumbered(&self.kept, self.shift, v)
    }
}

fn renumbered(kept: &[VertexId], shift: u32, v: VertexId) -> VertexId {
    kept.get(v.index()).copied().unwrap_or_else(|| VertexId(v.0 - kept.len() as u32 + shift))
}

/// Drops the removed faces and the vertices that only they used, keeps the order of all others, appends the strips.
/// Strip vertex ids count from the cut mesh's vertex count, strip after strip.
pub(crate) fn sew(opened: &Opened, removed: &FaceMap<bool>, pieces: &[Piece]) -> Sewn {
    let (cut, origins) = (&opened.embedded.mesh, &opened.embedded.origins);
    let mut used = vec![true; cut.vertex_count()];
    let gone = || cut.face_ids().filter(|&f| removed[f]);
    for f in gone() {
        for v in cut.corners(f) {
            used[v.index()] = false;
        }
    }
    for f in cut.face_ids().filter(|&f| !removed[f]) {
        for v in cut.corners(f) {
            used[v.index()] = true;
        }
    }
    let mut new_id = vec![VertexId(u32::MAX); cut.vertex_count()];
    let inner: usize = pieces.iter().map(|s| s.points.len()).sum();
    let mut positions = Vec::with_capacity(cut.vertex_count() + inner);
    let mut vertex_origins = Vec::with_capacity(cut.vertex_count() + inner);
    for v in cut.vertex_ids().filter(|v| used[v.index()]) {
        new_id[v.index()] = VertexId::from(positions.len());
        positions.push(cut.position(v));
        vertex_origins.push(origins.vertices[v]);
    }
    let shift = positions.len() as u32;
    for piece in pieces {
        positions.extend_from_slice(&piece.points);
        vertex_origins.extend(std::iter::repeat_n(VertexOrigin::New { stage: STAGE }, piece.points.len()));
    }
    let renumber = |v: VertexId| renumbered(&new_id, shift, v);
    let (mut faces, mut face_origins) = (Vec::with_capacity(cut.face_count()), Vec::new());
    for f in cut.face_ids().filter(|&f| !removed[f]) {
        faces.push(cut.corners(f).map(renumber));
        face_origins.push(origins.faces[f]);
    }
    let first_new_face = FaceId::from(faces.len());
    for piece in pieces {
        faces.extend(piece.faces.iter().map(|&f| f.map(renumber)));
        face_origins.extend(std::iter::repeat_n(FaceOrigin::New { stage: STAGE }, piece.faces.len()));
    }
    Sewn {
        kept: new_id,
        shift,
        mesh: TriMesh { positions, faces },
        origins: Origins { vertices: vertex_origins.into(), faces: face_origins.into() },
        first_new_face,
    }
}
