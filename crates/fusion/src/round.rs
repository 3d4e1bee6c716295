//! Rounds the feature curves of one mesh.

use crate::blend::{self, Limit, ListedRadius};
use crate::choice::{Choice, Chosen, choose};
use crate::features::point_along;
use crate::features::{self, FeatureCurve};
use crate::metrics::{Part, record};
use crate::outcome::{Inputs, Outcome, finish_as, surviving};
use crate::validity::Promise;
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
    /// Which curves are blended.
    pub choice: Choice,
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
    let (chosen, _) = choose(&mesh, &params.features, &params.choice)?;
    let (curves, _) = joined(&mesh, &chosen);
    Ok(blend::max_radius(&mesh, &curves, &params.blend, watch)?)
}

/// The same for each of `curves` alone, found in little time: at most three blends are tried for a curve, and none for long curves or
/// once the list has cost enough, where [`ListedRadius::tried`] says that the radius is only an upper bound. `None` where no radius
/// tried works.
///
/// # Errors
/// [`Error::Extent`], [`Error::Cancelled`].
pub fn max_radius_of_each(
    mesh: &Connected<TriMesh>,
    curves: &[FeatureCurve],
    watch: &Watch,
) -> Result<Vec<Option<ListedRadius>>, Error> {
    extent::check_box(mesh_core::bounds(mesh))?;
    let chain = |curve: &FeatureCurve| BlendCurve { halfedges: curve.halfedges.clone(), closed: curve.closed };
    let width = |curve: &FeatureCurve| {
        watch.step("radii", 0.0)?;
        Ok(blend::listed_radius(mesh, &chain(curve), false, watch)?)
    };
    let widths = curves.par_iter().map(width).collect::<Result<Vec<Option<ListedRadius>>, Error>>()?;
    let mut cost = Cost::default();
    let due: Vec<bool> = curves.iter().zip(&widths).map(|(curve, width)| cost.allows(mesh, curve, *width)).collect();
    let limit = |((curve, width), &due): ((&FeatureCurve, &Option<ListedRadius>), &bool)| {
        watch.step("radii", 0.0)?;
        if due { Ok(blend::listed_radius(mesh, &chain(curve), true, watch)?) } else { Ok(*width) }
    };
    curves.par_iter().zip(&widths).zip(&due).map(limit).collect()
}

/// Most edges of a curve for which blends are tried in a list, and of all its curves.
const LONGEST: usize = 40;
const ALL: usize = 400;
/// So many faces of a mesh cost as much as one edge of a curve.
const FACES: usize = 2000;
/// The same in steps of the ball, each as long as its largest radius: between sides that are slivers it takes thousands.
const MOST_STEPS: f64 = 200.0;
const ALL_STEPS: f64 = 2000.0;

/// What the curves of a list have cost so far.
#[derive(Default)]
struct Cost {
    edges: usize,
    steps: f64,
}

impl Cost {
    /// Whether blends may be tried for one more curve, whose sides allow a ball of this radius.
    fn allows(&mut self, mesh: &Connected<TriMesh>, curve: &FeatureCurve, width: Option<ListedRadius>) -> bool {
        let Some(width) = width else { return false };
        // A blend costs by its edges, and by a pass over the mesh.
        let edges = curve.halfedges.len() + mesh.face_count() / FACES;
        let steps = curve.length / width.radius;
        let due = curve.halfedges.len() <= LONGEST
            && self.edges + edges <= ALL
            && steps <= MOST_STEPS
            && self.steps + steps <= ALL_STEPS;
        if due {
            self.edges += edges;
            self.steps += steps;
        }
        due
    }
}

