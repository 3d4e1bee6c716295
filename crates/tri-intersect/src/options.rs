//! What a boolean makes of two solids, and how it treats their seam.

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
    /// Fail with [`crate::Error::Contact`].
    Refuse,
}
