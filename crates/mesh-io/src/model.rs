//! What a mesh file holds: triangles, and the attributes that formats attach to them.

use crate::error::At;
use crate::unit::Unit;
use glam::DVec3;
use mesh_core::{CornerMap, FaceId, FaceMap, Faces, HalfedgeId, TriMesh, VertexId};
use std::path::PathBuf;
use std::sync::Arc;

/// The contents of a mesh file. Everything beyond `mesh` is optional and typed by what it belongs to.
///
/// Attributes live on corners, so that seams, per-face colours and hard edges fit one representation. A corner that
/// the file gives no value holds NaN.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Positions and triangles, in file order.
    pub mesh: TriMesh,
    /// Texture coordinates, origin at the lower left.
    pub uvs: Option<CornerMap<[f64; 2]>>,
    /// Normals as the file gives them; not normalised.
    pub normals: Option<CornerMap<DVec3>>,
    /// Red, green, blue, alpha in 0–1. Colours of vertices repeat at every corner there, colours of faces at all three.
    pub colors: Option<CornerMap<[f64; 4]>>,
    /// Named parts (OBJ `g` and `o`, STL solids, glTF nodes, 3MF objects).
    pub groups: Option<Groups>,
    /// Surface looks.
    pub materials: Option<Materials>,
    /// The file's polygons, where any has more than three corners.
    pub polygons: Option<Polygons>,
    /// The unit of the coordinates, where the file names one: 3MF does. Written to 3MF alone.
    pub unit: Option<Unit>,
    /// What the reader changed or passed over.
    pub notes: Vec<Note>,
}

/// A name for every face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Groups {
    /// Index into `names` for each face.
    pub of_face: FaceMap<u32>,
    /// Names in order of first appearance. The empty name stands for faces outside any group.
    pub names: Vec<String>,
}

/// A look for every face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    /// Index into `list` for each face.
    pub of_face: FaceMap<u32>,
    /// Materials in order of first appearance. One with an empty name stands for faces without material.
    pub list: Vec<Material>,
}

/// A surface look, as far as all formats agree on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The file's name for it.
    pub name: String,
    /// Red, green, blue, alpha in 0–1.
    pub base_color: [f64; 4],
    /// 0 for dielectric, 1 for metal.
    pub metallic: f64,
    /// 0 for mirror-like, 1 for matt.
    pub roughness: f64,
    /// Picture that multiplies the base colour, placed by [`Model::uvs`].
    pub texture: Option<Texture>,
}

impl Default for Material {
    fn default() -> Self {
        Self { name: String::new(), base_color: [1.0; 4], metallic: 0.0, roughness: 1.0, texture: None }
    }
}

/// A picture that a material refers to. Its pixels are never decoded here.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// File name as the mesh file gives it, or a made-up one for embedded pictures.
    pub name: String,
    /// Where its bytes are.
    pub source: TextureSource,
}

/// Where a picture's bytes are.
#[derive(Clone, Debug, PartialEq)]
pub enum TextureSource {
    /// In this file, which lies in the mesh file's folder.
    File(PathBuf),
    /// In memory.
    Embedded(Arc<[u8]>),
    /// Unknown: the file is missing, outside the mesh's folder, or the mesh came from a stream.
    Missing,
}

/// The polygons that triangles were cut from. Triangles of one polygon are neighbours in face order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    /// Where each polygon's corners start in `corners`; one more entry than polygons.
    pub starts: Vec<u32>,
    /// Corners of all polygons, counter-clockwise seen from outside.
    pub corners: Vec<VertexId>,
    /// The polygon of each triangle; never decreasing.
    pub of_face: FaceMap<u32>,
}

impl Polygons {
    /// How many polygons.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The corners of one polygon.
    pub fn corners(&self, polygon: usize) -> &[VertexId] {
        &self.corners[self.starts[polygon] as usize..self.starts[polygon + 1] as usize]
    }

