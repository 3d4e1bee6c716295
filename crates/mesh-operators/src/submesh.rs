//! Some faces of a mesh as a mesh, with maps back.

use mesh_core::{FaceId, Faces, Positions, TriMesh, VertexId};

/// Some faces of a mesh and the vertices they use, renumbered in the same order.
///
/// ```
/// use mesh_core::{FaceId, VertexId, shapes};
/// let cube = shapes::cuboid(glam::DVec3::ONE);
/// let part = mesh_operators::Submesh::new(&cube, |f: FaceId| f.0 < 2);
/// assert_eq!((part.mesh.faces.len(), part.mesh.positions.len()), (2, 4));
/// let back = part.mesh.faces[1].map(|v| part.vertices[v.index()]);
/// assert_eq!(back, cube.faces[1]);
/// assert_eq!(part.local(back[2]), Some(part.mesh.faces[1][2]));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Submesh {
    /// The faces, their corners and order kept. It need not be a manifold where that of the mesh is: pieces may touch at a vertex.
    pub mesh: TriMesh,
    /// The id of each vertex in the mesh, ascending.
    pub vertices: Vec<VertexId>,
    /// The id of each face in the mesh, ascending.
    pub faces: Vec<FaceId>,
}

impl Submesh {
    /// The faces that `taken` says; positions keep their bits. O(n) in the size of the mesh.
    pub fn new<M: Faces + Positions>(mesh: &M, taken: impl Fn(FaceId) -> bool) -> Self {
        let faces: Vec<FaceId> = mesh.face_ids().filter(|&f| taken(f)).collect();
        let mut used = vec![false; mesh.vertex_count()];
        faces.iter().flat_map(|&f| mesh.corners(f)).for_each(|v| used[v.index()] = true);
        let vertices: Vec<VertexId> = mesh.vertex_ids().filter(|v| used[v.index()]).collect();
        let mut number = vec![VertexId(0); used.len()];
        (0..).zip(&vertices).for_each(|(i, v)| number[v.index()] = VertexId(i));
        let corners = |&f: &FaceId| mesh.corners(f).map(|v| number[v.index()]);
        let own = TriMesh {
            positions: vertices.iter().map(|&v| mesh.position(v)).collect(),
            faces: faces.iter().map(corners).collect(),
        };
        Self { mesh: own, vertices, faces }
    }

    /// The id here of a vertex of the mesh; `None` where no face taken uses it. O(log n).
    pub fn local(&self, v: VertexId) -> Option<VertexId> {
        self.vertices.binary_search(&v).ok().map(VertexId::from)
    }
}
