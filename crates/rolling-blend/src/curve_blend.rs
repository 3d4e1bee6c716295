//! What each curve of a blend was made by.

use glam::DVec3;
use mesh_core::{Connected, TriMesh};
use spine::{BlendCurve, RadiusField, Rail};

/// What a curve was blended by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// A swept strip.
    Strip,
    /// The envelope of all balls that fit.
    Envelope,
    /// A field of balls on both sides.
    Field,
    /// The mesh's own vertices, moved onto the sweep.
    Keep,
    /// Nothing: it is as sharp as before.
    Sharp,
}

/// Why a curve is left sharp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LeftSharp {
    /// No ball of any radius tried fits.
    #[error("no ball fits")]
    NoBall,
    /// A wall is thinner than the ball.
    #[error("a wall is too thin for the ball")]
    ThinWall,
    /// The ball would close a tunnel.
    #[error("the ball would close a tunnel")]
    Tunnel,
    /// A stage failed for every radius tried.
    #[error("{0}")]
    Stage(&'static str),
}

/// How one curve was blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveBlend {
    /// By what.
    pub method: Method,
    /// The smallest radius used along it, in model units; 0 where it is left sharp.
    pub radius: f64,
    /// Its length, in model units.
    pub length: f64,
    /// Share of it on which the stages used the full radius.
    pub full_share: f64,
    /// Where and why it is left sharp.
    pub left_sharp: Option<(DVec3, LeftSharp)>,
}

impl CurveBlend {
    /// A curve that has not been blended.
    pub fn sharp(length: f64, why: Option<(DVec3, LeftSharp)>) -> Self {
        Self { method: Method::Sharp, radius: 0.0, length, full_share: 0.0, left_sharp: why }
    }

    /// A curve of which only the method and the smallest radius are known.
    pub fn made(method: Method, radius: f64, length: f64, full_share: f64) -> Self {
        Self { method, radius, length, full_share, left_sharp: None }
    }
}

/// The curves of a sweep: a rail each, where it was rolled, and the radius that each was rolled with, dips included.
pub(crate) fn swept(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    rails: &[Option<Rail>],
    field: impl Fn(usize) -> RadiusField,
) -> Vec<CurveBlend> {
    let made = |(i, (curve, rail)): (usize, (&BlendCurve, &Option<Rail>))| {
        let (length, field) = (curve.length(mesh), field(i));
        let Some(rail) = rail else { return CurveBlend::made(Method::Strip, field.base, length, 1.0) };
        let full = rail.samples.iter().filter(|s| s.radius >= 0.999 * field.undipped(s.center).0).count();
        // Not that of the rail, which dwindles where a curve runs out.
        let radius = rail.samples.iter().map(|s| field.at(s.center).0).fold(field.base, f64::min);
        CurveBlend::made(Method::Strip, radius, length, full as f64 / rail.samples.len().max(1) as f64)
    };
    curves.iter().zip(rails).enumerate().map(made).collect()
}