fn round_once(part: &Model, params: &Params, how: &blend::Params, watch: &Watch) -> Result<Outcome, Error> {
    let mut report = Report::new("blend", vec![Counts::of("", &part.mesh)]);
    let mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| Error::NotManifold { part: 0, source })?;
    let (chosen, told) = report.time("features", || choose(&mesh, &params.features, &params.choice))?;
    for diagnostic in told {
        report.tell(diagnostic);
    }
    let (curves, wholes) = joined(&mesh, &chosen);
    let how = &with_own_radii(&mesh, &chosen, how);
    let parts = chosen.into_iter().zip(wholes).map(|(chosen, whole)| Part {
        source: chosen.source,
        id: chosen.id,
        radius: chosen.radius.unwrap_or(how.radius * how.radii.rest),
        halfedges: chosen.curve.halfedges,
        whole,
    });
    let parts: Vec<Part> = parts.collect();
    let blended = report.time("blend", || blend::blend(&mesh, &curves, how, watch))?;
    record(&mesh, &parts, &blended, how, &mut report);
    let promise = Promise::Openings(boundary_loops(&mesh).len());
    let inputs = Inputs { models: std::slice::from_ref(part), connected: &[&mesh] };
    finish_as(promise, inputs, blended.mesh, blended.origins, params.format, report, watch)
}

/// The radii that curves have of their own, in the ball's parameters.
fn with_own_radii(mesh: &Connected<TriMesh>, chosen: &[Chosen], how: &blend::Params) -> blend::Params {
    let own: Vec<(DVec3, f64)> =
        chosen.iter().filter_map(|c| Some((point_along(mesh, &c.curve.halfedges)?, c.radius?))).collect();
    let Some(&(_, first)) = own.first() else { return how.clone() };
    let mut how = how.clone();
    if own.len() == chosen.len() && own.iter().all(|o| o.1 == first) && how.radii.keys.is_empty() {
        // One radius for all is plain again, whatever the others would have had.
        (how.radius, how.radii.rest) = (first, 1.0);
    } else {
        (how.radius, how.radii) = how.radii.with_curves(how.radius, &own);
    }
    how
}

/// The chosen curves, those of one convexity and radius joined where just two meet, since nothing else sets them apart
/// there; and in which of them each chosen one is.
fn joined(mesh: &Connected<TriMesh>, chosen: &[Chosen]) -> (Vec<BlendCurve>, Vec<usize>) {
    let mut curves: Vec<BlendCurve> = chosen.iter().map(|c| c.curve.clone()).collect();
    let mut at: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    let ends =
        |c: &BlendCurve| c.halfedges.first().zip(c.halfedges.last()).map(|(&f, &l)| [mesh.tail(f), mesh.head(l)]);
    for (i, curve) in curves.iter().enumerate().filter(|(_, c)| !c.closed) {
        ends(curve).into_iter().flatten().for_each(|v| at.entry(v).or_default().push(i));
    }
    let mut taken_by: Vec<usize> = (0..curves.len()).collect();
    let follow = |taken_by: &[usize], mut i: usize| {
        while taken_by[i] != i {
            i = taken_by[i];
        }
        i
    };
    let alike = |i: usize, j: usize| (chosen[i].convexity, chosen[i].radius) == (chosen[j].convexity, chosen[j].radius);
    for (vertex, meeting) in at {
        let &[i, j] = &meeting[..] else { continue };
        // Earlier joins may have taken a curve into another.
        let (i, j) = (follow(&taken_by, i), follow(&taken_by, j));
        if !alike(i, j) {
            continue;
        }
        if i == j {
            curves[i].closed = ends(&curves[i]).is_some_and(|e| e[0] == e[1]);
            continue;
        }
        let mut first = curves[i].halfedges.clone();
        let mut second = std::mem::take(&mut curves[j].halfedges);
        if ends(&curves[i]).is_some_and(|e| e[1] != vertex) {
            first = reversed(mesh, &first);
        }
        if second.first().is_some_and(|&h| mesh.tail(h) != vertex) {
            second = reversed(mesh, &second);
        }
        first.append(&mut second);
        taken_by[j] = i;
        curves[i].halfedges = first;
    }
    // Those left keep their order.
    let mut number = vec![0; curves.len()];
    let mut count = 0;
    for (i, curve) in curves.iter().enumerate() {
        number[i] = count;
        count += usize::from(!curve.halfedges.is_empty());
    }
    let wholes = (0..curves.len()).map(|i| number[follow(&taken_by, i)]).collect();
    curves.retain(|c| !c.halfedges.is_empty());
    (curves, wholes)
}

fn reversed(mesh: &Connected<TriMesh>, chain: &[HalfedgeId]) -> Vec<HalfedgeId> {
    chain.iter().rev().filter_map(|&h| mesh.twin(h)).collect()
}
