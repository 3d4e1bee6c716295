//! Why no curve can be chosen.

use glam::DVec3;

/// Why no curve can be chosen.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The mesh is smooth.
    #[error("no edge has a dihedral angle of {angle} degrees or more; the sharpest has {sharpest:.1}")]
    NoEdges {
        /// The angle asked for, in degrees.
        angle: f64,
        /// The largest dihedral angle of the mesh, in degrees.
        sharpest: f64,
    },
    /// A number too high.
    #[error("there is no feature curve {id}: there are {count}, counted from 0")]
    NoSuchCurve {
        /// The number.
        id: usize,
        /// How many curves there are.
        count: usize,
    },
    /// Filters leave nothing.
    #[error("none of the {count} curves passes the filters; the longest is {longest} long")]
    NothingPasses {
        /// How many curves there were.
        count: usize,
        /// The length of the longest, in model units.
        longest: f64,
    },
    /// The solid that curves are to lie in is not closed.
    #[error("the solid that is to hold the curves is not closed{}", .at.map_or(String::new(), |p| format!(": it is open at {p}")))]
    Open {
        /// A place at its boundary.
        at: Option<DVec3>,
    },
    /// The origins are those of another mesh.
    #[error("the origins list {entries} faces, but the mesh has {faces}")]
    OriginsOfAnother {
        /// Faces of the mesh.
        faces: usize,
        /// Faces in the origins.
        entries: usize,
    },
    /// All faces come from one part.
    #[error("no edge of the mesh lies between faces of different parts")]
    NoSeams,
}

impl Refusal {
    /// Where, in model units.
    pub(crate) fn place(&self) -> Option<DVec3> {
        if let Self::Open { at } = self { *at } else { None }
    }
}
