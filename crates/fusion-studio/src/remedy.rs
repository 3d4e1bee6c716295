//! The edit that a failed step's remedy comes down to.

use crate::refusal::Refusal;
use fusion::document::Stopped;
use fusion::{Code, Diagnostic};
use serde_json::{Value, json};

/// Digits of a number on a button.
const DIGITS: i32 = 3;

/// What is wrong with a step, and a button that mends it where one value does.
pub fn refusal(stopped: &Stopped) -> Refusal {
    let told = Diagnostic::of(&stopped.error);
    let mut refusal = Refusal::of(&stopped.error);
    let number = |name: &str| told.numbers.get(name).copied();
    let set = |key: &str, value: Value| json!({ "do": "set", "table": "step", "index": stopped.step, "key": key, "value": value });
    let edit = match told.code {
        Code::RadiusTooLarge => number("workable").map(|r| {
            let r = rounded_down(r);
            (format!("use {r}"), set("radius", r.into()))
        }),
        Code::NoEdges => number("sharpest").filter(|&a| a > 1.0).map(|sharpest| {
            let angle = (sharpest - 0.1).floor();
            (format!("use an angle of {angle} degrees"), set("angle", angle.into()))
        }),
        Code::NotByKeep => Some(("let the surface be stitched".into(), set("surface", "stitch".into()))),
        _ => None,
    };
    if let Some((label, edit)) = edit {
        refusal.remedy = Some((label, Some(edit)));
    }
    refusal
}

/// A little less, with few digits.
fn rounded_down(x: f64) -> f64 {
    if !(x > 0.0 && x.is_finite()) {
        return x;
    }
    let digits = DIGITS - 1 - x.log10().floor() as i32;
    // One power of ten at a time stays exact: 3.19, and not 3.1899999999999995.
    if digits >= 0 {
        (x * 10f64.powi(digits)).floor() / 10f64.powi(digits)
    } else {
        (x / 10f64.powi(-digits)).floor() * 10f64.powi(-digits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_on_buttons_are_short_and_work() {
        for (x, short) in [(3.1987, 3.19), (0.012_345, 0.0123), (123_456.0, 123_000.0), (1.0, 1.0)] {
            assert_eq!(rounded_down(x), short);
        }
    }
}
