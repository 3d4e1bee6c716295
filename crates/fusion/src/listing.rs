//! Feature curves as every door lists them.

use crate::blend::ListedRadius;
use crate::features::{Convexity, FeatureCurve, point_within};
use mesh_core::{Connected, Positions, TriMesh, VertexId};
use serde::Serialize;

/// One feature curve. Lengths and places are in model units, angles in degrees.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ListedCurve {
    /// Its number, by which `blend` takes it at the same angle.
    pub id: usize,
    /// How long it is.
    pub length: f64,
    /// `"convex"` or `"concave"`.
    pub convexity: &'static str,
    /// Whether it ends where it begins.
    pub closed: bool,
    /// The smallest and the largest dihedral angle along it.
    pub angles: [f64; 2],
    /// The two ends of an open curve.
    pub ends: Vec<[f64; 3]>,
    /// A point to which no other curve is nearer.
    pub near: [f64; 3],
    /// The largest radius of a ball along it, where that was asked for; an upper bound unless it was tried.
    pub max_radius: Option<f64>,
    /// Whether a blend of that radius was tried.
    pub max_radius_tried: Option<bool>,
    /// What is in the way of a larger one, and where.
    pub limited_by: Option<&'static str>,
    /// See [`Self::limited_by`].
    pub limited_at: Option<[f64; 3]>,
    /// Its vertices in order.
    pub vertices: Vec<u32>,
    /// Their places.
    pub points: Vec<[f64; 3]>,
}

/// The word for a curve's convexity.
pub fn convexity_word(curve: &FeatureCurve) -> &'static str {
    match curve.convexity {
        Convexity::Convex => "convex",
        Convexity::Concave => "concave",
    }
}

/// Lists the curves of a mesh with the largest radius of each, where it is known.
///
/// ```
/// use fusion::features::{Params, feature_curves};
/// use fusion::mesh_core::{Connected, shapes};
/// let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
/// let curves = feature_curves(&cube, &Params::default());
/// let listed = fusion::list_curves(&cube, &curves, &[]);
/// assert_eq!((listed.len(), listed[3].convexity, listed[3].max_radius), (12, "convex", None));
/// # Ok::<(), fusion::mesh_core::NotManifold>(())
/// ```
pub fn list_curves(
    mesh: &Connected<TriMesh>,
    curves: &[FeatureCurve],
    radii: &[Option<ListedRadius>],
) -> Vec<ListedCurve> {
    let list = |(id, curve): (usize, &FeatureCurve)| {
        let vertices: Vec<VertexId> = curve.vertices(mesh);
        let points: Vec<[f64; 3]> = vertices.iter().map(|&v| mesh.position(v).to_array()).collect();
        let ends = points.first().into_iter().chain(points.last()).filter(|_| !curve.closed).copied().collect();
        let limit = radii.get(id).and_then(Option::as_ref);
        ListedCurve {
            id,
            length: curve.length,
            convexity: convexity_word(curve),
            closed: curve.closed,
            angles: curve.angles,
            ends,
            near: point_within(mesh, curve).to_array(),
            max_radius: limit.map(|l| l.radius),
            max_radius_tried: limit.map(|l| l.tried),
            limited_by: limit.map(|l| l.what),
            limited_at: limit.map(|l| l.at.to_array()),
            vertices: vertices.iter().map(|v| v.0).collect(),
            points,
        }
    };
    curves.iter().enumerate().map(list).collect()
}
