//! Measures of a mesh, and its feature curves.

use crate::failure::Fault;
use fusion::features::{Params, feature_curves};
use fusion::mesh_core::{Connected, TriMesh, Watch};
use fusion::round::max_radius_of_each;
use fusion::{Error, Info, list_curves};
use serde_json::Value;

/// What a mesh is.
pub fn info(mesh: &TriMesh, watch: &Watch) -> Result<Value, Fault> {
    let info = Info::of(mesh, watch).map_err(|_| Fault::Cancelled)?;
    serde_json::to_value(info).map_err(|e| Fault::Internal(e.to_string()))
}

/// The curves along which a surface turns by an angle, in degrees, with the keys that `fusion-cli features --json` prints.
pub fn features(mesh: TriMesh, angle: f64, radii: bool, watch: &Watch) -> Result<Value, Fault> {
    let mesh = Connected::new(mesh).map_err(|source| Fault::Engine(Error::NotManifold { part: 0, source }))?;
    let curves = feature_curves(&mesh, &Params { angle, ..Params::default() });
    let limits = if radii { max_radius_of_each(&mesh, &curves, watch)? } else { vec![] };
    serde_json::to_value(list_curves(&mesh, &curves, &limits)).map_err(|e| Fault::Internal(e.to_string()))
}
