//! One operation over many parts, with origins and seams carried through.

use crate::boolean::{Boolean, Report, boolean};
use crate::curves::barycentric;
use crate::error::Error;
use crate::options::{Operation, Params};
use crate::seam::Seam;
use crate::seam::chain;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, TriMesh, VertexId, VertexOrigin, Watch,
};

/// The union of any number of solids; see [`boolean_all`].
///
/// # Errors
/// As [`boolean_all`].
pub fn union_all(parts: &[&Connected<TriMesh>], params: &Params, watch: &Watch) -> Result<Boolean, Error> {
    boolean_all(parts, Operation::Union, params, watch)
}

/// Folds an operation over parts from the left: a ∪ b ∪ c, (a − b) − c, a ∩ b ∩ c. Origins and errors number the parts
/// as listed (an error in a result so far names part 0); every seam has its lower-numbered part on the left. A seam that
/// a later part covers in places comes out as open chains.
///
/// # Errors
/// As [`boolean`]; [`Error::Empty`] if no parts are given.
pub fn boolean_all(
    parts: &[&Connected<TriMesh>],
    operation: Operation,
    params: &Params,
    watch: &Watch,
) -> Result<Boolean, Error> {
    let Some((&first, rest)) = parts.split_first() else { return Err(Error::Empty("no parts are given")) };
    let mut so_far = Boolean {
        mesh: first.mesh().clone(),
        origins: Origins::identity(0, first.vertex_count(), first.face_count()),
        seams: vec![],
        report: Report::default(),
    };
    for (i, next) in rest.iter().enumerate() {
        let number = i as u32 + 1;
        let before = connect(std::mem::take(&mut so_far.mesh), parts)?;
        let step = boolean(&before, next, operation, params, watch).map_err(|e| e.renumbered(number))?;
        let mut seams = surviving(&so_far.seams, &step);
        seams.extend(step.seams);
        let mut report = so_far.report;
        report.append(step.report);
        so_far = Boolean {
            origins: compose(parts, &before, &so_far.origins, &step.origins, &step.mesh, number),
            mesh: step.mesh,
            seams,
            report,
        };
    }
    Ok(so_far)
}

fn connect(mesh: TriMesh, parts: &[&Connected<TriMesh>]) -> Result<Connected<TriMesh>, Error> {
    Connected::new(mesh).map_err(|e| Error::Contact { at: e.place.unwrap_or(parts[0].mesh().positions[0]) })
}

/// What is left of earlier seams on the result of a step.
fn surviving(seams: &[Seam], step: &Boolean) -> Vec<Seam> {
    if seams.is_empty() {
        return vec![];
    }
    let origins = step.origins.vertices.as_slice();
    // Vertices of the result by the vertex, or edge and parameter, of the mesh before.
    let mut vertices: Vec<(VertexId, VertexId)> = vec![];
    let mut within: Vec<([VertexId; 2], f64, VertexId)> = vec![];
    for (i, origin) in origins.iter().enumerate() {
        match *origin {
            VertexOrigin::Input { part: 0, vertex } => vertices.push((vertex, VertexId::from(i))),
            VertexOrigin::Edge { part: 0, ends: [u, v], t } if u < v => within.push(([u, v], t, VertexId::from(i))),
            VertexOrigin::Edge { part: 0, ends: [u, v], t } => within.push(([v, u], 1.0 - t, VertexId::from(i))),
            _ => {}
        }
    }
    vertices.sort_unstable();
    within.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)).then(x.2.cmp(&y.2)));
    let copy = |v: VertexId| vertices.binary_search_by_key(&v, |x| x.0).ok().map(|i| vertices[i].1);

    let mut flagged = vec![false; origins.len()];
    let mut pieces: Vec<[VertexId; 2]> = vec![];
    for seam in seams {
        let ends = seam.vertices.len() - usize::from(!seam.closed);
        for i in 0..ends {
            let (u, v) = (seam.vertices[i], seam.vertices[(i + 1) % seam.vertices.len()]);
            let key = [u.min(v), u.max(v)];
            let start = within.partition_point(|x| x.0 < key);
            let mut stops: Vec<VertexId> = within[start..].iter().take_while(|x| x.0 == key).map(|x| x.2).collect();
            if u > v {
                stops.reverse();
            }
            let all: Vec<Option<VertexId>> =
                std::iter::once(copy(u)).chain(stops.into_iter().map(Some)).chain([copy(v)]).collect();
            pieces.extend(all.windows(2).filter_map(|w| Some([w[0]?, w[1]?])));
            all.into_iter().flatten().for_each(|x| flagged[x.index()] = true);
        }
    }
    let mut sides: Vec<[VertexId; 2]> = step
        .mesh
        .faces
        .iter()
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
        .filter(|s| flagged[s[0].index()] && flagged[s[1].index()])
        .collect();
    sides.sort_unstable();
    pieces.retain(|p| sides.binary_search(p).is_ok());
    pieces.sort_unstable();
    pieces.dedup();
    chain(&pieces)
}

