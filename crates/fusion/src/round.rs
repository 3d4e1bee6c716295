//! Rounds the feature curves of one mesh.

use crate::blend::{self, Limit};
use crate::features::{self, Convexity, FeatureCurve, feature_curves, nearest_curve};
use crate::outcome::{Inputs, Outcome, Promise, account, finish_as, surviving};
use crate::picks::{self, Picked};
use crate::{Counts, Error, Report, extent};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, Faces, HalfedgeId, TriMesh, VertexId, Watch, boundary_loops};
use mesh_io::{Format, Model};
use rayon::prelude::*;
use spine::BlendCurve;
use std::collections::BTreeMap;

/// Which curves are rounded, and how.
#[derive(Clone, Debug)]
pub struct Params {
    /// What a feature curve is.
    pub features: features::Params,
    /// Points in model units, each naming the feature curve nearest to it.
    pub near: Vec<DVec3>,
    /// Curves through picked points, beside those near places; feature curves count only where neither is given.
    pub picked: Vec<Picked>,
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
    extent::check(std::slice::from_ref(part))?;
    surviving(Some(&params.blend), |blend| round_once(part, params, blend.unwrap_or(&params.blend), watch))
}

/// The largest radius at which the chosen curves can be blended without making the ball smaller anywhere, and what is in
/// the way of a larger one. Nothing is made.
///
/// # Errors
/// As [`round`]; [`Error::Blend`] if no radius works.
pub fn max_radius(part: &Model, params: &Params, watch: &Watch) -> Result<Limit, Error> {
    extent::check(std::slice::from_ref(part))?;
    let mesh = Connected::new(part.mesh.clone()).map_err(|source| Error::NotManifold { part: 0, source })?;
    let curves = choose(&mesh, params)?;
    Ok(blend::max_radius(&mesh, &curves, &params.blend, watch)?)
}

/// Roughly the same for each of `curves` alone, without a look at smaller radii; `None` where a 256th of the curve's box is too
/// large already, and for curves of more
/// than 40 edges or after 400 edges in all: a list is to be made in seconds. Ask for those alone.
///
/// # Errors
/// [`Error::Extent`], [`Error::Cancelled`].
pub fn max_radius_of_each(
    mesh: &Connected<TriMesh>,
    curves: &[FeatureCurve],
    watch: &Watch,
) -> Result<Vec<Option<Limit>>, Error> {
    extent::check_box(mesh_core::bounds(mesh))?;
    let mut edges = 0;
    let due = |curve: &FeatureCurve| {
        let own = curve.halfedges.len();
        let due = own <= LONGEST && edges + own <= ALL;
        edges += if due { own } else { 0 };
        due
    };
    let due: Vec<bool> = curves.iter().map(due).collect();
    let limit = |(curve, due): (&FeatureCurve, &bool)| {
        watch.step("radii", 0.0)?;
        if !due {
            return Ok(None);
        }
        let chain = BlendCurve { halfedges: curve.halfedges.clone(), closed: curve.closed };
        match blend::rough_max_radius(HALVINGS, mesh, &[chain], &blend::Params::new(1.0), watch) {
            Ok(limit) => Ok(Some(limit)),
            Err(blend::Error::Cancelled(c)) => Err(c.into()),
            Err(_) => Ok(None),
        }
    };
    curves.par_iter().zip(&due).map(limit).collect()
}

/// Most edges of a curve in a list of radii, and of all its curves.
const LONGEST: usize = 40;
const ALL: usize = 400;
/// How often the first radius is halved for a list.
const HALVINGS: u32 = 2;

