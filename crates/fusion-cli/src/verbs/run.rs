//! `run`: evaluates a document.

use crate::evaluation::{CACHE_LIMIT, cache, failure, folder, read, told, whole};
use crate::failure::Failure;
use crate::job::places;
use crate::options::Read;
use crate::session::{Destination, Session, is_stream};
use crate::shared_args::Target;
use crate::watched::{Seen, Watched, follow};
use clap::Args;
use fusion::Document;
use fusion::document::{Cache, Evaluated, Evaluation, Precisions};
use fusion::mesh_core::Watch;
use fusion::operation::Precision;
use fusion::{Outcome, look_everywhere};
use std::path::{Path, PathBuf};

/// What can be typed.
#[derive(Args)]
pub struct RunArgs {
    /// The document, a TOML file (docs/documents.md); paths in it are relative to it
    document: PathBuf,
    /// Write the only output here and not where the document says; or all outputs into this folder
    #[arg(short, long, value_name = "OUTPUT")]
    output: Option<PathBuf>,
    /// Format of the output, where its extension does not tell; needed for `-`
    #[arg(long, hide_short_help = true, value_name = "FORMAT", requires = "output")]
    to: Option<String>,
    /// Write where every vertex and face of the only output came from, as JSON
    #[arg(long, value_name = "FILE.json")]
    origins: Option<PathBuf>,
    /// Give a parameter another value, or `N.option` with N the number of a step from 1; may be given more than once
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    sets: Vec<(String, String)>,
    /// Evaluate again whenever the document or a file that it names is saved, until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// Keep the results of steps in this folder, and take from it those that are known
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Remove the oldest results while that folder takes more than this
    #[arg(long, value_name = "GB", default_value_t = CACHE_LIMIT, requires = "cache", value_parser = gigabytes)]
    cache_limit: f64,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("a value is set by NAME=VALUE, such as soft=2% or 3.radius=0.5")?;
    Ok((name.trim().into(), value.trim().into()))
}

fn gigabytes(text: &str) -> Result<f64, String> {
    let known = text.parse().ok().filter(|x: &f64| *x >= 0.0 && x.is_finite());
    known.ok_or_else(|| "a number of gigabytes is needed, such as 2.5".into())
}

/// Evaluates the document and writes its outputs, once or after every save.
pub fn run(session: &Session, args: &RunArgs) -> Result<(), Failure> {
    let cache = cache(args.cache.as_deref(), args.cache_limit);
    if args.watch {
        let evaluate = |seen: &mut Seen, watch: &Watch| once(session, args, &cache, seen, watch);
        return follow(session, &args.document, evaluate);
    }
    once(session, args, &cache, &mut Seen::default(), session.watch()).map(drop)
}

/// Notes the files that were read, and says what was done.
fn once(session: &Session, args: &RunArgs, cache: &Cache, seen: &mut Seen, watch: &Watch) -> Result<String, Failure> {
    let path = &args.document;
    let mut document = read(path, &args.sets)?;
    let targets = targets(args, &mut document)?;
    let targets = targets.iter().map(|target| Destination::check(target, session)).collect::<Result<Vec<_>, _>>()?;
    let mut made = evaluate(session, &document, path, precisions(args, &targets), cache, seen, watch)?;
    for (target, Evaluated { outcome, .. }) in targets.iter().zip(&mut made.outputs) {
        let Outcome { model, origins, report } = outcome;
        look_everywhere(model, origins, target.format, report, watch).map_err(|e| failure(path, &e))?;
    }
    let origins = made.outputs.first().zip(args.origins.as_ref());
    let side = origins.map(|(made, path)| (path.clone(), fusion::origins_to_json(&made.outcome.origins).into_bytes()));
    let meshes: Vec<_> =
        targets.iter().zip(&made.outputs).map(|(target, made)| (target, &made.outcome.model)).collect();
    let written: Vec<PathBuf> = targets.iter().map(Destination::shown).collect();
    let report = whole(&document, path, &made);
    let json = |report: &fusion::Report| format!("{:#}\n", told(report, &made, &written));
    session.write_several(&meshes, side.into_iter().collect(), &report, json)?;
    let known = made.steps.iter().filter(|step| step.is_known).count();
    Ok(format!("{} steps, {known} of them known", made.steps.len()))
}

fn evaluate(
    session: &Session,
    document: &Document,
    path: &Path,
    precisions: Precisions,
    cache: &Cache,
    seen: &mut Seen,
    watch: &Watch,
) -> Result<Evaluation, Failure> {
    let mut sources = Watched::new(Read::beside(session, folder(path)), folder(path), seen);
    document.evaluate_from(&mut sources, cache, precisions, watch).map_err(|e| failure(path, &e))
}

/// What the command line says of the outputs wins over what the document says.
fn precisions(args: &RunArgs, targets: &[Destination]) -> Precisions {
    match (&args.output, targets) {
        (Some(_), [one]) if one.format.is_lossless() => Precisions::All(Precision::F64),
        (Some(_), [_]) => Precisions::All(Precision::F32),
        _ => Precisions::ByFile,
    }
}

/// Where the outputs go.
fn targets(args: &RunArgs, document: &mut Document) -> Result<Vec<Target>, Failure> {
    let into = args.output.as_deref().filter(|output| output.is_dir());
    let several = document.outputs().len() > 1;
    if several && into.is_none() && args.output.is_some() {
        return Err(Failure::usage("-o names a file, but the document has several outputs: name a folder"));
    }
    if several && args.origins.is_some() {
        return Err(Failure::usage("--origins is for one output, and the document has several"));
    }
    let target = |output| Target { output, to: args.to.clone(), origins: args.origins.clone() };
    match &args.output {
        Some(output) if into.is_none() => {
            if document.outputs().is_empty() {
                let file = if is_stream(output) { Path::new("stream") } else { output };
                let named = document.push_output(None, file);
                named.map_err(|e| Failure::unreadable(format!("{}: {e}", args.document.display())))?;
            }
            Ok(vec![target(output.clone())])
        }
        _ => Ok(places(document, &args.document, into)?.into_iter().map(target).collect()),
    }
}
