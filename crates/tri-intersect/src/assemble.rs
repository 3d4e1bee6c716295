//! Puts kept faces and pieces together, with origins.

use crate::arrange::{Arrangement, Part, Simplex};
use crate::classify::CUT;
use crate::cut::{Class, Pieces, Snaps};
use crate::options::Operation;
use mesh_core::{Adjacency, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, TriMesh, VertexId, VertexOrigin};
use rayon::prelude::*;

const NONE: u32 = u32::MAX;
/// Faces handed to one task.
const CHUNK: usize = 1 << 14;

/// The result before its contacts are split.
#[derive(Clone)]
pub(crate) struct Assembly {
    pub mesh: TriMesh,
    pub origins: Origins,
    /// Kept uncut faces of a and of b, in order; they are the first faces of `mesh`.
    pub whole: [Vec<u32>; 2],
    /// Where pieces of a, then of b, begin and end in the faces of `mesh`.
    pub pieces: [usize; 3],
    /// The part of each face after those.
    pub extra: Vec<u8>,
    /// Result vertex of each node.
    pub vertices: Vec<u32>,
    /// Node of each result vertex.
    pub nodes: Vec<u32>,
}

impl Assembly {
    /// Whether a face of the result is of part b.
    pub(crate) fn is_of_b(&self, face: u32) -> bool {
        let f = face as usize;
        match f.checked_sub(self.pieces[2]) {
            Some(extra) => self.extra[extra] == 1,
            None => (f >= self.whole[0].len() && f < self.pieces[0]) || f >= self.pieces[1],
        }
    }

    /// Whether any piece of a face is left.
    pub(crate) fn pieces_of_face(&self, which: usize, face: u32) -> bool {
        let of = |o: &FaceOrigin| match *o {
            FaceOrigin::Input { part, face: f } | FaceOrigin::Piece { part, face: f } => {
                (part, f) == (which as u32, FaceId(face))
            }
            FaceOrigin::New { .. } => false,
        };
        self.origins.faces.as_slice()[self.pieces[which]..self.pieces[which + 1]].iter().any(of)
    }

    /// The pieces of one part.
    pub(crate) fn pieces_of(&self, which: usize) -> Vec<[VertexId; 3]> {
        let mut faces = self.mesh.faces[self.pieces[which]..self.pieces[which + 1]].to_vec();
        let extra = self.extra.iter().zip(&self.mesh.faces[self.pieces[2]..]);
        faces.extend(extra.filter(|(w, _)| usize::from(**w) == which).map(|(_, f)| *f));
        faces
    }
}

/// Whether faces of a class stay, and whether they are turned round.
pub(crate) fn keep(operation: Operation, which: usize, class: Class) -> Option<bool> {
    match (operation, which, class) {
        (Operation::Union, _, Class::Outside)
        | (Operation::Union | Operation::Intersection, 0, Class::Same)
        | (Operation::Intersection, _, Class::Inside)
        | (Operation::Difference, 0, Class::Outside | Class::Opposite) => Some(false),
        (Operation::Difference, 1, Class::Inside) => Some(true),
        _ => None,
    }
}

