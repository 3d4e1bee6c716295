//! Joins solids, and blends the seams where asked: from the contents of files to what a file will hold.

use crate::choice::{FAR, Near, Source};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::features::nearest;
use crate::metrics::{Part, record};
use crate::outcome::{Outcome, finish, surviving};
use crate::{Counts, Error, Invalid, Report, blend, choice, extent};
use blend::Limit;
use glam::DVec3;
use mesh_core::{Connected, Faces, Origins, Stage, TriMesh, Watch};
use mesh_io::{Format, Model};
use spine::BlendCurve;
use std::ops::Range;
use std::sync::OnceLock;
use tri_intersect::{Boolean, Contact, Operation, Warning, boolean};

/// What to do with the parts.
#[derive(Clone, Debug)]
pub struct Params {
    /// Which points the result holds.
    pub operation: Operation,
    /// How each seam is blended; `None` leaves it sharp.
    pub blend: Option<blend::Params>,
    /// Which seams are blended.
    pub seams: SeamChoice,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

/// Which seams are blended: all that pass every filter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeamChoice {
    /// Only the seams nearest to these points, where there are any.
    pub near: Vec<DVec3>,
    /// Only seams longer than this, in model units.
    pub longer: Option<f64>,
}

impl SeamChoice {
    fn is_all(&self) -> bool {
        self.near.is_empty() && self.longer.is_none()
    }
}

/// Joins `parts` in order; each seam is blended before the next part is joined.
///
/// # Errors
/// [`Error`]; a radius that does not fit comes with a place and a radius that does.
pub fn join(parts: &[Model], params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    // The boolean is looked at again only where its blend does not survive rounding.
    let first = OnceLock::new();
    join_from(parts, params, params.blend.is_some().then_some(&first), watch)
}

/// The same, with the first two parts as they were joined before, or kept for the next time where there is a place for that: it depends
/// on them and the operation alone, and not on the radius.
pub(crate) fn join_from(
    parts: &[Model],
    params: &Params,
    first: Option<&OnceLock<First>>,
    watch: &Watch,
) -> Result<Outcome, Error> {
    if params.blend.is_some() {
        extent::check(parts)?;
    }
    surviving(params.blend.as_ref(), |blend| overlay_all(parts, params, blend, first, watch))
}

fn overlay_all(
    parts: &[Model],
    params: &Params,
    blend: Option<&blend::Params>,
    known: Option<&OnceLock<First>>,
    watch: &Watch,
) -> Result<Outcome, Error> {
    let faces: Vec<&dyn Faces> = parts.iter().map(|m| &m.mesh as &dyn Faces).collect();
    let mut report = Report::new("join", parts.iter().map(|m| Counts::of("", &m.mesh)).collect());
    let first = joined_first(parts, params, known, &mut report, watch)?;
    let taken = if blend.is_some() && !params.seams.is_all() {
        Some(choose_seams(parts, params, &first, watch)?)
    } else {
        None
    };
    // Seams that come out otherwise beside a blended one are all taken.
    let chosen = |id: usize| taken.as_ref().is_none_or(|t| t.ids.get(&id).copied().unwrap_or(id >= t.count));
    let blended = |whole: Solid, numbers: Range<usize>, curves: Vec<BlendCurve>, report: &mut Report| {
        let Some(blend) = blend else { return Ok(whole) };
        let (ids, curves): (Vec<usize>, Vec<_>) = numbers.zip(curves).filter(|(id, _)| chosen(*id)).unzip();
        if curves.is_empty() { Ok(whole) } else { round(&whole, ids, curves, blend, &faces, report, watch) }
    };
    let mut count = first.curves.len();
    let mut whole = blended(first.whole, 0..count, first.curves, &mut report)?;
    let rest = report.time("connect", || connect(parts, 2))?;
    for (part, solid) in (2..).zip(rest) {
        let cut = overlay(&whole, &solid, Some(part), params, &mut report, watch)?;
        let origins = cut.origins.compose(&[whole.stage(), solid.stage()], &faces);
        let numbers = count..count + cut.seams.len();
        count = numbers.end;
        whole = Solid::new(cut.mesh, origins)?;
        let curves = curves(&whole, &cut.seams)?;
        whole = blended(whole, numbers, curves, &mut report)?;
    }
    if let Some(taken) = taken {
        for diagnostic in taken.told {
            report.tell(diagnostic);
        }
    }
    finish(parts, whole.mesh.into_mesh(), whole.origins, params.format, report, watch)
}

/// The first two parts joined, before their seams are blended.
#[derive(Clone, Debug)]
pub(crate) struct First {
    whole: Solid,
    curves: Vec<BlendCurve>,
    /// What there is to tell of it.
    told: Vec<Diagnostic>,
}

