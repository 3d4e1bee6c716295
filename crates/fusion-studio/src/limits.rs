//! The largest radius that works.

use crate::edges::{Edges, before, of_action, of_shape};
use crate::refusal::Refusal;
use crate::scene::Scene;
use crate::sources::Rooted;
use crate::studio::Studio;
use fusion::blend::{Limit, Params, max_radius};
use fusion::document::{Action, Shown};
use fusion::features::{FeatureCurve, point_within};
use fusion::mesh_core::Watch;
use fusion::operation::Options;
use mesh_io::Model;
use serde_json::{Value, json};

/// Along some feature curves of a shape.
///
/// # Errors
/// [`Refusal`].
pub fn of_curves(shown: &Shown, ids: &[usize], angle: Option<f64>, watch: &Watch) -> Result<Value, Refusal> {
    let edges = of_shape(shown, angle)?;
    let chosen: Vec<_> = picked(&edges, ids)?.into_iter().cloned().map(Into::into).collect();
    Ok(told(&max_radius(&edges.mesh, &chosen, &Params::new(1.0), watch).map_err(fusion::Error::from)?))
}

/// At the curves that a boolean or a blend takes, or at some that it could take.
///
/// # Errors
/// [`Refusal`].
pub fn of_step(
    studio: &Studio,
    scene: &Scene,
    index: usize,
    (ids, angle): (&[usize], Option<f64>),
    watch: &Watch,
) -> Result<Value, Refusal> {
    let Some(step) = scene.document.steps().get(index) else {
        return Err(Refusal::new(format!("there is no step {index}")));
    };
    let before = before(&scene.made, index);
    let models = step.of.iter().map(|name| before.latest(name).map(|shown| (*shown.model).clone()));
    let Some(models) = models.collect::<Option<Vec<Model>>>() else {
        return Err(Refusal::new("the shapes of this step are not there yet"));
    };
    let mut sources = Rooted { root: &studio.root, folder: &scene.folder, meshes: &studio.meshes };
    let limit = match (step.action.clone(), &models[..]) {
        (Action::Boolean(mut boolean), _) => {
            boolean.load(&mut sources).map_err(fusion::Error::from)?;
            if !ids.is_empty() {
                let edges = of_action(studio, scene, index, angle, watch)?;
                boolean.near = picked(&edges, ids)?.into_iter().map(|curve| point_within(&edges.mesh, curve)).collect();
            }
            boolean.max_radius(&models, watch)?
        }
        (Action::Blend(mut blend), [model, ..]) => {
            blend.load(&mut sources).map_err(fusion::Error::from)?;
            if !ids.is_empty() {
                (blend.ids, blend.near) = (ids.to_vec(), vec![]);
                blend.angle = angle.unwrap_or(blend.angle);
            }
            blend.max_radius(model, watch)?
        }
        _ => return Err(Refusal::new("only booleans and blends have a radius that can be too large")),
    };
    Ok(told(&limit))
}

fn picked<'a>(edges: &'a Edges, ids: &[usize]) -> Result<Vec<&'a FeatureCurve>, Refusal> {
    let (name, count) = (&edges.shown.name, edges.curves.len());
    let one = |&id: &usize| {
        let none = || Refusal::new(format!("`{name}` has {count} such curves, so there is no curve {id}"));
        edges.curves.get(id).ok_or_else(none)
    };
    ids.iter().map(one).collect()
}

fn told(limit: &Limit) -> Value {
    json!({ "radius": limit.radius, "limit": limit.what, "place": limit.at.map(|p| p.to_array()) })
}
