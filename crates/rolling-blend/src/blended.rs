//! A blended mesh and what is to be said of it.

use crate::curve_blend::CurveBlend;
use glam::DVec3;
use mesh_core::{FaceId, Origins, TriMesh};

/// A blended mesh and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Blended {
    /// The result; the blend's faces are the last ones, unless some curves were swept and others blended as a field.
    pub mesh: TriMesh,
    /// With respect to the input, as part 0.
    pub origins: Origins,
    /// First face of the blend.
    pub first_blend_face: FaceId,
    /// How many strips were swept; fewer than curves where neighbouring curves share one.
    pub strips: usize,
    /// How many pieces of surface were blended as a field.
    pub fields: usize,
    /// How many corner patches were made.
    pub corners: usize,
    /// Largest | distance of a ball's centre to a base patch − radius | over the radius.
    pub residual: f64,
    /// How many balls stood where the sweep folds, and gave way to bridges.
    pub bridged: usize,
    /// Where the ball was made smaller: place, and the radius there.
    pub shrunk: Vec<(DVec3, f64)>,
    /// Where sweeping failed and a field took its place: place, and what failed there.
    pub fallbacks: Vec<(DVec3, &'static str)>,
    /// Where a curve ends alone with no surface to stop at, so that the blend runs out in a point.
    pub run_outs: Vec<DVec3>,
    /// On which level of a decimation hierarchy the blend was made; 0 is the mesh itself.
    pub levels: usize,
    /// Share of the spine's length on which the ball has its full radius.
    pub full_share: f64,
    /// How each of the curves was blended, in their order.
    pub curves: Vec<CurveBlend>,
}

impl Blended {
    /// A mesh of whose blend nothing has been told yet.
    pub(crate) fn new(mesh: TriMesh, origins: Origins, first_blend_face: FaceId) -> Self {
        Self {
            mesh,
            origins,
            first_blend_face,
            strips: 0,
            fields: 0,
            corners: 0,
            residual: 0.0,
            bridged: 0,
            shrunk: vec![],
            fallbacks: vec![],
            run_outs: vec![],
            levels: 0,
            full_share: 1.0,
            curves: vec![],
        }
    }
}