/// Gathers what an operation keeps.
pub(crate) fn assemble(
    parts: &[Part; 2],
    arrangement: &Arrangement,
    snaps: &Snaps,
    pieces: &[Pieces; 2],
    classes: &[Vec<u8>; 2],
    operation: Operation,
) -> Assembly {
    let class_of = [Class::Unknown, Class::Outside, Class::Inside];
    let keeps = [0, 1].map(|w| class_of.map(|c| keep(operation, w, c)));
    let whole = [0, 1].map(|w| {
        let kept = |c: u8| c != CUT && keeps[w][usize::from(c)].is_some();
        let chunk = |(i, classes): (usize, &[u8])| {
            let faces = (i * CHUNK) as u32..;
            classes.iter().zip(faces).filter(|(c, _)| kept(**c)).map(|(_, f)| f).collect::<Vec<u32>>()
        };
        classes[w].par_chunks(CHUNK).enumerate().map(chunk).collect::<Vec<_>>().concat()
    });
    let [na, nb] = arrangement.counts;
    let node_of_b: Vec<u32> =
        if arrangement.twins.is_empty() { vec![] } else { (0..nb).map(|v| arrangement.node(1, VertexId(v))).collect() };
    let node = |w: usize, v: VertexId| match w {
        0 => v.0,
        _ if node_of_b.is_empty() => na + v.0,
        _ => node_of_b[v.index()],
    };
    let kept_pieces = [0, 1].map(|w| {
        let ids = 0..pieces[w].triangles.len();
        ids.filter_map(|i| keep(operation, w, pieces[w].classes[i]).map(|flip| (i, flip))).collect::<Vec<_>>()
    });

    let mut vertices = vec![NONE; (na + nb) as usize + arrangement.places.len()];
    let (of_a, rest) = vertices.split_at_mut(na as usize);
    let mark = |w: usize, own: &mut [u32]| {
        whole[w].iter().flat_map(|&f| parts[w].mesh.corners(FaceId(f))).for_each(|v| own[v.index()] = 0);
    };
    rayon::join(|| mark(0, of_a), || mark(1, &mut rest[..nb as usize]));
    for &(v, twin) in &arrangement.twins {
        if std::mem::replace(&mut vertices[(na + v) as usize], NONE) == 0 {
            vertices[twin as usize] = 0;
        }
    }
    for w in 0..2 {
        for &(i, _) in &kept_pieces[w] {
            pieces[w].triangles[i].iter().for_each(|&n| vertices[n as usize] = 0);
        }
    }
    let mut nodes = Vec::with_capacity(vertices.len());
    for (n, v) in vertices.iter_mut().enumerate() {
        if *v == 0 {
            *v = nodes.len() as u32;
            nodes.push(n as u32);
        }
    }

    let positions = nodes.par_iter().map(|&n| arrangement.position(parts, n)).collect();
    let vertex_origins: Vec<VertexOrigin> = nodes.par_iter().map(|&n| origin(parts, arrangement, n)).collect();
    let total = whole[0].len() + whole[1].len() + kept_pieces[0].len() + kept_pieces[1].len();
    let mut faces = Vec::with_capacity(total);
    let mut face_origins = Vec::with_capacity(total);
    let turned = |[x, y, z]: [VertexId; 3], flip: bool| if flip { [x, z, y] } else { [x, y, z] };
    for w in 0..2 {
        let flip = keeps[w][Class::Outside as usize].or(keeps[w][Class::Inside as usize]).unwrap_or(false);
        let corners =
            |&f: &u32| turned(parts[w].mesh.corners(FaceId(f)).map(|v| VertexId(vertices[node(w, v) as usize])), flip);
        faces.par_extend(whole[w].par_iter().map(corners));
        let part = w as u32;
        face_origins.par_extend(whole[w].par_iter().map(|&f| FaceOrigin::Input { part, face: FaceId(f) }));
    }
    let mut bounds = [faces.len(); 3];
    for w in 0..2 {
        for &(i, flip) in &kept_pieces[w] {
            let (t, face) = (pieces[w].triangles[i], FaceId(pieces[w].parents[i]));
            faces.push(turned(t.map(|n| VertexId(vertices[n as usize])), flip));
            let part = w as u32;
            let corners = parts[w].mesh.corners(face).map(|v| snaps.find(node(w, v)));
            let same = (0..3).any(|k| t == [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]]);
            face_origins.push(if same { FaceOrigin::Input { part, face } } else { FaceOrigin::Piece { part, face } });
        }
        bounds[w + 1] = faces.len();
    }
    Assembly {
        mesh: TriMesh { positions, faces },
        origins: Origins { vertices: vertex_origins.into(), faces: face_origins.into() },
        whole,
        pieces: bounds,
        extra: vec![],
        vertices,
        nodes,
    }
}

fn origin(parts: &[Part; 2], arrangement: &Arrangement, node: u32) -> VertexOrigin {
    let [na, nb] = arrangement.counts;
    if node < na {
        return VertexOrigin::Input { part: 0, vertex: VertexId(node) };
    }
    if node < na + nb {
        return VertexOrigin::Input { part: 1, vertex: VertexId(node - na) };
    }
    let i = (node - na - nb) as usize;
    let (part, edge) = match arrangement.keys[i] {
        [Simplex::Edge(e), _] => (0, e),
        [_, Simplex::Edge(e)] => (1, e),
        _ => return VertexOrigin::New { stage: "boolean" },
    };
    let (mesh, h) = (parts[part].mesh, HalfedgeId(edge));
    debug_assert!(mesh.edge(h).0 == edge);
    VertexOrigin::Edge { part: part as u32, ends: [mesh.tail(h), mesh.head(h)], t: arrangement.parameters[i] }
}
