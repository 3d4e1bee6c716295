//! Union, difference and intersection of two solids.

use crate::error::Error;
use glam::DVec3;
use mesh_core::{Connected, Origins, TriMesh, VertexId, Watch};

/// Which points the result holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Points in either part.
    Union,
    /// Points in part a that are not in part b.
    Difference,
    /// Points in both parts.
    Intersection,
}

/// How a boolean treats its seam.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// What to do with short edges and slivers along the seam.
    pub slivers: Slivers,
    /// What to do where the parts touch without overlapping.
    pub contact: Contact,
}

impl Default for Params {
    fn default() -> Self {
        Self { slivers: Slivers::Collapse { tolerance: 1e-9 }, contact: Contact::Split }
    }
}

/// What to do with short edges along the seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slivers {
    /// Leave every cut where it fell. For callers that replace the seam anyway.
    Keep,
    /// Collapse edges at new vertices that are shorter than the tolerance, where the surface neither folds nor pinches.
    Collapse {
        /// As a multiple of the diagonal of the box around both parts.
        tolerance: f64,
    },
}

/// What to do where the result would pinch to an edge or a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Give each sheet its own copy of the vertices there, and warn. The sheets still touch in space.
    Split,
    /// Fail with [`Error::Contact`].
    Refuse,
}

/// The result of a boolean.
#[derive(Clone, Debug)]
pub struct Boolean {
    /// A closed, oriented 2-manifold. Vertices and faces of a first, then of b, then new ones.
    pub mesh: TriMesh,
    /// Where everything came from: part 0 is a, part 1 is b.
    pub origins: Origins,
    /// The closed curves in which the surfaces meet, as far as they are on the result.
    pub seams: Vec<Seam>,
    /// What was done and how long it took.
    pub report: Report,
}

/// A curve along which faces of two parts meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Vertices of the result in order, each joined to the next by an edge. Walking along with the surface normal up,
    /// the lower-numbered part (a) is on the left.
    pub vertices: Vec<VertexId>,
    /// Whether the last vertex is joined to the first.
    pub closed: bool,
}

/// What a boolean did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Pairs of faces whose boxes overlap.
    pub candidate_pairs: usize,
    /// Pairs of faces that meet in a segment or an area.
    pub crossing_pairs: usize,
    /// Faces of a and of b that were cut or lie along the seam.
    pub cut_faces: [usize; 2],
    /// New vertices.
    pub new_vertices: usize,
    /// Stages in order, with milliseconds.
    pub stages: Vec<(&'static str, f64)>,
    /// What the caller may want to know.
    pub warnings: Vec<Warning>,
}

/// Something unusual that was dealt with.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Faces of the two parts lie in one plane and overlap.
    Coplanar {
        /// Pairs of such faces.
        pairs: usize,
        /// One of the places.
        at: DVec3,
    },
    /// The parts touch along edges or at vertices; the sheets got their own vertices there.
    Contact {
        /// Vertices that were duplicated.
        vertices: usize,
        /// One of the places.
        at: DVec3,
    },
    /// Points that 64-bit coordinates could not keep apart were merged.
    Merged {
        /// How many.
        points: usize,
        /// One of the places.
        at: DVec3,
    },
    /// Short edges along the seam were collapsed.
    Collapsed {
        /// How many.
        edges: usize,
    },
}

/// Joins, subtracts or intersects two solids.
///
/// # Errors
/// See [`Error`].
pub fn boolean(
    _a: &Connected<TriMesh>,
    _b: &Connected<TriMesh>,
    _operation: Operation,
    _params: &Params,
    _watch: &Watch,
) -> Result<Boolean, Error> {
    Err(Error::Empty("not built yet"))
}
