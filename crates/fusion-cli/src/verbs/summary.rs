//! `summary`: one page about the results of a batch.

use crate::batch::results::read_file;
use crate::failure::Failure;
use crate::output::check_writable;
use crate::page::{page, take};
use crate::session::Session;
use clap::Args;
use fusion::Report;
use std::path::{Path, PathBuf};

/// Arguments of `summary`.
#[derive(Args)]
pub struct SummaryArgs {
    /// What `batch` wrote
    #[arg(value_name = "RESULTS.jsonl")]
    pub results: PathBuf,
    /// The page, which needs nothing but itself
    #[arg(short, long, value_name = "PAGE.html")]
    pub output: PathBuf,
}

/// Writes the page.
pub fn run(session: &Session, args: &SummaryArgs) -> Result<(), Failure> {
    check_writable(&args.output)?;
    let outcomes = read_file(&args.results)?;
    let folder = args.results.parent().unwrap_or(Path::new(""));
    let mut report = Report::new("summary", vec![]);
    report.figures.insert("jobs".into(), outcomes.len() as f64);
    let pictures = report.time("pictures", || take(session, &outcomes, folder))?;
    let title = args.results.file_name().unwrap_or_default().to_string_lossy();
    let html = page(&format!("Results of {title}"), &outcomes, &pictures);
    session.write_files(vec![(args.output.clone(), html.into_bytes())], &report)
}
