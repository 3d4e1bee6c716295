//! Failures by reason, with examples.

use crate::batch::outcome::{Outcome, State};
use crate::page::escape::{escape, time};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// State, exit code, and the code of the first error.
pub type Reason = (State, i32, String);

/// Examples of each reason.
pub const EXAMPLES: usize = 3;

/// All that is not done, by state, code and reason; the most frequent first.
pub fn by_reason(outcomes: &[Outcome]) -> Vec<(Reason, Vec<&Outcome>)> {
    let mut reasons: BTreeMap<_, Vec<&Outcome>> = BTreeMap::new();
    for outcome in outcomes.iter().filter(|o| o.state != State::Done) {
        reasons.entry((outcome.state, outcome.code, outcome.reason().to_string())).or_default().push(outcome);
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, jobs)| Reverse(jobs.len()));
    reasons
}

/// A section for each reason; `picture` gives the source of a job's place.
pub fn failures(outcomes: &[Outcome], picture: impl Fn(&str) -> Option<String>) -> String {
    let mut html = String::new();
    for ((state, code, reason), jobs) in by_reason(outcomes) {
        let (state, reason) = (state.name(), escape(&reason));
        html += &format!("<details open><summary><b>{}</b> <span class=\"{state}\">{state}</span> ", jobs.len());
        html += &format!("<code>{reason}</code>, exit code {code}</summary><div class=\"cards\">");
        for job in jobs.iter().take(EXAMPLES) {
            let image = picture(&job.id).map_or_else(String::new, |s| format!("<img src=\"{s}\" alt=\"The place\">"));
            let error = job.diagnostics.iter().find(|d| d["severity"] == "error");
            let remedy = error.and_then(|d| d["remedy"].as_str()).unwrap_or_default();
            let (id, said, after) = (escape(&job.id), escape(job.sentence()), time(job.milliseconds));
            html += &format!("<div class=\"card\">{image}<p><b>{id}</b>, after {after}</p><p>{said}</p>");
            html += &format!("<p class=\"remedy\">{}</p></div>", escape(remedy));
        }
        html += "</div></details>";
    }
    html
}
