//! Rate, time left, and failures so far: a bar on a terminal, lines elsewhere.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Where there is no terminal, a line is printed this often.
const LINES: Duration = Duration::from_secs(5);

/// The progress of a batch.
pub struct Meter {
    bar: ProgressBar,
    /// Whether lines are to be printed.
    lines: bool,
    start: Instant,
    told: Instant,
    done: usize,
    failed: usize,
    total: usize,
}

impl Meter {
    /// Nothing done of `total`, and nothing shown unless `wanted`.
    pub fn start(total: usize, wanted: bool) -> Self {
        let terminal = std::io::stderr().is_terminal();
        let target = if wanted && terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(total as u64), target);
        let style = "{bar:30} {pos}/{len} jobs, {per_sec}, {eta} left{msg}";
        bar.set_style(ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar()));
        bar.enable_steady_tick(Duration::from_millis(500));
        let now = Instant::now();
        Self { bar, lines: wanted && !terminal, start: now, told: now, done: 0, failed: 0, total }
    }

    /// One job has ended.
    pub fn step(&mut self, has_failed: Step) {
        self.done += 1;
        if has_failed == Step::Failed {
            self.failed += 1;
            self.bar.set_message(format!(", {} failed", self.failed));
        }
        self.bar.inc(1);
        if self.lines && self.told.elapsed() >= LINES {
            self.told = Instant::now();
            // A closed standard error is no reason to stop.
            let _ = writeln!(std::io::stderr(), "{}", self.line(self.start.elapsed().as_secs_f64()));
        }
    }

    fn line(&self, seconds: f64) -> String {
        let Self { done, failed, total, .. } = *self;
        let rate = done as f64 / seconds.max(1e-3);
        let left = total.saturating_sub(done) as f64 / rate.max(1e-9);
        let share = 100.0 * done as f64 / total.max(1) as f64;
        format!("{done} of {total} jobs, {rate:.1} a second, {left:.0} s left, {failed} failed: {share:.0} %")
    }
}

/// How a job has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// With outputs.
    Done,
    /// Without.
    Failed,
}

impl Drop for Meter {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_and_time_left_follow_from_what_is_done() {
        let mut meter = Meter::start(12, false);
        for step in [Step::Done, Step::Failed, Step::Done] {
            meter.step(step);
        }
        assert_eq!(meter.line(1.5), "3 of 12 jobs, 2.0 a second, 4 s left, 1 failed: 25 %");
    }
}
