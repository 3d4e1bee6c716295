//! Numbers as they are typed: angles and times.

use std::time::Duration;

/// A time in seconds, above zero.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let limit = text.parse().ok().filter(|&s: &f64| s > 0.0).and_then(|s| Duration::try_from_secs_f64(s).ok());
    limit.ok_or_else(|| "a time is a number of seconds above zero".into())
}

/// An angle in degrees, in (0, 180).
pub fn angle(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(a) if a > 0.0 && a < 180.0 => Ok(a),
        _ => Err("an angle is a number of degrees between 0 and 180".into()),
    }
}
