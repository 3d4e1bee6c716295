//! The largest radius that works.

use crate::questions::{connected, features};
use crate::refusal::Refusal;
use crate::root::Root;
use crate::scene::Scene;
use crate::sources::{Meshes, Rooted};
use fusion::blend::{Limit, Params, max_radius};
use fusion::document::{Action, Shown};
use fusion::features::feature_curves;
use fusion::mesh_core::Watch;
use fusion::operation::Options;
use mesh_io::Model;
use serde_json::{Value, json};

/// Along some feature curves of a shape.
///
/// # Errors
/// [`Refusal`].
pub fn of_curves(shown: &Shown, ids: &[usize], angle: Option<f64>, watch: &Watch) -> Result<Value, Refusal> {
    let mesh = connected(shown)?;
    let all = feature_curves(&mesh, &features(angle)?);
    let chosen: Vec<_> = ids.iter().filter_map(|&id| all.get(id).cloned().map(Into::into)).collect();
    if chosen.len() < ids.len() {
        return Err(Refusal::new(format!("`{}` has {} feature curves at this angle", shown.name, all.len())));
    }
    Ok(told(&max_radius(&mesh, &chosen, &Params::new(1.0), watch).map_err(fusion::Error::from)?))
}

/// At the seams of a boolean, or the curves that a blend takes.
///
/// # Errors
/// [`Refusal`].
pub fn of_step(scene: &Scene, index: usize, files: (&Root, &Meshes), watch: &Watch) -> Result<Value, Refusal> {
    let Some(step) = scene.document.steps().get(index) else {
        return Err(Refusal::new(format!("there is no step {index}")));
    };
    let mut before = scene.made.clone();
    before.steps.truncate(index);
    let models = step.of.iter().map(|name| before.latest(name).map(|shown| (*shown.model).clone()));
    let Some(models) = models.collect::<Option<Vec<Model>>>() else {
        return Err(Refusal::new("the shapes of this step are not there yet"));
    };
    let (root, meshes) = files;
    let mut sources = Rooted { root, folder: &scene.folder, meshes };
    let limit = match (step.action.clone(), &models[..]) {
        (Action::Boolean(mut boolean), _) => {
            boolean.load(&mut sources).map_err(fusion::Error::from)?;
            boolean.max_radius(&models, watch)?
        }
        (Action::Blend(mut blend), [model, ..]) => {
            blend.load(&mut sources).map_err(fusion::Error::from)?;
            blend.max_radius(model, watch)?
        }
        _ => return Err(Refusal::new("only booleans and blends have a radius that can be too large")),
    };
    Ok(told(&limit))
}

fn told(limit: &Limit) -> Value {
    json!({ "radius": limit.radius, "limit": limit.what, "place": limit.at.map(|p| p.to_array()) })
}
