//! Values in recipes.

use super::placement::Motion;
use glam::{DQuat, DVec3};
use mesh_core::TriMesh;
use mesh_io::Model;
use serde::Deserialize;

/// A turn about an axis through the origin.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
pub struct Rotation {
    /// The axis, of any length.
    pub axis: DVec3Array,
    /// Degrees, counter-clockwise seen against the axis.
    pub angle: f64,
}

/// Three numbers.
pub type DVec3Array = [f64; 3];

/// A similarity: p ↦ rotation · (scale · p) + translation, in this order, in 64-bit arithmetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) scale: f64,
    pub(super) rotation: DQuat,
    pub(super) translation: DVec3,
}

impl Pose {
    /// The pose of a part's table; `None` for one that is none.
    pub(super) fn new(scale: Option<f64>, rotate: Option<Rotation>, translate: Option<DVec3Array>) -> Option<Self> {
        let scale = scale.unwrap_or(1.0);
        let rotation = match rotate {
            None => DQuat::IDENTITY,
            Some(r) => DQuat::from_axis_angle(DVec3::from(r.axis).try_normalize()?, r.angle.to_radians()),
        };
        let translation = DVec3::from(translate.unwrap_or_default());
        let usable = scale > 0.0 && scale.is_finite() && rotation.is_finite() && translation.is_finite();
        usable.then_some(Self { scale, rotation, translation })
    }

    /// This pose, and then a motion.
    pub(super) fn then(self, motion: Motion) -> Self {
        Self {
            scale: self.scale,
            rotation: motion.rotation * self.rotation,
            translation: motion.point(self.translation),
        }
    }

    pub(super) fn point(&self, p: DVec3) -> DVec3 {
        self.rotation * (self.scale * p) + self.translation
    }

    fn is_identity(&self) -> bool {
        self.scale == 1.0 && self.rotation == DQuat::IDENTITY && self.translation == DVec3::ZERO
    }

    /// Poses a mesh. Identity leaves every bit.
    pub(super) fn mesh(&self, mut mesh: TriMesh) -> TriMesh {
        if !self.is_identity() {
            for p in &mut mesh.positions {
                *p = self.point(*p);
            }
        }
        mesh
    }

    /// Poses a file's contents.
    pub(super) fn model(&self, mut model: Model) -> Model {
        if let Some(normals) = &mut model.normals {
            normals.as_mut_slice().iter_mut().for_each(|n| *n = self.rotation * *n);
        }
        model.mesh = self.mesh(std::mem::take(&mut model.mesh));
        model
    }
}
