//! `cluster`: rounds polyhedra cluster by cluster.

use crate::failure::Failure;
use crate::options::{Read, unread, wrong};
use crate::output::check_writable;
use crate::session::{Destination, Session, counts, is_stream};
use crate::shared_args::{Source, Target};
use clap::Args;
use fusion::cluster::cluster;
use fusion::operation::{Cluster, Options};
use std::path::PathBuf;

/// What can be typed.
#[derive(Args)]
pub struct ClusterArgs {
    /// The polyhedron: polygons, or triangles whose coplanar neighbours are merged
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    cluster: Cluster,
    /// Write the control nets and strips here, as JSON
    #[arg(long, value_name = "NETS.json")]
    nets: Option<PathBuf>,
    /// Write the exact tensor-product patches and trimmed planes here, as STEP; needs --all-sharp
    #[arg(long, value_name = "FILE.step", requires = "all_sharp")]
    step: Option<PathBuf>,
}

/// Blends the clusters of a polyhedron and writes the result.
pub fn run(session: &Session, mut args: ClusterArgs) -> Result<(), Failure> {
    args.cluster.validate().map_err(|e| wrong(&e))?;
    let destination = Destination::check(&args.target, session)?;
    let sides = [args.nets.as_ref(), args.step.as_ref()];
    for (i, file) in sides.iter().enumerate().filter_map(|(i, f)| Some((i, (*f)?))) {
        if is_stream(file) || *file == args.target.output || sides[..i].contains(&Some(file)) {
            return Err(Failure::usage("--nets and --step need files of their own"));
        }
        check_writable(file)?;
    }
    args.cluster.load(&mut Read::new(session)).map_err(|e| unread(&e))?;
    let model = session.read(&args.input, &args.source)?;
    let params = args.cluster.params(destination.format).map_err(|e| wrong(&e))?;
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
