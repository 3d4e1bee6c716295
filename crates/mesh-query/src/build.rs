//! The tree, its construction and the checks of its input.

use crate::frame::Frame;
use crate::order::{CHUNK, along_morton_curve, index_of, leaves};
use glam::DVec3;
use mesh_core::{Bounds, FaceId, Faces, Positions, VertexId};
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

/// A bounding-volume hierarchy over the triangles of a mesh.
///
/// It holds boxes and face ids only. Every query takes the mesh again and must be given the one the tree was built
/// from, unchanged; with another mesh a query may answer nonsense, or panic on an index that is not there.
#[derive(Clone, Debug)]
pub struct TriBvh {
    pub(crate) nodes: Vec<Bvh2Node>,
    /// Leaf by leaf: a leaf owns `first_index .. first_index + prim_count`.
    pub(crate) faces: Vec<FaceId>,
    pub(crate) frame: Frame,
    bounds: Bounds,
}

/// Why a tree cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A corner is not a point in space.
    #[error(
        "vertex {vertex} of face {face} is at {place}, which is not a finite point; remove or repair the vertex first"
    )]
    NotFinite {
        /// The lowest face that uses such a vertex.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
        /// Its coordinates.
        place: DVec3,
    },
    /// A face names a vertex beyond the vertex count.
    #[error("face {face} uses vertex {vertex}, but the mesh has only {count} vertices; repair its face list first")]
    MissingVertex {
        /// The face.
        face: FaceId,
        /// The vertex that is not there.
        vertex: VertexId,
        /// How many vertices there are.
        count: usize,
    },
    /// A subset names a face beyond the face count.
    #[error("the subset names face {face}, but the mesh has only {count} faces")]
    MissingFace {
        /// The face that is not there.
        face: FaceId,
        /// How many faces there are.
        count: usize,
    },
    /// Ids do not reach that far.
    #[error("{count} faces are more than a tree can hold ({max}); split the mesh", max = MAX_FACES)]
    TooManyFaces {
        /// How many were given.
        count: usize,
    },
}

/// Node ids are `u32`, and there are twice as many nodes as faces.
const MAX_FACES: usize = (u32::MAX / 2) as usize;

impl TriBvh {
    /// A tree over all faces. O(n log n) time, about 100 bytes per face while it runs and 40 after.
    ///
    /// # Errors
    /// [`Error`], for the lowest face id at fault. An empty mesh is no error.
    pub fn build<M: Faces + Positions + Sync>(mesh: &M) -> Result<Self, Error> {
        Self::over(mesh, mesh.face_count(), |i| FaceId(i as u32))
    }

    /// A tree over some faces, such as one base patch; answers name them by their ids in `mesh`. A face listed twice is
    /// found once.
    ///
    /// # Errors
    /// [`Error`], for the first listed face at fault.
    pub fn build_subset<M: Faces + Positions + Sync>(mesh: &M, faces: &[FaceId]) -> Result<Self, Error> {
        let count = mesh.face_count();
        if let Some(&face) = faces.iter().find(|f| f.index() >= count) {
            return Err(Error::MissingFace { face, count });
        }
        if faces.is_sorted_by(|a, b| a < b) {
            return Self::over(mesh, faces.len(), |i| faces[i]);
        }
        let mut unique = faces.to_vec();
        unique.par_sort_unstable();
        unique.dedup();
        Self::over(mesh, unique.len(), |i| unique[i])
    }

    fn over<M: Faces + Positions + Sync>(
        mesh: &M,
        count: usize,
        face: impl Fn(usize) -> FaceId + Sync,
    ) -> Result<Self, Error> {
        if count > MAX_FACES {
            return Err(Error::TooManyFaces { count });
        }
        let bounds = bounds_of(mesh, count, &face)?;
        let frame = Frame::around(&bounds);
        let box_of = |f: FaceId| frame.box_of(mesh.triangle(f), f.0);
        let keys = along_morton_curve(count, |i| box_of(face(i)));
        let faces: Vec<FaceId> = keys.into_par_iter().with_min_len(CHUNK).map(|k| face(index_of(k))).collect();
        let leaves = leaves(count, |i| box_of(faces[i]));
        let mut tree = PlocBuilder::new().build(
            PlocSearchDistance::Minimum,
            &leaves,
            (0..leaves.len() as u32).collect(),
            SortPrecision::U64,
            0,
        );
        for node in tree.nodes.iter_mut().filter(|n| n.is_leaf()) {
            let leaf = &leaves[node.first_index as usize];
            (node.first_index, node.prim_count) = (leaf.first, leaf.count);
        }
        Ok(Self { nodes: tree.nodes, faces, frame, bounds })
    }

    /// The exact box around all triangles in the tree; empty when there are none.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// How many triangles are in the tree.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// The triangles of a leaf.
    #[inline]
    pub(crate) fn leaf(&self, node: &Bvh2Node) -> &[FaceId] {
        &self.faces[node.first_index as usize..][..node.prim_count as usize]
    }
}

/// The box around the faces, all of whose corners exist and are finite.
fn bounds_of<M: Faces + Positions + Sync>(
    mesh: &M,
    count: usize,
    face: &(impl Fn(usize) -> FaceId + Sync),
) -> Result<Bounds, Error> {
    let vertices = mesh.vertex_count();
    let boxes: Vec<Result<Bounds, Error>> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let mut bounds = Bounds::EMPTY;
            for i in chunk * CHUNK..count.min((chunk + 1) * CHUNK) {
                let f = face(i);
                for v in mesh.corners(f) {
                    if v.index() >= vertices {
                        return Err(Error::MissingVertex { face: f, vertex: v, count: vertices });
                    }
                    let p = mesh.position(v);
                    if !p.is_finite() {
                        return Err(Error::NotFinite { face: f, vertex: v, place: p });
                    }
                    bounds = Bounds { min: bounds.min.min(p), max: bounds.max.max(p) };
                }
            }
            Ok(bounds)
        })
        .collect();
    boxes.into_iter().try_fold(Bounds::EMPTY, |all, b| Ok(all.union(b?)))
}