/// Origins of a step (part 0: the mesh `before`, part 1: part `number`) in terms of the parts.
fn compose(
    parts: &[&Connected<TriMesh>],
    before: &Connected<TriMesh>,
    earlier: &Origins,
    step: &Origins,
    mesh: &TriMesh,
    number: u32,
) -> Origins {
    let vertex = |(i, origin): (usize, &VertexOrigin)| match *origin {
        VertexOrigin::Input { part: 0, vertex } => earlier.vertices[vertex],
        VertexOrigin::Input { vertex, .. } => VertexOrigin::Input { part: number, vertex },
        VertexOrigin::Edge { part: 0, ends, t } => {
            on_edge(earlier, ends, t).filter(|o| is_edge(parts, o)).unwrap_or_else(|| {
                let face = before.halfedge(ends[0], ends[1]).map(HalfedgeId::face);
                in_face(parts, earlier, face, mesh, VertexId::from(i))
            })
        }
        VertexOrigin::Edge { ends, t, .. } => VertexOrigin::Edge { part: number, ends, t },
        VertexOrigin::Face { part: 0, face, .. } => in_face(parts, earlier, Some(face), mesh, VertexId::from(i)),
        VertexOrigin::Face { face, barycentric, .. } => VertexOrigin::Face { part: number, face, barycentric },
        new @ VertexOrigin::New { .. } => new,
    };
    let face = |origin: &FaceOrigin| match *origin {
        FaceOrigin::Input { part: 0, face } => earlier.faces[face],
        FaceOrigin::Piece { part: 0, face } => match earlier.faces[face] {
            FaceOrigin::Input { part, face } => FaceOrigin::Piece { part, face },
            other => other,
        },
        FaceOrigin::Input { face, .. } => FaceOrigin::Input { part: number, face },
        FaceOrigin::Piece { face, .. } => FaceOrigin::Piece { part: number, face },
        new @ FaceOrigin::New { .. } => new,
    };
    Origins {
        vertices: step.vertices.as_slice().iter().enumerate().map(vertex).collect::<Vec<_>>().into(),
        faces: step.faces.as_slice().iter().map(face).collect::<Vec<_>>().into(),
    }
}

/// A point at `t` between two vertices, if both are on one edge of one part.
fn on_edge(earlier: &Origins, ends: [VertexId; 2], t: f64) -> Option<VertexOrigin> {
    use VertexOrigin::{Edge, Input};
    let parameter = |vertex: VertexId, ends: [VertexId; 2]| {
        ends.contains(&vertex).then_some(if vertex == ends[0] { 0.0 } else { 1.0 })
    };
    let (part, edge, s, e) = match ends.map(|v| earlier.vertices[v]) {
        [Input { part, vertex: u }, Input { part: q, vertex: v }] if part == q => (part, [u, v], 0.0, 1.0),
        [Edge { part, ends, t: s }, Edge { part: q, ends: other, t: e }] if part == q && ends == other => {
            (part, ends, s, e)
        }
        [Edge { part, ends, t: s }, Input { part: q, vertex }] if part == q => {
            (part, ends, s, parameter(vertex, ends)?)
        }
        [Input { part: q, vertex }, Edge { part, ends, t: e }] if part == q => {
            (part, ends, parameter(vertex, ends)?, e)
        }
        _ => return None,
    };
    Some(Edge { part, ends: edge, t: s + t * (e - s) })
}

fn is_edge(parts: &[&Connected<TriMesh>], origin: &VertexOrigin) -> bool {
    let VertexOrigin::Edge { part, ends: [u, v], .. } = *origin else { return false };
    let mesh = parts[part as usize];
    mesh.ring(u).any(|h| mesh.head(h) == v)
}

/// A point on a face of the mesh before, as a point of the face of a part from which that came.
fn in_face(
    parts: &[&Connected<TriMesh>],
    earlier: &Origins,
    face: Option<FaceId>,
    mesh: &TriMesh,
    vertex: VertexId,
) -> VertexOrigin {
    match face.map(|f| earlier.faces[f]) {
        Some(FaceOrigin::Input { part, face } | FaceOrigin::Piece { part, face }) => {
            let triangle = parts[part as usize].mesh().triangle(face);
            VertexOrigin::Face { part, face, barycentric: barycentric(&triangle, mesh.positions[vertex.index()]) }
        }
        _ => VertexOrigin::New { stage: "boolean" },
    }
}
