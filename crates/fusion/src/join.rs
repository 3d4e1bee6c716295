//! Joins solids, and blends the seams where asked: from the contents of files to what a file will hold.

use crate::outcome::{Outcome, account, finish, surviving};
use crate::{Counts, Error, Invalid, Report, blend, extent};
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
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
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
    for (part, solid) in (1..).zip(solids) {
        let step = (parts.len() > 2).then_some(part);
        let cut = overlay(&whole, &solid, step, params, &mut report, watch)?;
        let origins = cut.origins.compose(&[whole.stage(), solid.stage()], &first);
        whole = Solid::new(cut.mesh, origins)?;
        if let Some(blend) = blend {
            let curves = cut.seams.iter().map(|s| BlendCurve::from_vertices(&whole.mesh, &s.vertices));
            whole = round(&whole, &curves.collect::<Result<Vec<_>, _>>()?, blend, &first, &mut report, watch)?;
        }
    }
    finish(parts, whole.mesh.into_mesh(), whole.origins, params.format, report, watch)
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
        report.warnings.push("the surfaces do not cross: the solids are apart, or one holds the other".into());
    }
    report.warnings.extend(cut.report.warnings.iter().map(sentence));
    Ok(cut)
}

fn round(
    whole: &Solid,
    curves: &[BlendCurve],
    params: &blend::Params,
    first: &[&dyn Faces],
    report: &mut Report,
    watch: &Watch,
) -> Result<Solid, Error> {
    if curves.is_empty() {
        return Ok(Solid { mesh: whole.mesh.clone(), origins: whole.origins.clone() });
    }
    let blended = report.time("blend", || blend::blend(&whole.mesh, curves, params, watch))?;
    account(&blended, params, report);
    let origins = blended.origins.compose(&[whole.stage()], first);
    Ok(Solid::new(blended.mesh, origins)?)
}

fn sentence(warning: &Warning) -> String {
    match *warning {
        Warning::Coplanar { pairs, at } => {
            format!("{pairs} pairs of faces lie in one plane and overlap, first at {at}")
        }
        Warning::Contact { vertices, at } => {
            format!(
                "the solids touch without overlapping at {vertices} vertices, first at {at}; each sheet got its own"
            )
        }
        Warning::Merged { points, at } => {
            format!("{points} points that 64-bit coordinates cannot tell apart were merged, first at {at}")
        }
        Warning::Collapsed { edges } => format!("{edges} short edges along the seam were collapsed"),
    }
}