/// What is known of the first two parts, or made now; the report tells the same.
fn joined_first(
    parts: &[Model],
    params: &Params,
    known: Option<&OnceLock<First>>,
    report: &mut Report,
    watch: &Watch,
) -> Result<First, Error> {
    if let Some(first) = known.and_then(OnceLock::get) {
        // The stages are those of every join; these take no time now.
        report.time("connect", || ());
        report.time("boolean", || ());
        *report.figures.entry("seams".into()).or_default() += first.curves.len() as f64;
        first.told.iter().for_each(|told| report.tell(told.clone()));
        return Ok(first.clone());
    }
    let two = parts.get(..2).ok_or(Error::TooFew(parts.len()))?;
    let mut solids = report.time("connect", || connect(two, 0))?.into_iter();
    let (Some(one), Some(other)) = (solids.next(), solids.next()) else { return Err(Error::TooFew(parts.len())) };
    let before = report.diagnostics.len();
    let cut = overlay(&one, &other, (parts.len() > 2).then_some(1), params, report, watch)?;
    let told = report.diagnostics[before..].to_vec();
    let faces: Vec<&dyn Faces> = two.iter().map(|m| &m.mesh as &dyn Faces).collect();
    let origins = cut.origins.compose(&[one.stage(), other.stage()], &faces);
    let whole = Solid::new(cut.mesh, origins)?;
    let curves = curves(&whole, &cut.seams)?;
    let first = First { whole, curves, told };
    if let Some(known) = known {
        // Another thread may have been faster, with the same.
        let _ = known.set(first.clone());
    }
    Ok(first)
}

fn curves(whole: &Solid, seams: &[tri_intersect::Seam]) -> Result<Vec<BlendCurve>, Error> {
    let of = |s: &tri_intersect::Seam| BlendCurve::from_vertices(&whole.mesh, &s.vertices);
    Ok(seams.iter().map(of).collect::<Result<Vec<_>, _>>()?)
}

/// The seams that a choice names.
struct Taken {
    /// Whether each is blended, by its number over all steps.
    ids: std::collections::BTreeMap<usize, bool>,
    count: usize,
    told: Vec<Diagnostic>,
}

/// Joins the parts without blending them, step by step, and hands each step's solid and its seams to `look`.
fn plain_steps(
    parts: &[Model],
    params: &Params,
    first: &First,
    watch: &Watch,
    mut look: impl FnMut(&Solid, Vec<BlendCurve>) -> Result<(), Error>,
) -> Result<(), Error> {
    look(&first.whole, first.curves.clone())?;
    let mut unused = Report::default();
    let mut later: Option<Solid> = None;
    for (part, solid) in (2..).zip(connect(parts, 2)?) {
        let cut = overlay(later.as_ref().unwrap_or(&first.whole), &solid, Some(part), params, &mut unused, watch)?;
        let whole = later.insert(Solid::new(cut.mesh, cut.origins)?);
        look(whole, curves(whole, &cut.seams)?)?;
    }
    Ok(())
}

/// Looks at the seams of plain booleans, since a place may be nearest to one of a later step.
fn choose_seams(parts: &[Model], params: &Params, first: &First, watch: &Watch) -> Result<Taken, Error> {
    let near: Vec<Near> = params.seams.near.iter().map(|&p| p.into()).collect();
    let mut best: Vec<Option<(usize, DVec3, f64)>> = vec![None; near.len()];
    let mut lengths = vec![];
    plain_steps(parts, params, first, watch, |whole, curves| {
        for (best, near) in best.iter_mut().zip(&near) {
            let found = nearest(&whole.mesh, curves.iter().map(|c| &c.halfedges[..]), near.at);
            let found = found.map(|(i, place, distance)| (lengths.len() + i, place, distance));
            *best = [*best, found].into_iter().flatten().min_by(|a, b| a.2.total_cmp(&b.2));
        }
        lengths.extend(curves.iter().map(|c| c.length(&whole.mesh)));
        Ok(())
    })?;
    let named = |id: usize| near.is_empty() || best.iter().flatten().any(|b| b.0 == id);
    let passes = |id: usize| named(id) && params.seams.longer.is_none_or(|least| lengths[id] > least);
    let ids = (0..lengths.len()).map(|id| (id, passes(id))).collect();
    if !lengths.is_empty() && (0..lengths.len()).all(|id| !passes(id)) {
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        return Err(choice::Refusal::NothingPasses { count: lengths.len(), longest }.into());
    }
    let size =
        parts.iter().map(|m| mesh_core::bounds(&m.mesh)).fold(mesh_core::Bounds::EMPTY, mesh_core::Bounds::union);
    let tell = |(near, best): (&Near, &Option<(usize, DVec3, f64)>)| {
        let (id, place, distance) = (*best)?;
        Some(Diagnostic::curve_taken(near.at, "seam", id, place, distance, FAR * size.diagonal()))
    };
    let told = near.iter().zip(&best).filter_map(tell).collect();
    Ok(Taken { ids, count: lengths.len(), told })
}

