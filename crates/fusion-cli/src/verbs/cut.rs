//! `cut`: takes away what lies beyond a plane or a path over the surface.

use crate::cutting::{Cut as Args, Keep as Side};
use crate::failure::Failure;
use crate::session::{Destination, Session, counts};
use fusion::cut::{Cut, Keep, Params, PathCut, PlaneCut, cut};

/// Cuts the input and writes what stays.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let model = session.read(&args.input, &args.source)?;
    let params = Params::new(vec![how(args)], destination.format);
    let mut outcome =
        cut(&model, &params, session.watch()).map_err(|e| Failure::of_files(&e, std::slice::from_ref(&args.input)))?;
    outcome.report.inputs = counts(std::slice::from_ref(&args.input), std::slice::from_ref(&model));
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}

fn how(args: &Args) -> Cut {
    let smooth = usize::from(args.smooth);
    if let Some((point, normal)) = args.plane {
        let made = PlaneCut::new(point, normal);
        return PlaneCut { seed: args.seed, snap: args.snap.unwrap_or(made.snap), smooth, ..made }.into();
    }
    let made = PathCut::new(args.path.clone());
    let keep = match (args.seed, args.keep) {
        (Some(seed), _) => Keep::Near(seed),
        (None, Side::Larger) => Keep::Larger,
        (None, Side::Smaller) => Keep::Smaller,
    };
    PathCut { keep, crease: args.crease, snap: args.snap.unwrap_or(made.snap), smooth, ..made }.into()
}
