//! Rounds the feature curves of one mesh.

use crate::features::{self, feature_curves, nearest_curve};
use crate::outcome::{Outcome, account, finish, surviving};
use crate::{Counts, Error, Report, blend};
use glam::DVec3;
use mesh_core::{Connected, TriMesh, Watch};
use mesh_io::{Format, Model};
use spine::BlendCurve;

/// Which curves are rounded, and how.
#[derive(Clone, Debug)]
pub struct Params {
    /// What a feature curve is.
    pub features: features::Params,
    /// Points in model units, each naming the feature curve nearest to it. Empty means all curves.
    pub near: Vec<DVec3>,
    /// The ball.
    pub blend: blend::Params,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

/// Blends the chosen feature curves of a solid, all at once. Open ones meet in corner patches, stop or run out.
///
/// # Errors
/// [`Error`]; a radius that does not fit comes with a place and a radius that does.
pub fn round(part: &Model, params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    surviving(Some(&params.blend), |blend| round_once(part, params, blend.unwrap_or(&params.blend), watch))
}

fn round_once(part: &Model, params: &Params, how: &blend::Params, watch: &Watch) -> Result<Outcome, Error> {
    let mut report = Report::new("blend", vec![Counts::of("", &part.mesh)]);
    let mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| Error::NotManifold { part: 0, source })?;
    let curves = report.time("features", || choose(&mesh, params))?;
    report.figures.insert("curves".into(), curves.len() as f64);
    let blended = report.time("blend", || blend::blend(&mesh, &curves, how, watch))?;
    account(&blended, how, &mut report);
    finish(std::slice::from_ref(part), blended.mesh, blended.origins, params.format, report, watch)
}

fn choose(mesh: &Connected<TriMesh>, params: &Params) -> Result<Vec<BlendCurve>, Error> {
    let all = feature_curves(mesh, &params.features);
    if all.is_empty() {
        let angle = params.features.angle;
        return Err(Error::NoCurve(format!("no edge turns by {angle} degrees or more; lower --angle"), None));
    }
    let mut chosen: Vec<usize> = params.near.iter().filter_map(|&p| Some(nearest_curve(mesh, &all, p)?.0)).collect();
    if params.near.is_empty() {
        chosen = (0..all.len()).collect();
    }
    chosen.sort_unstable();
    chosen.dedup();
    let curve = |id: usize| BlendCurve { halfedges: all[id].halfedges.clone(), closed: all[id].closed };
    Ok(chosen.into_iter().map(curve).collect())
}
