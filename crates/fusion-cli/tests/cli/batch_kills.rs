//! `batch` and its workers killed, late, and too large.

use crate::batch::{document, jobs, results};
use crate::support::Bench;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A part that takes seconds to remesh, and gigabytes if it is let.
fn heavy(edge: f64) -> String {
    format!(
        "version = 2\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[step]]\ndo = \"remesh\"\nof = \"a\"\nedge_length = {edge:?}\n\
         [[output]]\nof = \"a\"\nfile = \"out.off\"\n"
    )
}

/// The batch, started and left alone.
fn start(bench: &Bench, line: &str) -> Child {
    let mut command = bench.command(line);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().unwrap()
}

fn wait(what: &str, mut is: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what} does not happen");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn lines(bench: &Bench, name: &str) -> usize {
    fs::read_to_string(bench.path(name)).map_or(0, |text| text.matches('\n').count())
}

fn hashes(bench: &Bench, name: &str) -> Vec<(String, String)> {
    let hash = |v: &serde_json::Value| v["outputs"][0]["blake3"].as_str().unwrap_or("none").to_string();
    results(bench, name).iter().map(|(id, v)| (id.clone(), hash(v))).collect()
}

/// Processes whose parent is the given one.
#[cfg(target_os = "linux")]
fn children(parent: u32) -> Vec<u32> {
    let is_child = |id: &u32| {
        let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        status.lines().any(|l| l.strip_prefix("PPid:").is_some_and(|p| p.trim() == parent.to_string()))
    };
    let entries = fs::read_dir("/proc").unwrap();
    entries.filter_map(|e| e.ok()?.file_name().to_str()?.parse().ok()).filter(is_child).collect()
}

fn kill(process: u32) {
    let status = Command::new("kill").args(["-9", &process.to_string()]).status().unwrap();
    assert!(status.success());
}

#[test]
fn killed_three_times_and_resumed_each_job_is_done_once() {
    let bench = Bench::new();
    let mut all: Vec<_> = (0..60).map(|i| (format!("job{i}"), document(0.01 * f64::from(i)))).collect();
    all.extend((0..6).map(|i| (format!("none{i}"), "nothing\n".into())));
    bench.file("jobs.jsonl", &jobs(&all));
    bench.run("batch jobs.jsonl --results whole.jsonl --output whole --workers 1").expect(0);
    let mut before = String::new();
    for round in 1..=3 {
        let mut child = start(&bench, "batch jobs.jsonl --results r.jsonl --output made --workers 2 --resume");
        wait("a line", || lines(&bench, "r.jsonl") >= 12 * round);
        child.kill().unwrap();
        child.wait().unwrap();
        let after = bench.read("r.jsonl");
        assert!(after.starts_with(&before), "finished lines have changed");
        before = after[..after.rfind('\n').map_or(0, |end| end + 1)].into();
        assert!(before.matches('\n').count() < all.len(), "killed too late to show anything");
    }
    // As if the last kill had come in the middle of a line.
    bench.file("r.jsonl", &(before.clone() + "{\"id\":\"job"));
    bench.run("batch jobs.jsonl --results r.jsonl --output made --workers 2 --resume").expect(0);
    assert!(bench.read("r.jsonl").starts_with(&before));
    assert_eq!(hashes(&bench, "r.jsonl"), hashes(&bench, "whole.jsonl"));
    assert_eq!(fs::read_dir(bench.path("made")).unwrap().count(), 60, "nothing but the jobs' folders is left");
    for i in 0..60 {
        assert_eq!(bench.read(&format!("made/job{i}/out.off")), bench.read(&format!("whole/job{i}/out.off")));
    }
}

#[test]
fn a_second_batch_on_the_same_results_is_refused() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("slow".into(), heavy(0.004))]));
    let mut child = start(&bench, "batch jobs.jsonl --results r.jsonl");
    wait("the file", || bench.path("r.jsonl").exists());
    let run = bench.run("batch jobs.jsonl --results r.jsonl --resume");
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(run.expect(6).stderr.contains("another batch"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_crash_a_hang_and_too_much_memory_cost_a_line_each() {
    let bench = Bench::new();
    let all = [("before", document(0.25)), ("slow", heavy(0.004)), ("after", document(0.5))];
    bench.file("jobs.jsonl", &jobs(&all.map(|(id, text)| (id.into(), text))));
    let ended = |line: &str, state: &str, code: i64, words: &str| {
        bench.run(&format!("batch jobs.jsonl --results r.jsonl --workers 1 {line}")).expect(0);
        let found = results(&bench, "r.jsonl");
        assert_eq!((&found["slow"]["state"], found["slow"]["code"].as_i64()), (&state.into(), Some(code)));
        assert!(found["slow"]["diagnostics"][0]["message"].as_str().unwrap().contains(words), "{}", found["slow"]);
        assert!(["before", "after"].iter().all(|id| found[*id]["state"] == "done"));
        assert!(!bench.path("slow").exists());
    };
    ended("--timeout 5", "timeout", 4, "--timeout");
    ended("--memory 150", "memory", 4, "--memory");
    // A crash, by killing the worker from outside.
    let mut child = start(&bench, "batch jobs.jsonl --results crash.jsonl --workers 1");
    wait("the second job", || lines(&bench, "crash.jsonl") == 1);
    std::thread::sleep(Duration::from_millis(100));
    let workers = children(child.id());
    assert_eq!(workers.len(), 1);
    kill(workers[0]);
    assert!(child.wait().unwrap().success());
    let found = results(&bench, "crash.jsonl");
    assert_eq!((&found["slow"]["state"], found["slow"]["code"].as_i64()), (&"crashed".into(), Some(137)));
    assert!(["before", "after"].iter().all(|id| found[*id]["state"] == "done"));
}

/// A worker whose batch was killed gives up the job that it has.
#[cfg(target_os = "linux")]
#[test]
fn no_worker_outlives_its_batch() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("slow".into(), heavy(0.002))]));
    let mut child = start(&bench, "batch jobs.jsonl --results r.jsonl --workers 1");
    let mut workers = vec![];
    wait("a worker", || {
        workers = children(child.id());
        !workers.is_empty()
    });
    std::thread::sleep(Duration::from_millis(200));
    child.kill().unwrap();
    child.wait().unwrap();
    wait("the worker's end", || !Path::new(&format!("/proc/{}", workers[0])).exists());
}

/// Ctrl-C ends a batch within seconds, and what was under way is not counted as failed.
#[test]
fn an_interrupted_batch_can_be_resumed() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("fast".into(), document(0.25)), ("slow".into(), heavy(0.002))]));
    let mut child = start(&bench, "batch jobs.jsonl --results r.jsonl --workers 1");
    wait("the second job", || lines(&bench, "r.jsonl") == 1);
    std::thread::sleep(Duration::from_millis(100));
    let status = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(status.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(results(&bench, "r.jsonl").keys().collect::<Vec<_>>(), ["fast"]);
    let names = bench.files();
    assert!(!names.iter().any(|name| name.starts_with(".fusion-")), "{names:?}");
}
