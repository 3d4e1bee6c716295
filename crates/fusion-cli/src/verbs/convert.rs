//! `convert`: between formats, with repair on request.

use crate::args::Convert as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::repair::{Step, apply_steps};

/// Reads, repairs what was asked for, and writes.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let model = session.read(&args.input, &args.source)?;
    let models = std::slice::from_ref(&model);
    let mut steps = vec![];
    steps.extend(args.weld.map(|tolerance| Step::Weld(tolerance.resolve(joint_diagonal(models)))));
    steps.extend(args.orient.then_some(Step::Orient));
    steps.extend(args.split.then_some(Step::Split));
    let outcome = apply_steps(&model, &steps, session.watch());
    let mut outcome = outcome.map_err(|e| Failure::of_files(&e, std::slice::from_ref(&args.input)))?;
    outcome.report.inputs = counts(std::slice::from_ref(&args.input), models);
    outcome.report.warnings = model.notes.iter().map(ToString::to_string).collect();
    for (what, by) in &outcome.report.figures {
        session.note(&format!("{what} {by:+}"));
    }
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
