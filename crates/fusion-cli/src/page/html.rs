//! The whole page.

use crate::batch::outcome::{Outcome, State};
use crate::page::escape::{escape, time};
use crate::page::failures::failures;
use crate::page::grid::grid;
use crate::page::pictures::Pictures;
use crate::page::table::table;
use crate::page::times::{histogram, quantile, sorted};

const STYLE: &str = include_str!("style.css");
const SORT: &str = include_str!("sort.js");

/// The page about all outcomes.
pub fn page(title: &str, outcomes: &[Outcome], pictures: &Pictures) -> String {
    let title = escape(title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\
         <meta name=\"viewport\" content=\"width=device-width\"><style>\n{STYLE}</style></head><body>\
         <h1>{title}</h1>{}",
        tiles(outcomes)
    );
    let mut section = |heading: &str, body: String| {
        if !body.is_empty() {
            html += &format!("<h2>{heading}</h2>{body}\n");
        }
    };
    section("Times", histogram(outcomes));
    let output = |id: &str| pictures.outputs.get(id).cloned();
    let grid = grid(outcomes, output);
    let gallery = if grid.is_some() { String::new() } else { gallery(pictures) };
    section("Two parameters", grid.unwrap_or_default());
    section("Failures by reason", failures(outcomes, |id| pictures.places.get(id).cloned()));
    section("Some results", gallery);
    section("All jobs", table(outcomes));
    html + &format!("<script>\n{SORT}</script></body></html>\n")
}

/// Counts, rates and times.
fn tiles(outcomes: &[Outcome]) -> String {
    let count = |state| outcomes.iter().filter(|o| o.state == state).count();
    let all = outcomes.len();
    let share = |n: usize| if all == 0 { String::new() } else { format!("{:.1} %", 100.0 * n as f64 / all as f64) };
    let times = sorted(outcomes);
    let spent: f64 = times.iter().sum();
    let rate = if spent > 0.0 { 1e3 * all as f64 / spent } else { 0.0 };
    let mut tiles = vec![("jobs", all.to_string(), String::new())];
    for state in [State::Done, State::Failed, State::Crashed, State::Timeout, State::Memory] {
        tiles.push((state.name(), count(state).to_string(), share(count(state))));
    }
    tiles.push(("median", time(quantile(&times, 0.5)), format!("90 % within {}", time(quantile(&times, 0.9)))));
    tiles.push(("slowest", time(quantile(&times, 1.0)), format!("{} in all", time(spent))));
    tiles.push(("rate", format!("{rate:.2}"), "jobs a second and worker".into()));
    let tile = |(name, value, more): (&str, String, String)| {
        format!("<div class=\"tile {name}\"><small>{name}</small><b>{value}</b><small>{more}</small></div>")
    };
    format!("<div class=\"tiles\">{}</div>", tiles.into_iter().map(tile).collect::<String>())
}

fn gallery(pictures: &Pictures) -> String {
    let figure = |(id, source): (&String, &String)| {
        let id = escape(id);
        format!("<figure><img src=\"{source}\" alt=\"{id}\"><figcaption>{id}</figcaption></figure>")
    };
    let figures: String = pictures.outputs.iter().map(figure).collect();
    if figures.is_empty() { figures } else { format!("<div class=\"gallery\">{figures}</div>") }
}
