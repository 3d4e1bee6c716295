//! Plane cross-sections at which a strip begins or ends because something else blends the curve from there on.

use glam::DVec3;
use mesh_core::{EdgeId, Origins, VertexId, VertexOrigin};
use std::collections::{BTreeMap, HashMap};

/// Where a curve that goes on is blended by a strip up to here only. The vertices are those of the present mesh.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cap {
    /// The ball's centre in this cross-section.
    pub centre: DVec3,
    /// The chain that the strip ends in, from foot to foot: the profile of what goes on from here, or the sharp section itself.
    pub end: Vec<VertexId>,
    /// The sharp section, from the same foot to the other, the point of the blend curve among them.
    pub section: Vec<VertexId>,
}

/// What strips find at their ends.
#[derive(Clone, Debug, Default)]
pub(crate) struct Caps {
    /// The caps, by the vertex of the blend curve in which the strip's curve ends.
    pub at: BTreeMap<VertexId, Cap>,
    /// Edges that end the sides of these curves, beside the sections: those around what is blended already, and what stays
    /// sharp.
    pub border: Vec<EdgeId>,
}

impl Cap {
    /// Whether the curve stays sharp beyond: then the strip itself closes the gap between its last profile and the section.
    pub fn is_flat(&self) -> bool {
        self.end == self.section
    }
}

/// Where the vertices of a mesh went; `None` for those that are gone.
pub(crate) struct Moved(HashMap<VertexId, VertexId>);

impl Moved {
    /// By the origins of the changed mesh.
    pub fn by(origins: &Origins) -> Self {
        let pairs = (0u32..).map(VertexId).zip(origins.vertices.as_slice());
        let kept = |(now, origin): (VertexId, &VertexOrigin)| match *origin {
            VertexOrigin::Input { vertex, .. } => Some((vertex, now)),
            _ => None,
        };
        Self(pairs.filter_map(kept).collect())
    }

    /// A chain as it is now, if all of it is left.
    pub fn chain(&self, chain: &[VertexId]) -> Option<Vec<VertexId>> {
        chain.iter().map(|v| self.0.get(v).copied()).collect()
    }

    /// A cap as it is now, if all of it is left.
    pub fn cap(&self, cap: &Cap) -> Option<Cap> {
        Some(Cap { centre: cap.centre, end: self.chain(&cap.end)?, section: self.chain(&cap.section)? })
    }
}

/// A cross-section drawn on the sharp mesh, beyond which the envelope does not act.
#[derive(Clone, Debug)]
pub(crate) struct Fence {
    /// Its chain across the blend curve, from beyond one foot of the ball to beyond the other.
    pub chain: Vec<VertexId>,
    /// The vertex of the blend curve in it.
    pub apex: VertexId,
    /// The ball's centre in this cross-section.
    pub centre: DVec3,
    /// Where the chain has the ball's feet.
    pub feet: [usize; 2],
}

impl Fence {
    /// The cap of a strip that ends here although nothing goes on.
    pub fn flat(&self) -> Cap {
        let section = self.chain[self.feet[0]..=self.feet[1]].to_vec();
        Cap { centre: self.centre, end: section.clone(), section }
    }

    /// The same after the mesh has changed, if all of it is left.
    pub fn moved(&self, moved: &Moved) -> Option<Self> {
        let chain = moved.chain(&self.chain)?;
        let apex = moved.chain(&[self.apex])?[0];
        Some(Self { chain, apex, ..self.clone() })
    }
}
