//! The curves that can be blended: feature curves of a shape, seams of a boolean.

use crate::edit::{self, At, Kind, Set};
use crate::frame::{drawing_origin, drawn, revision};
use crate::questions::connected;
use crate::refusal::Refusal;
use crate::scene::Scene;
use crate::sources::Rooted;
use crate::studio::Studio;
use fusion::blend::BlendCurve;
use fusion::choice::seam_curves;
use fusion::document::{Action, Shapes, Shown, Step};
use fusion::features::{Convexity, FeatureCurve, Params, feature_curves};
use fusion::mesh_core::{Adjacency, Connected, FaceOrigin, HalfedgeId, Origins, TriMesh, Watch, dihedral_angle};
use fusion::{Document, ListedCurve, list_curves};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Curves of a shape.
pub struct Edges {
    /// The shape, which no step needs to have left like this.
    pub shown: Shown,
    /// Its connectivity.
    pub mesh: Connected<TriMesh>,
    /// The curves.
    pub curves: Vec<FeatureCurve>,
}

/// The feature curves of a shape at an angle.
///
/// # Errors
/// [`Refusal`].
pub fn of_shape(shown: &Shown, angle: Option<f64>) -> Result<Edges, Refusal> {
    let default = Params::default();
    let angle = angle.unwrap_or(default.angle);
    if !(angle > 0.0 && angle < 180.0) {
        return Err(Refusal::new("an angle between 0 and 180 degrees is needed"));
    }
    let mesh = connected(shown)?;
    let curves = feature_curves(&mesh, &Params { angle, ..default });
    Ok(Edges { shown: shown.clone(), mesh, curves })
}

/// The curves that a step could blend, listed: see [`of_action`].
///
/// # Errors
/// [`Refusal`].
pub fn of_step(
    studio: &Studio,
    scene: &Scene,
    index: usize,
    angle: Option<f64>,
    watch: &Watch,
) -> Result<Value, Refusal> {
    Ok(listed(&of_action(studio, scene, index, angle, watch)?))
}

/// The curves that a step could blend, before it has blended any: the seams of a boolean, the feature curves of what a blend takes.
///
/// # Errors
/// [`Refusal`].
pub fn of_action(
    studio: &Studio,
    scene: &Scene,
    index: usize,
    angle: Option<f64>,
    watch: &Watch,
) -> Result<Edges, Refusal> {
    let Some(step) = scene.document.steps().get(index) else {
        return Err(Refusal::new(format!("there is no step {index}")));
    };
    let before = before(&scene.made, index);
    match &step.action {
        Action::Blend(blend) => {
            let name = step.of.first().map_or("", String::as_str);
            let shown = before.latest(name).ok_or_else(|| Refusal::new(format!("`{name}` is not there yet")))?;
            of_shape(shown, Some(angle.unwrap_or(blend.angle)))
        }
        Action::Boolean(_) => {
            let shown = sharp(studio, scene, index, watch)?;
            let mesh = connected(&shown)?;
            let curves = match seam_curves(&mesh, &sides(&shown.origins, &before, step)) {
                Ok(curves) => curves.into_iter().map(|curve| measured(&mesh, curve)).collect(),
                Err(fusion::Error::Choice(_)) => vec![],
                Err(error) => return Err(error.into()),
            };
            Ok(Edges { shown, mesh, curves })
        }
        _ => Err(Refusal::new("only booleans and blends have curves to blend")),
    }
}

/// Curves as the page draws them, relative to `origin`.
pub fn listed(edges: &Edges) -> Value {
    let Edges { shown, mesh, curves } = edges;
    let origin = drawing_origin(shown);
    let one = |(listed, curve): (ListedCurve, &FeatureCurve)| {
        let points: Vec<_> = listed.points.iter().map(|&p| drawn(p.into(), origin)).collect();
        json!({
            "id": listed.id, "length": listed.length, "closed": listed.closed,
            "convex": curve.convexity == Convexity::Convex, "angle": listed.angles[1], "angles": listed.angles,
            "seam": is_seam(mesh, curve, &shown.origins), "near": listed.near, "points": points,
        })
    };
    let list: Vec<_> = list_curves(mesh, curves, &[]).into_iter().zip(curves).map(one).collect();
    json!({ "revision": revision(shown), "origin": origin.to_array(), "curves": list })
}

