//! A named shape while a document is evaluated.

use super::key::Key;
use crate::Validity;
use mesh_core::{Connected, Faces, Origins, VertexId, boundary_loops};
use mesh_io::Model;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A shape. Cheap to clone.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) model: Arc<Model>,
    /// With respect to the document's parts.
    pub(super) origins: Arc<Origins>,
    pub(super) key: Key,
    /// What it was found to be; `None` for what was only read or moved.
    pub(super) validity: Option<Validity>,
    /// The steps that lead to it, counted from 0.
    pub(super) steps: BTreeSet<usize>,
}

impl Shape {
    /// The boundary loops; none where the mesh is no manifold.
    pub(super) fn loops(&self) -> Vec<Vec<VertexId>> {
        let Ok(mesh) = Connected::new(&self.model.mesh) else { return vec![] };
        boundary_loops(&mesh).iter().map(|l| l.iter().map(|&h| mesh.tail(h)).collect()).collect()
    }
}
