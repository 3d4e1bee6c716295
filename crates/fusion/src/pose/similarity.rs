//! Similarities: scaling, turning and shifting, in this order.

use super::placement::Motion;
use glam::{DQuat, DVec3};
use mesh_core::TriMesh;
use mesh_io::Model;

/// A similarity: p ↦ rotation · (scale · p) + translation, in this order, in 64-bit arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Similarity {
    pub(crate) scale: f64,
    pub(crate) rotation: DQuat,
    pub(crate) translation: DVec3,
}

impl Similarity {
    pub(crate) const IDENTITY: Self = Self { scale: 1.0, rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// Scales, then turns about an axis through the origin by degrees, then shifts; `None` for one that is none.
    pub(crate) fn new(scale: f64, rotate: Option<(DVec3, f64)>, translation: DVec3) -> Option<Self> {
        let rotation = match rotate {
            None => DQuat::IDENTITY,
            Some((axis, angle)) => DQuat::from_axis_angle(axis.try_normalize()?, angle.to_radians()),
        };
        let usable = scale > 0.0 && scale.is_finite() && rotation.is_finite() && translation.is_finite();
        usable.then_some(Self { scale, rotation, translation })
    }

    /// This similarity, and then a motion.
    pub(crate) fn then(self, motion: Motion) -> Self {
        Self {
            scale: self.scale,
            rotation: motion.rotation * self.rotation,
            translation: motion.point(self.translation),
        }
    }

    pub(crate) fn point(&self, p: DVec3) -> DVec3 {
        self.rotation * (self.scale * p) + self.translation
    }

    pub(crate) fn is_identity(&self) -> bool {
        self.scale == 1.0 && self.rotation == DQuat::IDENTITY && self.translation == DVec3::ZERO
    }

    /// Moves a mesh. Identity leaves every bit.
    fn mesh(&self, mut mesh: TriMesh) -> TriMesh {
        if !self.is_identity() {
            for p in &mut mesh.positions {
                *p = self.point(*p);
            }
        }
        mesh
    }

    /// Moves a model, its normals with it.
    pub(crate) fn model(&self, mut model: Model) -> Model {
        if let Some(normals) = &mut model.normals {
            normals.as_mut_slice().iter_mut().for_each(|n| *n = self.rotation * *n);
        }
        model.mesh = self.mesh(std::mem::take(&mut model.mesh));
        model
    }
}