    /// Whether these polygons still describe the faces of `mesh`: writers emit triangles where not.
    /// O(n log n) in the size of the largest polygon.
    pub fn fit(&self, mesh: &TriMesh) -> bool {
        let sane = self.of_face.len() == mesh.face_count()
            && self.starts.first() == Some(&0)
            && self.starts.windows(2).all(|w| w[0] <= w[1])
            && self.starts.last().is_some_and(|&end| end as usize == self.corners.len())
            && self.of_face.as_slice().windows(2).all(|w| w[0] <= w[1])
            && self.of_face.as_slice().last().is_none_or(|&p| (p as usize) < self.len());
        let mut sorted = vec![];
        let mut face = 0;
        sane && self.of_face.as_slice().chunk_by(|a, b| a == b).all(|group| {
            sorted.clear();
            sorted.extend_from_slice(self.corners(group[0] as usize));
            sorted.sort_unstable();
            let triangles = &mesh.faces[face..face + group.len()];
            face += group.len();
            triangles.iter().flatten().all(|v| sorted.binary_search(v).is_ok())
        })
    }
}

/// Something a reader or writer did that the user may want to know.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// What it did, to things in the plural: `"polygons split into triangles"`.
    pub what: String,
    /// To how many.
    pub count: u64,
    /// Where in the file first.
    pub first: Option<At>,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.what, self.count)?;
        self.first.map_or(Ok(()), |at| write!(f, " (first at {at})"))
    }
}

impl From<TriMesh> for Model {
    fn from(mesh: TriMesh) -> Self {
        Self { mesh, ..Self::default() }
    }
}

impl Model {
    /// Keeps the faces for which `keep` says so, with their attributes. Polygons are given up if any face goes.
    pub fn retain_faces(&mut self, keep: impl Fn(FaceId) -> bool) {
        let kept: Vec<FaceId> = self.mesh.face_ids().filter(|&f| keep(f)).collect();
        if kept.len() == self.mesh.face_count() {
            return;
        }
        let faces = kept.iter().map(|&f| self.mesh.corners(f)).collect();
        self.mesh.faces = faces;
        self.uvs = self.uvs.take().map(|m| pick_corners(&m, &kept));
        self.normals = self.normals.take().map(|m| pick_corners(&m, &kept));
        self.colors = self.colors.take().map(|m| pick_corners(&m, &kept));
        if let Some(groups) = &mut self.groups {
            groups.of_face = pick_faces(&groups.of_face, &kept);
        }
        if let Some(materials) = &mut self.materials {
            materials.of_face = pick_faces(&materials.of_face, &kept);
        }
        self.polygons = None;
    }

    /// Drops faces that use a vertex twice and returns how many there were.
    pub(crate) fn drop_degenerate_faces(&mut self) -> usize {
        let before = self.mesh.faces.len();
        let flat: Vec<bool> = self.mesh.faces.iter().map(|&[a, b, c]| a == b || b == c || c == a).collect();
        self.retain_faces(|f| !flat[f.index()]);
        before - self.mesh.faces.len()
    }

    /// Whether every attribute has one value per element of the mesh and every id is in range.
    pub(crate) fn is_consistent(&self) -> bool {
        let (vertices, faces) = (self.mesh.vertex_count(), self.mesh.face_count());
        let labels = |of_face: &FaceMap<u32>, names: usize| {
            of_face.len() == faces && of_face.as_slice().iter().all(|&i| (i as usize) < names)
        };
        self.mesh.faces.iter().flatten().all(|v| v.index() < vertices)
            && self.uvs.as_ref().is_none_or(|m| m.len() == 3 * faces)
            && self.normals.as_ref().is_none_or(|m| m.len() == 3 * faces)
            && self.colors.as_ref().is_none_or(|m| m.len() == 3 * faces)
            && self.groups.as_ref().is_none_or(|g| labels(&g.of_face, g.names.len()))
            && self.materials.as_ref().is_none_or(|m| labels(&m.of_face, m.list.len()))
    }
}

fn pick_corners<T: Copy>(map: &CornerMap<T>, kept: &[FaceId]) -> CornerMap<T> {
    kept.iter().flat_map(|&f| (0..3).map(move |k| map[HalfedgeId::new(f, k)])).collect::<Vec<_>>().into()
}

fn pick_faces(map: &FaceMap<u32>, kept: &[FaceId]) -> FaceMap<u32> {
    kept.iter().map(|&f| map[f]).collect::<Vec<_>>().into()
}
