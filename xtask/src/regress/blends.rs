//! All edges of one solid blended through the library, within a time.

use fusion::blend::{self, Method};
use fusion::{Choice, Error, Report, features, round};
use mesh_core::{Stopwatch, TriMesh, Watch};
use mesh_io::{Format, Model};
use std::time::Duration;

/// What came of a blend.
pub struct Run {
    pub outcome: Result<(TriMesh, Report), Error>,
    pub seconds: f64,
}

/// Blends what is chosen of a solid with the default ball, or gives up after `limit`.
pub fn blend(model: &Model, angle: f64, choice: Choice, radius: f64, limit: Duration) -> Run {
    let watch = Watch::default();
    let (stop, start) = (watch.clone(), Stopwatch::start());
    let (done, ended) = std::sync::mpsc::channel::<()>();
    let clock = std::thread::spawn(move || {
        if ended.recv_timeout(limit).is_err_and(|e| e == std::sync::mpsc::RecvTimeoutError::Timeout) {
            stop.cancel();
        }
    });
    let params = round::Params {
        features: features::Params { angle, ..features::Params::default() },
        choice,
        blend: blend::Params::new(radius),
        format: Format::Obj,
    };
    let outcome = fusion::round(model, &params, &watch).map(|o| (o.model.mesh, o.report));
    let seconds = start.elapsed().as_secs_f64();
    drop(done);
    // The clock only sleeps: it has nothing to fail at.
    let _ = clock.join();
    Run { outcome, seconds }
}

impl Run {
    /// The exit code that the program would give, a dash where the time was up.
    pub fn exit(&self) -> &'static str {
        match &self.outcome {
            Ok(_) => "0",
            Err(e) if e.is_cancelled() => "-",
            Err(e) if e.is_invalid_result() => "5",
            Err(_) => "4",
        }
    }

    /// Share of the length of all chosen curves that is blended, and that is at full radius.
    pub fn shares(&self) -> Option<[f64; 2]> {
        let report = &self.outcome.as_ref().ok()?.1;
        let total: f64 = report.curves.iter().map(|c| c.length).sum();
        let blended: f64 = report.curves.iter().map(|c| c.length * c.blended_share).sum();
        Some([blended / total, report.figures.get("full_share").copied().unwrap_or_default()])
    }

    /// Whether every chosen curve is blended, none with a smaller ball than asked for.
    pub fn is_full(&self) -> bool {
        let Ok((_, report)) = &self.outcome else { return false };
        let figure = |name: &str| report.figures.get(name).copied().unwrap_or_default();
        report.curves.iter().all(|c| c.method != Method::Sharp) && figure("smallest_radius") >= 0.999 * figure("radius")
    }

    /// Why there is no result, or what it warns of first.
    pub fn words(&self) -> String {
        match &self.outcome {
            Ok((_, report)) => report.warnings.first().cloned().unwrap_or_default(),
            Err(e) => e.to_string(),
        }
        .replace(['|', '\n'], "/")
    }
}
