//! Two parameters against each other.

use crate::batch::outcome::{Outcome, State};
use crate::page::escape::{escape, time, value};
use std::collections::{BTreeMap, BTreeSet};

/// Longest side of a grid that is shown.
const LONGEST: usize = 40;

/// The parameters that have more than one value, and their values: numbers in order, then texts.
pub fn varied(outcomes: &[Outcome]) -> Vec<(String, Vec<String>)> {
    let mut seen: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for (name, v) in outcomes.iter().flat_map(|o| &o.parameters) {
        seen.entry(name).or_default().insert(value(v));
    }
    let in_order = |values: BTreeSet<String>| {
        let mut values: Vec<String> = values.into_iter().collect();
        let number = |v: &String| v.trim_end_matches('%').parse::<f64>().unwrap_or(f64::INFINITY);
        values.sort_by(|a, b| number(a).total_cmp(&number(b)).then_with(|| a.cmp(b)));
        values
    };
    seen.into_iter().filter(|(_, v)| v.len() > 1).map(|(name, v)| (name.to_string(), in_order(v))).collect()
}

/// A cell for each pair of values, where exactly two parameters vary and no pair comes twice; `picture` gives one's source.
pub fn grid(outcomes: &[Outcome], picture: impl Fn(&str) -> Option<String>) -> Option<String> {
    let varied = varied(outcomes);
    let [(down, rows), (across, columns)] = varied.as_slice() else { return None };
    if rows.len().max(columns.len()) > LONGEST {
        return None;
    }
    let mut cells: BTreeMap<(String, String), &Outcome> = BTreeMap::new();
    for outcome in outcomes {
        let key = (value(outcome.parameters.get(down)?), value(outcome.parameters.get(across)?));
        if cells.insert(key, outcome).is_some() {
            return None;
        }
    }
    let head: String = columns.iter().map(|c| format!("<th>{}</th>", escape(c))).collect();
    let mut html = format!("<table class=\"grid\"><tr><th>{} \\ {}</th>{head}</tr>", escape(down), escape(across));
    for row in rows {
        html += &format!("<tr><th>{}</th>", escape(row));
        for column in columns {
            html += &match cells.get(&(row.clone(), column.clone())) {
                None => "<td></td>".into(),
                Some(o) => {
                    let said = if o.state == State::Done { time(o.milliseconds) } else { o.reason().to_string() };
                    let image = picture(&o.id).map_or_else(String::new, |s| format!("<img src=\"{s}\" alt=\"\"><br>"));
                    let (state, hint) = (o.state.name(), escape(&format!("{}\n{}", o.id, o.sentence())));
                    format!("<td class=\"{state}\" title=\"{hint}\">{image}{}</td>", escape(&said))
                }
            };
        }
        html += "</tr>";
    }
    Some(html + "</table>")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn two_parameters_span_a_grid() {
        let job = |a: Value, b: Value| {
            let parameters = [("a".into(), a), ("b".into(), b), ("same".into(), 1.into())].into_iter().collect();
            Outcome { parameters, ..Outcome::told("x", State::Done, 0, 1.0, Value::Null) }
        };
        let jobs = [job(json!("10%"), json!(2)), job(json!("9%"), json!(2)), job(json!("9%"), json!(10))];
        assert_eq!(
            varied(&jobs),
            [("a".into(), vec!["9%".into(), "10%".into()]), ("b".into(), vec!["2".into(), "10".into()])]
        );
        let html = grid(&jobs, |_| None).unwrap();
        assert_eq!((html.matches("<td").count(), html.matches("<td></td>").count()), (4, 1));
        assert_eq!(grid(&[jobs[0].clone(), jobs[0].clone(), jobs[2].clone()], |_| None), None);
    }
}
