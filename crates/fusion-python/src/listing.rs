//! Measures of a mesh, and its feature curves.

use crate::failure::Fault;
use fusion::blend::ListedRadius;
use fusion::features::{Convexity, FeatureCurve, Params, feature_curves, point_within};
use fusion::mesh_core::{Connected, Positions, TriMesh, Watch};
use fusion::round::max_radius_of_each;
use fusion::{Error, Info};
use serde_json::{Value, json};

/// What a mesh is.
pub fn info(mesh: &TriMesh, watch: &Watch) -> Result<Value, Fault> {
    let info = Info::of(mesh, watch).map_err(|_| Fault::Cancelled)?;
    serde_json::to_value(info).map_err(|e| Fault::Internal(e.to_string()))
}

/// The curves along which a surface turns by an angle, in degrees, with the keys that `fusion-cli features --json` prints.
pub fn features(mesh: TriMesh, angle: f64, radii: bool, watch: &Watch) -> Result<Value, Fault> {
    let mesh = Connected::new(mesh).map_err(|source| Fault::Engine(Error::NotManifold { part: 0, source }))?;
    let curves = feature_curves(&mesh, &Params { angle, ..Params::default() });
    let limits = if radii { max_radius_of_each(&mesh, &curves, watch)? } else { vec![None; curves.len()] };
    let listed = curves.iter().zip(&limits).enumerate();
    Ok(listed.map(|(id, (curve, limit))| described(&mesh, id, curve, limit.as_ref())).collect())
}

fn described(mesh: &Connected<TriMesh>, id: usize, curve: &FeatureCurve, limit: Option<&ListedRadius>) -> Value {
    let vertices = curve.vertices(mesh);
    let points: Vec<[f64; 3]> = vertices.iter().map(|&v| mesh.position(v).to_array()).collect();
    let ends: Vec<_> = points.first().into_iter().chain(points.last()).filter(|_| !curve.closed).collect();
    json!({
        "id": id,
        "length": curve.length,
        "convexity": match curve.convexity {
            Convexity::Convex => "convex",
            Convexity::Concave => "concave",
        },
        "closed": curve.closed,
        "angles": curve.angles,
        "ends": ends,
        "near": point_within(mesh, curve).to_array(),
        "max_radius": limit.map(|l| l.radius),
        "max_radius_tried": limit.map(|l| l.tried),
        "limited_by": limit.map(|l| l.what),
        "limited_at": limit.map(|l| l.at.to_array()),
        "vertices": vertices.iter().map(|v| v.0).collect::<Vec<_>>(),
        "points": points,
    })
}
