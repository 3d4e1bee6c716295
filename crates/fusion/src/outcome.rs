//! What every pipeline ends with: validation, description, attributes.

use crate::blend::{self, Blended};
use crate::validity::as_written;
use crate::{Error, Invalid, Report, carry};
use mesh_core::{Connected, Origins, TriMesh, Watch};
use mesh_io::{Format, Model};

/// A result, validated in the coordinates that its format holds.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The mesh, with the attributes that survive.
    pub model: Model,
    /// Where everything came from; part i is input i.
    pub origins: Origins,
    /// What was done.
    pub report: Report,
}

/// What a result is promised to be, beside free of self-intersections in what was changed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Promise {
    /// Oriented and 2-manifold, with this many boundary loops: closed if none.
    Openings(usize),
    /// Oriented and 2-manifold.
    Manifold,
}

/// What a result was made from.
#[derive(Clone, Copy)]
pub(crate) struct Inputs<'a> {
    pub models: &'a [Model],
    /// Their meshes, if they are still connected: what is whole of them need not be connected again.
    pub connected: &'a [&'a Connected<TriMesh>],
}

impl<'a> From<&'a [Model]> for Inputs<'a> {
    fn from(models: &'a [Model]) -> Self {
        Self { models, connected: &[] }
    }
}

/// Checks a closed result as its format will hold it, and completes the report.
pub(crate) fn finish(
    parts: &[Model],
    mesh: TriMesh,
    origins: Origins,
    format: Format,
    report: Report,
    watch: &Watch,
) -> Result<Outcome, Error> {
    finish_as(Promise::Openings(0), parts, mesh, origins, format, report, watch)
}

/// Checks a result as its format will hold it, and completes the report.
pub(crate) fn finish_as<'a>(
    promise: Promise,
    inputs: impl Into<Inputs<'a>>,
    mesh: TriMesh,
    origins: Origins,
    format: Format,
    mut report: Report,
    watch: &Watch,
) -> Result<Outcome, Error> {
    let inputs = inputs.into();
    report.describe(&mesh, &origins);
    let model = report.time("attributes", || carry(inputs.models, mesh, &origins));
    let known = inputs.connected;
    report.validity = report.time("validate", || as_written(&model, &origins, known, format, promise, watch))?;
    Ok(Outcome { model, origins, report })
}

/// Does a job, and where the 32-bit coordinates of its file would fold slivers beside the blend, does it again with the
/// linkages moved farther to spare them.
pub(crate) fn surviving(
    blend: Option<&blend::Params>,
    job: impl Fn(Option<&blend::Params>) -> Result<Outcome, Error>,
) -> Result<Outcome, Error> {
    let mut result = job(blend);
    for snap in SNAPS {
        let (Some(blend), Err(Error::Invalid(Invalid { format: Some(_), .. }))) = (blend, &result) else { break };
        let coarser = blend::Params { snap, ..blend.clone() };
        result = job(Some(&coarser)).map(|mut outcome| {
            outcome.report.warnings.push(format!(
                "the linkages were moved by up to {snap} of the radius onto edges and vertices, to survive 32-bit coordinates"
            ));
            outcome
        });
    }
    result
}

/// Shares of the radius by which linkages may be moved when the first attempt does not survive rounding.
const SNAPS: [f64; 2] = [5e-3, 2e-2];

/// Notes in the report what a blend did.
pub(crate) fn account(blended: &Blended, params: &blend::Params, report: &mut Report) {
    if blended.strips > 0 {
        let worst = report.residuals.entry("contact".into()).or_default();
        *worst = worst.max(blended.residual);
    }
    report.figures.insert("radius".into(), params.radius);
    *report.figures.entry("strips".into()).or_default() += blended.strips as f64;
    *report.figures.entry("fields".into()).or_default() += blended.fields as f64;
    *report.figures.entry("bridged".into()).or_default() += blended.bridged as f64;
    *report.figures.entry("corners".into()).or_default() += blended.corners as f64;
    let smallest = blended.shrunk.iter().map(|s| s.1).fold(params.radius, f64::min);
    for (name, value) in [("full_share", blended.full_share), ("smallest_radius", smallest)] {
        let figure = report.figures.entry(name.into()).or_insert(value);
        *figure = figure.min(value);
    }
    *report.figures.entry("shrunk_places".into()).or_default() += blended.shrunk.len() as f64;
    *report.figures.entry("run_outs".into()).or_default() += blended.run_outs.len() as f64;
    if let blend::Surface::Keep(how) = &params.surface
        && how.levels > 0
    {
        report.figures.insert("levels".into(), blended.levels as f64);
        report.notes.push(match blended.levels {
            0 => "no coarser level served, so the blend was made on the mesh itself".into(),
            levels => format!(
                "the blend was made on level {levels} of a decimation hierarchy: vertices beside it that came back with their details moved with it"
            ),
        });
    }
    for at in &blended.run_outs {
        report.notes.push(format!("the blend runs out in a point at {at}, where no surface ends it"));
    }
    for (at, what) in &blended.fallbacks {
        report.warnings.push(format!("the blend near {at} is made as a field: {what}"));
    }
    // The worst first: of many, the program shows these alone.
    let mut shrunk = blended.shrunk.clone();
    shrunk.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (at, radius) in shrunk {
        let instead = if radius > 0.0 {
            format!("one of radius {radius} is used there, fading into the full one")
        } else {
            "the curve stays sharp there".into()
        };
        report.warnings.push(format!("a ball of radius {} does not fit near {at}: {instead}", params.radius));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::FaceId;

    /// Two seams blended in turn: the report holds the worst of both, and a sentence for every place.
    #[test]
    fn blends_add_up_in_the_report() {
        let blended = |full_share, shrunk: &[(DVec3, f64)]| Blended {
            mesh: TriMesh::default(),
            origins: Origins::default(),
            first_blend_face: FaceId(0),
            strips: 1,
            fields: 1,
            corners: 0,
            residual: 1e-12,
            bridged: 2,
            shrunk: shrunk.to_vec(),
            fallbacks: vec![],
            run_outs: vec![DVec3::ZERO],
            levels: 0,
            full_share,
        };
        let (params, mut report) = (blend::Params::new(0.5), Report::default());
        account(&blended(1.0, &[]), &params, &mut report);
        let figures = |report: &Report| ["full_share", "smallest_radius", "shrunk_places"].map(|f| report.figures[f]);
        assert_eq!((figures(&report), report.warnings.len()), ([1.0, 0.5, 0.0], 0));
        account(&blended(0.75, &[(DVec3::X, 0.25), (DVec3::Y, 0.35)]), &params, &mut report);
        account(&blended(0.9, &[(DVec3::Z, 0.4)]), &params, &mut report);
        assert_eq!((figures(&report), report.figures["strips"]), ([0.75, 0.25, 3.0], 3.0));
        assert_eq!((report.figures["run_outs"], report.notes.len()), (3.0, 3));
        let warnings = report.warnings.join("\n");
        assert!(["[1, 0, 0]: one of radius 0.25", "0.35", "0.4"].iter().all(|w| warnings.contains(w)), "{warnings}");
    }
}
