//! Wall-clock time, on every target.

use std::time::Duration;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use std::time::Instant;

/// Measures how long stages take.
///
/// A browser's WebAssembly has no clock that the standard library can read, and `Instant::now` panics there; on that target every
/// duration is zero, so that nothing but a report's times depends on it. Code that decides by time must not stand on this.
///
/// ```
/// let mut clock = mesh_core::Stopwatch::start();
/// let [first, second] = [clock.lap(), clock.lap()];
/// assert!(clock.elapsed() >= second && first >= std::time::Duration::ZERO);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    start: Instant,
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    lap: Instant,
}

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
impl Stopwatch {
    /// Starts now.
    #[must_use]
    pub fn start() -> Self {
        let now = Instant::now();
        Self { start: now, lap: now }
    }

    /// The time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// The time since the last lap, or since the start where there was none.
    pub fn lap(&mut self) -> Duration {
        let now = Instant::now();
        now - std::mem::replace(&mut self.lap, now)
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
impl Stopwatch {
    /// Starts now.
    #[must_use]
    pub fn start() -> Self {
        Self {}
    }

    /// Zero: this target has no clock.
    pub fn elapsed(&self) -> Duration {
        Duration::ZERO
    }

    /// Zero: this target has no clock.
    pub fn lap(&mut self) -> Duration {
        Duration::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laps_add_up_to_the_whole() {
        let mut clock = Stopwatch::start();
        std::thread::sleep(Duration::from_millis(3));
        let first = clock.lap();
        std::thread::sleep(Duration::from_millis(2));
        let second = clock.lap();
        let all = clock.elapsed();
        assert!(first >= Duration::from_millis(3) && second >= Duration::from_millis(2));
        assert!(first + second <= all && all < first + second + Duration::from_secs(5));
    }
}
