//! `convert`: between formats, with repair on request.

use crate::args::Convert as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts, joint_diagonal};
use fusion::{Repair, repair};

/// Reads, repairs what was asked for, and writes.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let model = session.read(&args.input, &args.source)?;
    let models = std::slice::from_ref(&model);
    let mut repairs = vec![];
    repairs.extend(args.weld.map(|tolerance| Repair::Weld(tolerance.resolve(joint_diagonal(models)))));
    repairs.extend(args.orient.then_some(Repair::Orient));
    repairs.extend(args.split.then_some(Repair::Split));
    let mut outcome = repair(&model, &repairs);
    outcome.report.inputs = counts(std::slice::from_ref(&args.input), models);
    outcome.report.warnings = model.notes.iter().map(ToString::to_string).collect();
    for (what, by) in &outcome.report.figures {
        session.note(&format!("{what} {by:+}"));
    }
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
