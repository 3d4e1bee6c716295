//! `cluster`: rounds polyhedra cluster by cluster.

use crate::clustering::Cluster as Args;
use crate::failure::Failure;
use crate::output::check_writable;
use crate::session::{Destination, Session, counts, is_stream};
use crate::text_file::read_text;
use fusion::cluster::{CoverParams, Params, PatchParams, StripParams, cluster, clusters_from_toml};

/// Blends the clusters of a polyhedron and writes the result.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let destination = Destination::check(&args.target, session)?;
    let sides = [args.nets.as_ref(), args.step.as_ref()];
    for (i, file) in sides.iter().enumerate().filter_map(|(i, f)| Some((i, (*f)?))) {
        if is_stream(file) || *file == args.target.output || sides[..i].contains(&Some(file)) {
            return Err(Failure::usage("--nets and --step need files of their own"));
        }
        check_writable(file)?;
    }
    let clusters = args.clusters.as_ref().map(|path| read_text(path, clusters_from_toml)).transpose()?;
    let model = session.read(&args.input, &args.source)?;
    let strip = StripParams {
        order: args.order.unwrap_or(args.continuity),
        balance: args.mu,
        cut: args.cut,
        follow: args.follow,
    };
    let params = Params {
        clusters,
        cover: if args.singles { CoverParams { distortion: 0.0, short: 0.0 } } else { CoverParams::default() },
        patch: PatchParams {
            continuity: args.continuity,
            degree: args.degree,
            extent: args.extent,
            bulge: args.bulge,
            sharp: args.sharp.clone(),
            all_sharp: args.all_sharp,
            strip,
        },
        tolerance: args.tolerance,
        ..Params::new(destination.format)
    };
    let mut made = cluster(&model, &params, session.watch())
        .map_err(|e| Failure::of(&e, format!("{}: {e}", args.input.display())))?;
    let mut files: Vec<_> = args.nets.iter().map(|path| (path.clone(), made.nets_to_json().into_bytes())).collect();
    let report = &mut made.outcome.report;
    report.inputs = counts(std::slice::from_ref(&args.input), std::slice::from_ref(&model));
    for note in &report.notes {
        session.note(note);
    }
    if let Some(path) = &args.step {
        let (text, left_out) = made.to_step().map_err(|e| Failure::of(&e, e.to_string()))?;
        files.push((path.clone(), text.into_bytes()));
        if left_out > 0 {
            let what = format!("{left_out} S-patches have no STEP entity and are left out of {}", path.display());
            made.outcome.report.warnings.push(what);
        }
    }
    let outcome = &made.outcome;
    session.write_with(&destination, &outcome.model, Some(&outcome.origins), files, &outcome.report)
}
