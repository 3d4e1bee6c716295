//! Why no solid comes out of a repair.

use glam::DVec3;

/// Why there is no solid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// No face is left.
    #[error("no face with an area is left, so there is no surface to repair")]
    Nothing,
    /// The surface has holes.
    #[error(
        "the surface is not closed: {loops} boundary loops are left, the longest of {edges} edges, near {at}{}; {}",
        torn_note(*torn),
        what_helps(*unfilled)
    )]
    Open {
        /// How many boundary loops.
        loops: usize,
        /// Edges of the longest.
        edges: usize,
        /// A point on it.
        at: DVec3,
        /// Edges where faces had to be separated.
        torn: usize,
        /// How many no surface fills without crossing something; 0 where filling was not asked for.
        unfilled: usize,
    },
}

fn what_helps(unfilled: usize) -> String {
    match unfilled {
        0 => remedy(unfilled).into(),
        n => format!("no surface fills {n} of them without crossing something; {}", remedy(n)),
    }
}

/// A way out where holes are left, of which no surface fills so many.
pub(crate) fn remedy(unfilled: usize) -> &'static str {
    match unfilled {
        0 => "fill the holes (holes: fill), keep them (holes: keep), or close wider cracks (gap)",
        _ => "keep them (holes: keep), or close wider cracks (gap)",
    }
}

fn torn_note(torn: usize) -> String {
    if torn == 0 {
        return String::new();
    }
    format!(" ({torn} edges with more than two faces, or with faces that disagree, had to be separated)")
}

impl Refusal {
    /// Where.
    pub fn place(&self) -> Option<DVec3> {
        match self {
            Self::Nothing => None,
            Self::Open { at, .. } => Some(*at),
        }
    }
}
