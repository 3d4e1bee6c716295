//! What is wrong with an option, and the checks that several options share.

use super::length::Length;
use glam::DVec3;
use std::ops::RangeInclusive;

/// An option with a value that it cannot have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option}: {reason}")]
pub struct OptionError {
    /// The option, as it is called in the operation's struct.
    pub option: &'static str,
    /// What is wrong, and what would be right.
    pub reason: String,
}

impl OptionError {
    /// An option and what is wrong with it.
    pub fn new(option: &'static str, reason: impl Into<String>) -> Self {
        Self { option, reason: reason.into() }
    }
}

/// A check of one option.
pub(super) type Check = Result<(), OptionError>;

/// Refuses what does not hold.
pub(super) fn ensure(holds: bool, option: &'static str, reason: impl FnOnce() -> String) -> Check {
    if holds { Ok(()) } else { Err(OptionError::new(option, reason())) }
}

/// Refuses a number outside its range. `what` names the number and its unit.
pub(super) fn within(number: f64, range: &RangeInclusive<f64>, option: &'static str, what: &str) -> Check {
    ensure(range.contains(&number), option, || {
        format!("{what} from {} to {}", short(*range.start()), short(*range.end()))
    })
}

/// A number without more digits than it has.
pub(super) fn short(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-3 { format!("{x:e}") } else { x.to_string() }
}

/// Refuses a length that is not above zero.
pub(super) fn positive(length: Length, option: &'static str) -> Check {
    let number = length.number();
    ensure(number > 0.0 && number.is_finite(), option, || {
        "a length is a number above 0, or a share of the diagonal such as \"2%\"".into()
    })
}

/// Refuses a point that is nowhere.
pub(super) fn finite(point: DVec3, option: &'static str) -> Check {
    ensure(point.is_finite(), option, || "a place is three finite numbers".into())
}