/// The largest radius at which the chosen seams can be blended without making the ball smaller anywhere, and what is in the
/// way of a larger one: the least over all steps, on plain booleans.
///
/// # Errors
/// As [`join`]; [`Error::Blend`] if no radius works or there is no seam.
pub fn max_radius(parts: &[Model], params: &Params, watch: &Watch) -> Result<Limit, Error> {
    extent::check(parts)?;
    let first = joined_first(parts, params, None, &mut Report::default(), watch)?;
    let taken = choose_seams(parts, params, &first, watch)?;
    let how = params.blend.clone().unwrap_or_else(|| blend::Params::new(1.0));
    let mut least: Option<Limit> = None;
    let mut count = 0;
    plain_steps(parts, params, &first, watch, |whole, curves| {
        let numbers = count..count + curves.len();
        count = numbers.end;
        let chosen = numbers.zip(curves).filter(|(id, _)| taken.ids.get(id) == Some(&true));
        let curves: Vec<BlendCurve> = chosen.map(|(_, c)| c).collect();
        if !curves.is_empty() {
            let found = blend::max_radius(&whole.mesh, &curves, &how, watch)?;
            if least.as_ref().is_none_or(|l| found.radius < l.radius) {
                least = Some(found);
            }
        }
        Ok(())
    })?;
    least.ok_or(Error::Blend(blend::Error::NoCurves))
}

/// A mesh on its way, and its origins in the inputs.
#[derive(Clone, Debug)]
struct Solid {
    mesh: Connected<TriMesh>,
    origins: Origins,
}

impl Solid {
    fn new(mesh: TriMesh, origins: Origins) -> Result<Self, Invalid> {
        Ok(Self { mesh: Connected::new(mesh).map_err(Invalid::from)?, origins })
    }

    fn stage(&self) -> Stage<'_> {
        Stage { origins: &self.origins, faces: &self.mesh }
    }
}

/// The parts from the one with this number on.
fn connect(parts: &[Model], from: usize) -> Result<Vec<Solid>, Error> {
    let connect = |(part, model): (usize, &Model)| {
        let mesh = &model.mesh;
        let origins = Origins::identity(part as u32, mesh.positions.len(), mesh.faces.len());
        let mesh = Connected::new(mesh.clone()).map_err(|source| Error::NotManifold { part, source })?;
        Ok(Solid { mesh, origins })
    };
    parts.iter().enumerate().skip(from).map(connect).collect()
}

fn overlay(
    whole: &Solid,
    solid: &Solid,
    step: Option<usize>,
    params: &Params,
    report: &mut Report,
    watch: &Watch,
) -> Result<Boolean, Error> {
    // Sheets that touch without crossing would be self-intersections of the file.
    let how = tri_intersect::Params { contact: Contact::Refuse, ..tri_intersect::Params::default() };
    let cut = report
        .time("boolean", || boolean(&whole.mesh, &solid.mesh, params.operation, &how, watch))
        .map_err(|source| Error::Boolean { step, source })?;
    *report.figures.entry("seams".into()).or_default() += cut.seams.len() as f64;
    if cut.seams.is_empty() {
        let message = "the surfaces do not cross: the solids are apart, or one holds the other";
        report.tell(Diagnostic::new(Code::Apart, Severity::Warning, message));
    }
    for warning in &cut.report.warnings {
        report.tell(told(warning));
    }
    Ok(cut)
}

fn round(
    whole: &Solid,
    ids: Vec<usize>,
    curves: Vec<BlendCurve>,
    params: &blend::Params,
    first: &[&dyn Faces],
    report: &mut Report,
    watch: &Watch,
) -> Result<Solid, Error> {
    let blended = report.time("blend", || blend::blend(&whole.mesh, &curves, params, watch))?;
    let radius = params.radius * params.radii.rest;
    let part = |(whole, (id, curve)): (usize, (usize, BlendCurve))| Part {
        source: Source::Seam,
        id,
        halfedges: curve.halfedges,
        whole,
        radius,
    };
    let parts: Vec<Part> = ids.into_iter().zip(curves).enumerate().map(part).collect();
    record(&whole.mesh, &parts, &blended, params, report);
    let origins = blended.origins.compose(&[whole.stage()], first);
    Ok(Solid::new(blended.mesh, origins)?)
}

fn told(warning: &Warning) -> Diagnostic {
    let other = |message| Diagnostic::new(Code::Other, Severity::Warning, message);
    match *warning {
        Warning::Coplanar { pairs, at } => {
            other(format!("{pairs} pairs of faces lie in one plane and overlap, first at {at}")).at(at)
        }
        Warning::Contact { vertices, at } => other(format!(
            "the solids touch without overlapping at {vertices} vertices, first at {at}; each sheet got its own"
        ))
        .at(at),
        Warning::Merged { points, at } => {
            other(format!("{points} points that 64-bit coordinates cannot tell apart were merged, first at {at}"))
                .at(at)
        }
        Warning::Collapsed { edges } => other(format!("{edges} short edges along the seam were collapsed")),
    }
}
