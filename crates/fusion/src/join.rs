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
    if params.blend.is_some() {
        extent::check(parts)?;
    }
    surviving(params.blend.as_ref(), |blend| overlay_all(parts, params, blend, watch))
}

fn overlay_all(
    parts: &[Model],
    params: &Params,
    blend: Option<&blend::Params>,
    watch: &Watch,
) -> Result<Outcome, Error> {
    let first: Vec<&dyn Faces> = parts.iter().map(|m| &m.mesh as &dyn Faces).collect();
    let mut report = Report::new("join", parts.iter().map(|m| Counts::of("", &m.mesh)).collect());
    let mut solids = report.time("connect", || connect(parts))?.into_iter();
    let (Some(mut whole), 2..) = (solids.next(), parts.len()) else { return Err(Error::TooFew(parts.len())) };
    let taken =
        if blend.is_some() && !params.seams.is_all() { Some(choose_seams(parts, params, watch)?) } else { None };
    let mut count = 0;
    for (part, solid) in (1..).zip(solids) {
        let step = (parts.len() > 2).then_some(part);
        let cut = overlay(&whole, &solid, step, params, &mut report, watch)?;
        let origins = cut.origins.compose(&[whole.stage(), solid.stage()], &first);
        let numbers = count..count + cut.seams.len();
        count = numbers.end;
        whole = Solid::new(cut.mesh, origins)?;
        if let Some(blend) = blend {
            let of = |s: &tri_intersect::Seam| BlendCurve::from_vertices(&whole.mesh, &s.vertices);
            let curves = cut.seams.iter().map(of).collect::<Result<Vec<_>, _>>()?;
            // Seams that come out otherwise beside a blended one are all taken.
            let chosen = |id: &usize| taken.as_ref().is_none_or(|t| t.ids.get(id).copied().unwrap_or(id >= &t.count));
            let (ids, curves) = numbers.zip(curves).filter(|(id, _)| chosen(id)).unzip();
            whole = round(&whole, ids, curves, blend, &first, &mut report, watch)?;
        }
    }
    if let Some(taken) = taken {
        for diagnostic in taken.told {
            report.tell(diagnostic);
        }
    }
    finish(parts, whole.mesh.into_mesh(), whole.origins, params.format, report, watch)
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
    watch: &Watch,
    mut look: impl FnMut(&Solid, Vec<BlendCurve>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut unused = Report::default();
    let mut solids = connect(parts)?.into_iter();
    let (Some(mut whole), 2..) = (solids.next(), parts.len()) else { return Err(Error::TooFew(parts.len())) };
    for (part, solid) in (1..).zip(solids) {
        let step = (parts.len() > 2).then_some(part);
        let cut = overlay(&whole, &solid, step, params, &mut unused, watch)?;
        whole = Solid::new(cut.mesh, cut.origins)?;
        let curves = cut.seams.iter().map(|s| BlendCurve::from_vertices(&whole.mesh, &s.vertices));
        look(&whole, curves.collect::<Result<Vec<_>, _>>()?)?;
    }
    Ok(())
}

/// Looks at the seams of plain booleans, since a place may be nearest to one of a later step.
fn choose_seams(parts: &[Model], params: &Params, watch: &Watch) -> Result<Taken, Error> {
    let near: Vec<Near> = params.seams.near.iter().map(|&p| p.into()).collect();
    let mut best: Vec<Option<(usize, DVec3, f64)>> = vec![None; near.len()];
    let mut lengths = vec![];
    plain_steps(parts, params, watch, |whole, curves| {
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
    let taken = choose_seams(parts, params, watch)?;
    let how = params.blend.clone().unwrap_or_else(|| blend::Params::new(1.0));
    let mut least: Option<Limit> = None;
    let mut count = 0;
    plain_steps(parts, params, watch, |whole, curves| {
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

fn connect(parts: &[Model]) -> Result<Vec<Solid>, Error> {
    let connect = |(part, model): (usize, &Model)| {
        let mesh = &model.mesh;
        let origins = Origins::identity(part as u32, mesh.positions.len(), mesh.faces.len());
        let mesh = Connected::new(mesh.clone()).map_err(|source| Error::NotManifold { part, source })?;
        Ok(Solid { mesh, origins })
    };
    parts.iter().enumerate().map(connect).collect()
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
    if curves.is_empty() {
        return Ok(Solid { mesh: whole.mesh.clone(), origins: whole.origins.clone() });
    }
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
