//! What every pipeline ends with: validation, description, attributes.

use crate::blend;
use crate::diagnostic::Diagnostic;
use crate::validity::{Promise, as_written};
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
    let found = report.time("validate", || as_written(&model, &origins, known, format, promise, watch))?;
    report.checked(found);
    Ok(Outcome { model, origins, report })
}

/// The same for a result that has its attributes already.
pub(crate) fn finish_model(
    promise: Promise,
    model: Model,
    origins: Origins,
    format: Format,
    mut report: Report,
    watch: &Watch,
) -> Result<Outcome, Error> {
    report.describe(&model.mesh, &origins);
    let found = report.time("validate", || as_written(&model, &origins, &[], format, promise, watch))?;
    report.checked(found);
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
            outcome.report.tell(Diagnostic::moved_for_rounding(snap));
            outcome
        });
    }
    result
}

/// Shares of the radius by which linkages may be moved when the first attempt does not survive rounding.
const SNAPS: [f64; 2] = [5e-3, 2e-2];
