//! What every pipeline ends with: validation, description, attributes.

use crate::blend::{self, Blended};
use crate::validity::as_written;
use crate::{Error, Report, carry};
use mesh_core::{Origins, TriMesh, Watch};
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

/// Checks a result as its format will hold it, and completes the report.
pub(crate) fn finish(
    parts: &[Model],
    mesh: TriMesh,
    origins: Origins,
    format: Format,
    mut report: Report,
    watch: &Watch,
) -> Result<Outcome, Error> {
    report.describe(&mesh, &origins);
    let model = report.time("attributes", || carry(parts, mesh, &origins));
    report.validity = report.time("validate", || as_written(&model, &origins, format, watch))?;
    Ok(Outcome { model, origins, report })
}

/// Notes in the report what a blend did.
pub(crate) fn account(blended: &Blended, params: &blend::Params, report: &mut Report) {
    let worst = report.residuals.entry("contact".into()).or_default();
    *worst = worst.max(blended.residual);
    report.figures.insert("radius".into(), params.radius);
    *report.figures.entry("strips".into()).or_default() += blended.strips as f64;
    for (at, radius) in &blended.shrunk {
        report.warnings.push(format!("the ball was made smaller, to a radius of {radius}, near {at}"));
    }
}
