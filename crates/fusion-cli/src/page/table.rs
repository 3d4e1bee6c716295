//! All jobs in a table that a click on a column sorts.

use crate::batch::outcome::{Outcome, State};
use crate::page::escape::{escape, value};
use crate::page::grid::varied;

/// Most rows, and most columns of parameters: a browser has to hold them.
const ROWS: usize = 20_000;
const PARAMETERS: usize = 8;

/// The table: what is not done comes first, then the slowest.
pub fn table(outcomes: &[Outcome]) -> String {
    let mut order: Vec<&Outcome> = outcomes.iter().collect();
    order.sort_by(|a, b| {
        let done = |o: &Outcome| o.state == State::Done;
        done(a).cmp(&done(b)).then(b.milliseconds.total_cmp(&a.milliseconds)).then_with(|| a.id.cmp(&b.id))
    });
    let names: Vec<String> = varied(outcomes).into_iter().map(|(name, _)| name).take(PARAMETERS).collect();
    let heads = ["job", "state", "code", "ms"].into_iter().chain(names.iter().map(String::as_str));
    let heads = heads.chain(["files", "kB", "hash", "said"]);
    let heads: String = heads.map(|h| format!("<th><button>{}</button></th>", escape(h))).collect();
    let mut html = String::new();
    if order.len() > ROWS {
        html += &format!("<p>The first {ROWS} of {} rows: what is not done, then the slowest.</p>", order.len());
    }
    html += &format!("<div class=\"wide\"><table class=\"jobs\"><thead><tr>{heads}</tr></thead><tbody>");
    for job in order.into_iter().take(ROWS) {
        html += &row(job, &names);
    }
    html + "</tbody></table></div>"
}

fn row(job: &Outcome, names: &[String]) -> String {
    let state = job.state.name();
    let bytes: u64 = job.outputs.iter().map(|o| o.bytes).sum();
    let number = |text: String| format!("<td class=\"n\">{text}</td>");
    let mut html = format!("<tr><td>{}</td><td class=\"{state}\">{state}</td>", escape(&job.id));
    html += &(number(job.code.to_string()) + &number(format!("{:.1}", job.milliseconds)));
    for name in names {
        html += &number(job.parameters.get(name).map_or_else(String::new, |v| escape(&value(v))));
    }
    html += &(number(job.outputs.len().to_string()) + &number(format!("{:.1}", bytes as f64 / 1e3)));
    let hash: String = job.outputs.first().map_or("", |o| &o.blake3).chars().take(8).collect();
    let warning = job.diagnostics.iter().find(|d| d["severity"] == "warning").and_then(|d| d["message"].as_str());
    let said = if job.state == State::Done { warning.unwrap_or_default() } else { job.sentence() };
    html + &format!("<td><code>{}</code></td><td class=\"said\">{}</td></tr>\n", escape(&hash), escape(said))
}
