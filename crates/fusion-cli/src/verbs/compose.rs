//! `compose`: joins openings by a smooth surface.

use crate::failure::{Failure, with_files};
use crate::options::{Read, unread, wrong};
use crate::session::{Destination, Session, counts, joint_diagonal};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::compose::compose;
use fusion::detail;
use fusion::operation::{Compose, Detail, Options, RegionOf};
use mesh_io::Format;
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct ComposeArgs {
    /// The open parts, as they are posed in their files
    #[arg(required = true, value_name = "MESH")]
    inputs: Vec<PathBuf>,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    compose: Compose,
    /// Give the surface the geometry detail of a region of a part: MESH:REGION, counted from 0; may be given more than once
    #[arg(long = "detail", value_name = "MESH:REGION", allow_hyphen_values = true)]
    details: Vec<RegionOf>,
}

/// Composes the inputs and writes the result.
pub fn run(session: &Session, args: &ComposeArgs) -> Result<(), Failure> {
    args.compose.numbered(1.0, Format::Obj).map_err(|e| wrong(&e))?;
    let mut detail = Detail::default().with_source(args.details.clone());
    for region in &detail.source {
        let part: Option<usize> = region.part.as_ref().and_then(|part| part.parse().ok());
        if part.is_none_or(|part| part >= args.inputs.len()) {
            return Err(Failure::usage("--detail: a region of a part is MESH:REGION, such as 0:near=0,0,0,2%"));
        }
    }
    let destination = Destination::check(&args.target, session)?;
    detail.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let models = session.read_all(&args.inputs, &args.source)?;
    let diagonal = joint_diagonal(&models);
    let params = args.compose.numbered(diagonal, destination.format).map_err(|e| wrong(&e))?;
    let mut outcome = compose(&models, &params, session.watch()).map_err(|e| Failure::of_files(&e, &args.inputs))?;
    if !detail.source.is_empty() {
        let params = detail.params(diagonal, destination.format, part_number).map_err(|e| wrong(&e))?;
        outcome = detail::onto(outcome, &models, &params, session.watch())
            .map_err(|e| Failure::of_files(&e, &args.inputs))?;
    }
    outcome.report.inputs = counts(&args.inputs, &models);
    for warning in &mut outcome.report.warnings {
        *warning = with_files(warning, &args.inputs);
    }
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

/// The number of a part in the place of its name.
fn part_number(part: Option<&str>) -> usize {
    part.and_then(|part| part.parse().ok()).unwrap_or(0)
}