fn round_once(part: &Model, params: &Params, how: &blend::Params, watch: &Watch) -> Result<Outcome, Error> {
    let mut report = Report::new("blend", vec![Counts::of("", &part.mesh)]);
    let mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| Error::NotManifold { part: 0, source })?;
    let curves = report.time("features", || choose(&mesh, params))?;
    report.figures.insert("curves".into(), curves.len() as f64);
    let blended = report.time("blend", || blend::blend(&mesh, &curves, how, watch))?;
    account(&blended, how, &mut report);
    let promise = Promise::Openings(boundary_loops(&mesh).len());
    let inputs = Inputs { models: std::slice::from_ref(part), connected: &[&mesh] };
    finish_as(promise, inputs, blended.mesh, blended.origins, params.format, report, watch)
}

fn choose(mesh: &Connected<TriMesh>, params: &Params) -> Result<Vec<BlendCurve>, Error> {
    let picked = picks::trace(mesh, &params.picked)?;
    let all = feature_curves(mesh, &params.features);
    if all.is_empty() && picked.is_empty() {
        let angle = params.features.angle;
        return Err(Error::NoCurve(format!("no edge turns by {angle} degrees or more; lower --angle"), None));
    }
    let mut chosen: Vec<usize> = params.near.iter().filter_map(|&p| Some(nearest_curve(mesh, &all, p)?.0)).collect();
    if params.near.is_empty() && picked.is_empty() {
        chosen = (0..all.len()).collect();
    }
    chosen.sort_unstable();
    chosen.dedup();
    let curve =
        |id: usize| (all[id].convexity, BlendCurve { halfedges: all[id].halfedges.clone(), closed: all[id].closed });
    let mut curves: Vec<_> = chosen.into_iter().map(curve).collect();
    for curve in picked {
        let convexity = match curve.convexity(mesh).map_err(blend::Error::from)? {
            spine::Convexity::Convex => Convexity::Convex,
            spine::Convexity::Concave => Convexity::Concave,
        };
        curves.push((convexity, curve));
    }
    Ok(joined(mesh, curves))
}

/// Curves of one convexity joined where just two of those chosen meet: nothing else sets them apart there.
fn joined(mesh: &Connected<TriMesh>, mut curves: Vec<(Convexity, BlendCurve)>) -> Vec<BlendCurve> {
    let mut at: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    let ends =
        |c: &BlendCurve| c.halfedges.first().zip(c.halfedges.last()).map(|(&f, &l)| [mesh.tail(f), mesh.head(l)]);
    for (i, (_, curve)) in curves.iter().enumerate().filter(|(_, c)| !c.1.closed) {
        ends(curve).into_iter().flatten().for_each(|v| at.entry(v).or_default().push(i));
    }
    let mut taken_by: Vec<usize> = (0..curves.len()).collect();
    let follow = |taken_by: &[usize], mut i: usize| {
        while taken_by[i] != i {
            i = taken_by[i];
        }
        i
    };
    for (vertex, meeting) in at {
        let &[i, j] = &meeting[..] else { continue };
        // Earlier joins may have taken a curve into another.
        let (i, j) = (follow(&taken_by, i), follow(&taken_by, j));
        if curves[i].0 != curves[j].0 {
            continue;
        }
        if i == j {
            curves[i].1.closed = ends(&curves[i].1).is_some_and(|e| e[0] == e[1]);
            continue;
        }
        let mut first = curves[i].1.halfedges.clone();
        let mut second = std::mem::take(&mut curves[j].1.halfedges);
        if ends(&curves[i].1).is_some_and(|e| e[1] != vertex) {
            first = reversed(mesh, &first);
        }
        if second.first().is_some_and(|&h| mesh.tail(h) != vertex) {
            second = reversed(mesh, &second);
        }
        first.append(&mut second);
        taken_by[j] = i;
        curves[i].1.halfedges = first;
    }
    curves.into_iter().map(|c| c.1).filter(|c| !c.halfedges.is_empty()).collect()
}

fn reversed(mesh: &Connected<TriMesh>, chain: &[HalfedgeId]) -> Vec<HalfedgeId> {
    chain.iter().rev().filter_map(|&h| mesh.twin(h)).collect()
}