/// What was made before a step.
pub fn before(made: &Shapes, index: usize) -> Shapes {
    let mut before = made.clone();
    before.steps.truncate(index);
    before
}

/// What a boolean makes without a radius.
fn sharp(studio: &Studio, scene: &Scene, index: usize, watch: &Watch) -> Result<Shown, Refusal> {
    let at = |table, index| At { table, index, name: String::new() };
    let radius = Set { at: at(Kind::Step, index), key: "radius".into(), value: Value::Null };
    let mut text = edit::set(&scene.document.to_toml(), &[radius])?;
    for later in (index + 1..scene.document.steps().len()).rev() {
        text = edit::remove(&text, &at(Kind::Step, later))?;
    }
    for output in (0..scene.document.outputs().len()).rev() {
        text = edit::remove(&text, &at(Kind::Output, output))?;
    }
    let mut sources = Rooted { root: &studio.root, folder: &scene.folder, meshes: &studio.meshes };
    let made = Document::parse(&text)?.shapes(&mut sources, &studio.cache, watch)?;
    match (made.steps.get(index), made.stopped) {
        (Some(shown), _) => Ok(shown.clone()),
        (None, Some(stopped)) => Err(Refusal::of(&stopped.error)),
        (None, None) => Err(Refusal::new("the step is off")),
    }
}

/// Which of a step's shapes every face comes from, as far as the document's parts tell.
fn sides(origins: &Origins, before: &Shapes, step: &Step) -> Vec<Option<u32>> {
    let mut of: BTreeMap<u32, u32> = BTreeMap::new();
    for (side, name) in (0..).zip(&step.of) {
        let faces = before.latest(name).into_iter().flat_map(|shown| shown.origins.faces.as_slice());
        let parts: BTreeSet<u32> = faces.filter_map(part).collect();
        for part in parts {
            of.entry(part).or_insert(side);
        }
    }
    origins.faces.as_slice().iter().map(|face| part(face).and_then(|part| of.get(&part).copied())).collect()
}

fn part(face: &FaceOrigin) -> Option<u32> {
    match *face {
        FaceOrigin::Input { part, .. } | FaceOrigin::Piece { part, .. } => Some(part),
        FaceOrigin::New { .. } => None,
    }
}

/// A seam with its length and dihedral angles, convex where most of its edges are.
fn measured(mesh: &Connected<TriMesh>, curve: BlendCurve) -> FeatureCurve {
    let angles: Vec<f64> = curve.halfedges.iter().filter_map(|&h| dihedral_angle(mesh, h)).collect();
    let convex = 2 * angles.iter().filter(|a| **a > 0.0).count() > angles.len();
    let sizes = angles.iter().map(|a| a.abs().to_degrees());
    let [low, high] = sizes.fold([f64::INFINITY, 0.0f64], |[low, high], a| [low.min(a), high.max(a)]);
    FeatureCurve {
        convexity: if convex { Convexity::Convex } else { Convexity::Concave },
        length: curve.length(mesh),
        angles: [low.min(high), high],
        halfedges: curve.halfedges,
        closed: curve.closed,
    }
}

/// Whether most of its edges lie between faces of two parts.
fn is_seam(mesh: &Connected<TriMesh>, curve: &FeatureCurve, origins: &Origins) -> bool {
    let of = |h: HalfedgeId| part(&origins.faces[h.face()]);
    let between =
        |h: &&HalfedgeId| mesh.twin(**h).is_some_and(|twin| of(**h).zip(of(twin)).is_some_and(|(a, b)| a != b));
    2 * curve.halfedges.iter().filter(between).count() > curve.halfedges.len()
}
