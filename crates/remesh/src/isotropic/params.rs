//! What is wanted of a remeshed surface.

use glam::DVec3;
use mesh_core::{FaceMap, TriMesh, VertexMap};

/// How a surface is remeshed.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Wanted edge length, in model units. Positive and finite. [`Sizing`] may vary it.
    pub edge_length: f64,
    /// Rounds of split, collapse, flip, relax and project.
    pub rounds: usize,
    /// Least angle in degrees between the normals of an edge's two faces that makes it a feature, kept as part of a
    /// polyline; 180 keeps none.
    pub feature_angle: f64,
    /// Feature polylines with a loose end and shorter than this many edge lengths are noise and are not kept.
    pub shortest_feature: f64,
    /// Steps of tangential relaxation in each round.
    pub relaxations: usize,
    /// Share of the way to the weighted mean of the neighbours that each step goes, in (0, 1].
    pub lambda: f64,
    /// Most triangles the result may have.
    pub max_faces: usize,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            edge_length: 1.0,
            rounds: 5,
            feature_angle: 40.0,
            shortest_feature: 4.0,
            relaxations: 6,
            lambda: 0.7,
            max_faces: 1 << 28,
        }
    }
}

impl Params {
    /// The defaults with another edge length.
    pub fn new(edge_length: f64) -> Self {
        Self { edge_length, ..Self::default() }
    }
}

/// What must stay bit for bit. The boundary always does. Empty lists freeze nothing.
#[derive(Clone, Debug, Default)]
pub struct Frozen {
    /// Faces that stay whole, with their corners.
    pub faces: FaceMap<bool>,
    /// Vertices that stay where they are; edges between them may still be split or flipped.
    pub vertices: VertexMap<bool>,
}

/// How the wanted edge length varies.
#[derive(Clone, Copy, Default)]
pub enum Sizing<'a> {
    /// [`Params::edge_length`] everywhere.
    #[default]
    Uniform,
    /// One length per vertex of the input, linear between; [`crate::graded_sizes`] makes such.
    PerVertex(&'a VertexMap<f64>),
    /// A length at every place.
    Field(&'a (dyn Fn(DVec3) -> f64 + Sync)),
}

/// Where vertices go after they have been moved along the surface.
#[derive(Clone, Copy, Default)]
pub enum Projection<'a> {
    /// Back onto the input.
    #[default]
    Input,
    /// Wherever the closure takes them, all at once: onto the zero set of a field, say. Points it leaves or makes
    /// non-finite stay where they were.
    Field(&'a (dyn Fn(&mut [DVec3]) + Sync)),
    /// Nowhere; relaxation alone is tangential.
    Off,
}

/// A remeshed surface.
#[derive(Clone, Debug)]
pub struct Remeshed {
    /// The surface. Vertices of the input that are left come first, in order; so do frozen faces among themselves.
    pub mesh: TriMesh,
    /// Where everything comes from, the input being part 0. A vertex put back onto the input names its place there.
    pub origins: mesh_core::Origins,
    /// For each vertex the id by which an [`mesh_core::EditObserver`] knew it: that of the input, or in the order of splits.
    pub edit_ids: VertexMap<mesh_core::VertexId>,
}
