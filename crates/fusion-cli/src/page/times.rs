//! How long jobs took.

use crate::batch::outcome::{Outcome, State};
use crate::page::escape::time;
use std::fmt::Write;

/// Bars of the histogram for each power of ten.
const BARS: f64 = 4.0;
const HEIGHT: f64 = 120.0;
const WIDTH: f64 = 26.0;

/// The time that a share of jobs did not exceed, of sorted times.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted.get((share * last as f64).round() as usize).copied().unwrap_or(0.0)
}

/// All times, sorted.
pub fn sorted(outcomes: &[Outcome]) -> Vec<f64> {
    let mut times: Vec<f64> = outcomes.iter().map(|o| o.milliseconds).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// A histogram over the logarithm of the time, those that are not done in another colour.
pub fn histogram(outcomes: &[Outcome]) -> String {
    let slot = |t: f64| (t.max(0.1).log10() * BARS).floor() as i64;
    let slots = outcomes.iter().map(|o| slot(o.milliseconds));
    let (Some(first), Some(last)) = (slots.clone().min(), slots.max()) else { return String::new() };
    let count = (last - first + 1) as usize;
    let mut bars = vec![[0_usize; 2]; count];
    for outcome in outcomes {
        let kind = usize::from(outcome.state != State::Done);
        bars[(slot(outcome.milliseconds) - first) as usize][kind] += 1;
    }
    let most = bars.iter().map(|b| b[0] + b[1]).max().unwrap_or(1).max(1) as f64;
    let (width, mut svg) = (WIDTH * count as f64 + 60.0, String::new());
    let view = format!("-30 -16 {width:.0} {:.0}", HEIGHT + 40.0);
    // Writing into a text cannot fail.
    let _ = write!(svg, "<svg viewBox=\"{view}\" width=\"{width:.0}\" role=\"img\" aria-label=\"Times of jobs\">");
    for (i, [done, not]) in bars.iter().enumerate() {
        let from = time(10_f64.powf((first as f64 + i as f64) / BARS));
        let to = time(10_f64.powf((first as f64 + i as f64 + 1.0) / BARS));
        let (x, good, bad) = (WIDTH * i as f64, HEIGHT * *done as f64 / most, HEIGHT * *not as f64 / most);
        let _ = write!(svg, "<g><title>{from} to {to}: {done} done, {not} not</title>");
        for (class, top, height) in [("done", HEIGHT - good, good), ("not", HEIGHT - good - bad, bad)] {
            let w = WIDTH - 3.0;
            let _ = write!(
                svg,
                "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{top:.1}\" width=\"{w}\" height=\"{height:.1}\"/>"
            );
        }
        if done + not > 0 {
            let (at, y) = (x + WIDTH / 2.0 - 1.5, HEIGHT - good - bad - 4.0);
            let _ = write!(svg, "<text x=\"{at:.1}\" y=\"{y:.1}\">{}</text>", done + not);
        }
        svg += "</g>";
    }
    let step = if count > 12 { BARS as usize } else { 2 };
    for i in (0..=count).step_by(step) {
        let label = time(10_f64.powf((first as f64 + i as f64) / BARS));
        let _ =
            write!(svg, "<text class=\"axis\" x=\"{:.1}\" y=\"{:.0}\">{label}</text>", WIDTH * i as f64, HEIGHT + 16.0);
    }
    svg + "</svg>"
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    #[test]
    fn the_bars_hold_every_job_once() {
        let outcomes: Vec<Outcome> =
            [(0.01, State::Done), (50.0, State::Done), (51.0, State::Failed), (9e6, State::Timeout)]
                .map(|(t, state)| Outcome::told("a", state, 0, t, Value::Null))
                .into();
        let svg = histogram(&outcomes);
        assert!(svg.contains(": 1 done, 1 not") && svg.contains(": 0 done, 1 not"), "{svg}");
        let held: usize = svg
            .split("<title>")
            .skip(1)
            .flat_map(|t| {
                let counts = t.split_once(": ").unwrap().1.split_once("</title>").unwrap().0;
                counts.split(", ").map(|c| c.split(' ').next().unwrap().parse::<usize>().unwrap()).collect::<Vec<_>>()
            })
            .sum();
        assert_eq!((held, histogram(&[]).as_str()), (4, ""));
        assert_eq!((quantile(&[1.0, 2.0, 3.0], 0.5), quantile(&[], 0.5)), (2.0, 0.0));
    }
}
