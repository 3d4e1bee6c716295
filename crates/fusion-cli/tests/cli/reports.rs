//! What reports tell of blends and of failures, and what ends a job early.

use crate::support::{Bench, cube, json};
use std::time::{Duration, Instant};

/// A rounded box is on its balls but for the facets' own errors; one edge of twelve is sharp where it was not chosen.
#[test]
fn every_chosen_curve_is_told() {
    let bench = Bench::new();
    bench.run("blend a.off -o out.off --radius 0.2 --report r.json").expect(0);
    let report = json(&bench.read("r.json"));
    let figure = |name: &str| report["figures"][name].as_f64().unwrap();
    assert_eq!([figure("curves"), figure("skipped_curves"), figure("smallest_radius")], [12.0, 0.0, 0.2]);
    assert!(figure("full_share") > 0.999 && figure("ball_error_99") < 0.04, "{}", report["figures"]);
    for curve in report["curves"].as_array().unwrap() {
        let errors: Vec<f64> = curve["ball_error"].as_array().unwrap().iter().map(|e| e.as_f64().unwrap()).collect();
        assert!(errors.len() == 3 && errors.is_sorted() && errors[2] < 0.04, "{curve}");
        assert_eq!((&curve["method"], &curve["blended_share"]), (&"strip".into(), &1.0.into()));
    }
    assert_eq!((&report["exit_code"], &report["diagnostics"]), (&0.into(), &serde_json::json!([])));
    // A chamfer is no ball's.
    bench.run("chamfer a.off -o out.off --radius 0.2 --report r.json").expect(0);
    let report = json(&bench.read("r.json"));
    assert!(report["curves"][0]["ball_error"].is_null() && report["figures"]["ball_error_99"].is_null());
    assert_eq!(report["figures"]["full_share"], 1.0);
}

/// Where the ball was made smaller the measured share falls, whatever the stages say.
#[test]
fn a_smaller_ball_shows_in_what_is_measured() {
    let bench = Bench::new();
    bench.run("union a.off b.off -o out.off --radius 0.3 --overlap shrink --report r.json").expect(0);
    let report = json(&bench.read("r.json"));
    let figure = |name: &str| report["figures"][name].as_f64().unwrap();
    assert!(figure("full_share") < 0.95 && figure("ball_error_99") > 0.05, "{}", report["figures"]);
    let reduced = report["diagnostics"].as_array().unwrap().iter().filter(|d| d["code"] == "radius_reduced");
    assert_eq!(reduced.clone().count() as f64, figure("shrunk_places"));
    for told in reduced {
        let used = told["numbers"]["used"].as_f64().unwrap();
        assert!(used >= figure("smallest_radius") && told["at"].as_array().is_some_and(|p| p.len() == 3), "{told}");
    }
}

#[test]
fn failures_have_reports() {
    let bench = Bench::new();
    bench.file("bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\nzero 1 0\n3 0 1 2\n");
    for (line, code, told) in [
        ("info bad.off", 3, "unreadable"),
        ("info missing.off", 3, "unreadable"),
        ("union a.off b.off -o out.off --radius 0.3 --overlap error", 4, "radius_too_large"),
        ("blend a.off -o out.off --radius 0.1 --angle 170", 4, "no_edges"),
    ] {
        bench.run(&format!("{line} --report r.json")).expect(code);
        let report = json(&bench.read("r.json"));
        assert_eq!((&report["exit_code"], &report["diagnostics"][0]["code"]), (&code.into(), &told.into()), "{line}");
        assert!(report["diagnostics"][0]["severity"] == "error" && !bench.path("out.off").exists(), "{line}");
    }
    let report = json(&bench.read("r.json"));
    assert_eq!((&report["command"], &report["inputs"][0]["faces"]), (&"blend".into(), &12.into()));
}

#[test]
fn strict_allows_no_warning() {
    let bench = Bench::new();
    bench.file("far.off", &cube([10.0, 0.0, 0.0], 1.0));
    bench.run("union a.off far.off -o out.off").expect(0);
    let run = bench.run("union a.off far.off -o strict.off --strict --report r.json").expect(4);
    assert!(
        run.stderr.contains("warning: the surfaces do not cross") && run.stderr.contains("--strict"),
        "{}",
        run.stderr
    );
    let report = json(&bench.read("r.json"));
    let codes: Vec<_> = report["diagnostics"].as_array().unwrap().iter().map(|d| d["code"].as_str().unwrap()).collect();
    assert_eq!((codes, bench.path("strict.off").exists()), (vec!["apart", "strict"], false));
    bench.run("union a.off b.off -o strict.off --strict").expect(0);
    assert!(bench.path("strict.off").exists());
}

/// A job that waits for its input is ended as well.
#[test]
fn time_limits_end_a_job() {
    let bench = Bench::new();
    let start = Instant::now();
    let mut child = bench.command("convert - --from off -o out.off --time-limit 0.3 --report r.json").spawn().unwrap();
    let input = child.stdin.take();
    let output = child.wait_with_output().unwrap();
    drop(input);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(4) && text.contains("--time-limit"), "{:?} {text}", output.status);
    assert!(start.elapsed() > Duration::from_millis(300) && !bench.path("out.off").exists());
    let report = json(&bench.read("r.json"));
    assert_eq!((&report["exit_code"], &report["diagnostics"][0]["code"]), (&4.into(), &"time_limit".into()));
    bench.run("info a.off --time-limit 60").expect(0);
    bench.run("info a.off --time-limit 0").expect(2);
}

#[test]
fn trim_has_a_new_name() {
    let run = Bench::new().run("blend a.off -o out.off --radius 0.1 --overlap trim").expect(2);
    assert!(run.stderr.contains("`full`"), "{}", run.stderr);
    Bench::new().run("blend a.off -o out.off --radius 0.1 --overlap full").expect(0);
}
