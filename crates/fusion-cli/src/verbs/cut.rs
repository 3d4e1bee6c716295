//! `cut`: takes away what lies beyond a plane.

use crate::args::Cut as Args;
use crate::failure::Failure;
use crate::session::{Destination, Session, counts};
use fusion::cut::{Params, PlaneCut, cut};

/// Cuts the input and writes what stays.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let model = session.read(&args.input, &args.source)?;
    let (point, normal) = args.plane;
    let plane = PlaneCut { seed: args.seed, snap: args.snap, ..PlaneCut::new(point, normal) };
    let params = Params::new(vec![plane], destination.format);
    let name = args.input.display();
    let mut outcome = cut(&model, &params, session.watch())
        .map_err(|e| Failure::of(&e, e.to_string().replace("part 0 ", &format!("{name} "))))?;
    outcome.report.inputs = counts(std::slice::from_ref(&args.input), std::slice::from_ref(&model));
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
