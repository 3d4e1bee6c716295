//! `batch`, `grid` and `summary`, seen from outside.

use crate::support::{Bench, Run, cube, json};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;

/// A document that joins two boxes, the second one posed.
pub fn document(dx: f64) -> String {
    format!(
        "version = 2\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[part]]\nname = \"b\"\nmesh = \"b.off\"\n\
         translate = [{dx:?}, 0, 0]\n[[step]]\ndo = \"union\"\nof = [\"a\", \"b\"]\n[[output]]\nof = \"a\"\nfile = \"out.off\"\n"
    )
}

/// A document that cuts where there is nothing.
pub fn impossible() -> String {
    "version = 2\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[step]]\ndo = \"cut\"\nof = \"a\"\n\
     plane = { point = [0, 0, 7], normal = [0, 0, 1] }\n[[output]]\nof = \"a\"\nfile = \"out.off\"\n"
        .into()
}

/// Lines of jobs with whole documents in them.
pub fn jobs(documents: &[(String, String)]) -> String {
    documents.iter().map(|(id, text)| json!({ "id": id, "document": text }).to_string() + "\n").collect()
}

/// Finished lines by id; each may be there once.
pub fn results(bench: &Bench, name: &str) -> BTreeMap<String, Value> {
    let mut found = BTreeMap::new();
    for line in bench.read(name).lines() {
        let value = json(line);
        let id = value["id"].as_str().unwrap().to_string();
        assert!(found.insert(id, value).is_none(), "twice: {line}");
    }
    found
}

fn states(bench: &Bench, name: &str) -> Vec<(String, String, i64)> {
    let of = |v: &Value| (v["state"].as_str().unwrap().to_string(), v["code"].as_i64().unwrap());
    results(bench, name).iter().map(|(id, v)| (id.clone(), of(v).0, of(v).1)).collect()
}

fn tuple(id: &str, state: &str, code: i64) -> (String, String, i64) {
    (id.into(), state.into(), code)
}

#[test]
fn each_job_has_a_line_a_folder_and_the_bytes_that_run_writes() {
    let bench = Bench::new();
    bench.file("doc.toml", &document(0.25));
    let lines =
        jobs(&[("in/line".into(), document(0.25)), ("bad".into(), impossible()), ("worse".into(), "x\n".into())]);
    let more = "{\"id\": 7, \"document\": \"doc.toml\"}\n\n{\"id\": \"none\", \"document\": \"none.toml\"}\n";
    bench.file("jobs.jsonl", &(lines + more));
    let run = bench.run("batch jobs.jsonl --results r.jsonl --output made --workers 2 --report b.json").expect(0);
    assert!(run.stderr.contains("2 done, 3 not") && run.stdout.is_empty(), "{}", run.stderr);
    let expected =
        [("7", "done", 0), ("bad", "failed", 4), ("in/line", "done", 0), ("none", "failed", 3), ("worse", "failed", 3)];
    assert_eq!(states(&bench, "r.jsonl"), expected.map(|(id, state, code)| tuple(id, state, code)));
    bench.run("run doc.toml").expect(0);
    let all = results(&bench, "r.jsonl");
    for (id, folder) in [("7", "made/7"), ("in/line", "made/in%2Fline")] {
        assert_eq!(all[id]["folder"], folder);
        assert_eq!(bench.read(&format!("{folder}/out.off")), bench.read("out.off"));
        let (output, bytes) = (&all[id]["outputs"][0], fs::read(bench.path("out.off")).unwrap());
        assert_eq!((&output["file"], output["bytes"].as_u64()), (&"out.off".into(), Some(bytes.len() as u64)));
        assert_eq!(output["blake3"], *blake3::hash(&bytes).to_hex().as_str());
    }
    assert_eq!(all["bad"]["diagnostics"][0]["severity"], "error");
    assert!(all["none"]["diagnostics"][0]["message"].as_str().unwrap().contains("none.toml"));
    assert_eq!(all["7"]["inputs"], json!(["a.off", "b.off"]));
    let mut made: Vec<_> = fs::read_dir(bench.path("made")).unwrap().map(|e| e.unwrap().file_name()).collect();
    made.sort();
    assert_eq!(made, ["7", "in%2Fline"]);
    let report = json(&bench.read("b.json"));
    assert_eq!((report["figures"]["done"].as_f64(), report["figures"]["failed"].as_f64()), (Some(2.0), Some(3.0)));
}

#[test]
fn nothing_starts_where_a_line_is_malformed() {
    let bench = Bench::new();
    let good = jobs(&[("a".into(), document(0.25))]);
    for (text, words) in [
        (format!("{good}\n{{\"id\": \"b\"}}\n"), "jobs.jsonl: line 3: missing field `document`"),
        (format!("{good}{good}"), "line 2: the id `a` is taken by line 1"),
        (format!("{good}{}", &good[..20]), "line 2"),
    ] {
        bench.file("jobs.jsonl", &text);
        let run = bench.run("batch jobs.jsonl --results r.jsonl").expect(3);
        assert!(run.stderr.contains(words) && run.stderr.contains("no job was started"), "{}", run.stderr);
    }
    assert!(bench.run("batch none.jsonl --results r.jsonl").expect(3).stderr.contains("none.jsonl"));
    assert_eq!(bench.files(), ["a.off", "b.off", "jobs.jsonl"]);
}

#[test]
fn strict_counts_failures_at_the_end() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("bad".into(), impossible()), ("good".into(), document(0.25))]));
    let run = bench.run("batch jobs.jsonl --results r.jsonl --strict").expect(4);
    assert!(run.stderr.contains("1 of 2 jobs"), "{}", run.stderr);
    assert_eq!(states(&bench, "r.jsonl"), [tuple("bad", "failed", 4), tuple("good", "done", 0)]);
}

#[test]
fn shards_take_every_job_once() {
    let bench = Bench::new();
    let all: Vec<_> = (0..5).map(|i| (format!("job{i}"), document(0.1 * f64::from(i)))).collect();
    bench.file("jobs.jsonl", &jobs(&all));
    bench.run("batch jobs.jsonl --results r1.jsonl --shard 1/2").expect(0);
    let mut command = bench.command("batch jobs.jsonl --results r2.jsonl");
    command.envs([("SLURM_ARRAY_TASK_ID", "9"), ("SLURM_ARRAY_TASK_MIN", "8"), ("SLURM_ARRAY_TASK_COUNT", "2")]);
    let output = command.output().unwrap();
    assert!(output.status.success() && String::from_utf8_lossy(&output.stderr).contains("shard 2/2"));
    let ids = |name| results(&bench, name).into_keys().collect::<Vec<_>>();
    assert_eq!(
        (ids("r1.jsonl"), ids("r2.jsonl")),
        (vec!["job0".into(), "job2".into(), "job4".into()], vec!["job1".into(), "job3".into()])
    );
    assert!(bench.run("batch jobs.jsonl --results r.jsonl --shard 3/2").expect(2).stderr.contains("i/n"));
}

#[test]
fn older_results_are_kept_unless_they_are_gone_on_with() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("a".into(), document(0.25)), ("b".into(), document(0.5))]));
    bench.run("batch jobs.jsonl --results r.jsonl --workers 1").expect(0);
    let first = bench.read("r.jsonl");
    let run = bench.run("batch jobs.jsonl --results r.jsonl").expect(0);
    assert!(run.stderr.contains("r.jsonl.1"), "{}", run.stderr);
    assert_eq!(bench.read("r.jsonl.1"), first);
    // A torn line is cut off, finished ones stay, nothing is done twice.
    let end = first.find('\n').unwrap() + 1;
    bench.file("r.jsonl", &first[..end + 30]);
    let run = bench.run("batch jobs.jsonl --results r.jsonl --resume").expect(0);
    assert!(run.stderr.contains("torn after 30 bytes") && run.stderr.contains("1 were there before"), "{}", run.stderr);
    assert!(bench.read("r.jsonl").starts_with(&first[..end]));
    assert_eq!(results(&bench, "r.jsonl").len(), 2);
    let again = bench.read("r.jsonl");
    bench.run("batch jobs.jsonl --results r.jsonl --resume").expect(0);
    assert_eq!(bench.read("r.jsonl"), again);
    bench.file("r.jsonl", &(again.clone() + "{}\n"));
    assert!(bench.run("batch jobs.jsonl --results r.jsonl --resume").expect(3).stderr.contains("line 3"));
    bench.file("r.jsonl", &again.replace("\"id\":\"a\"", "\"id\":\"x\""));
    assert!(bench.run("batch jobs.jsonl --results r.jsonl --resume").expect(3).stderr.contains("`x`"));
}

#[test]
fn what_cannot_be_written_is_told_before_any_work() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("a".into(), document(0.25))]));
    for line in ["--results a.off/r.jsonl", "--results r.jsonl --cache a.off/cache", "--results r.jsonl --output a.off"]
    {
        let run = bench.run(&format!("batch jobs.jsonl {line}")).expect(6);
        assert!(run.stderr.contains("cannot write"), "{line}: {}", run.stderr);
    }
    bench.run("batch jobs.jsonl --results -").expect(2);
    assert!(!bench.path("a").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_batch() {
    let bench = Bench::new();
    bench.file("jobs.jsonl", &jobs(&[("a".into(), document(0.25)), ("b".into(), document(0.5))]));
    let run = bench.run("batch jobs.jsonl --results /dev/full --output made").expect(6);
    assert!(run.stderr.contains("/dev/full"), "{}", run.stderr);
}

#[test]
fn a_grid_has_a_line_for_each_combination_and_warns_of_what_is_unused() {
    let bench = Bench::new();
    fs::create_dir(bench.path("sub")).unwrap();
    let text = "version = 2\n[parameters]\nsoft = 0.1\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[step]]\ndo = \"blend\"\nof = \"a\"\nradius = \"$soft\"\n";
    bench.file("round.toml", text);
    let run = bench
        .run("grid round.toml --set soft=1%,0.2 --set 1.profile=arc,g2,chamfer --set lost=1 -o grid.jsonl")
        .expect(0);
    assert!(run.stderr.contains("no use for the parameter `lost`") && !run.stderr.contains("soft"), "{}", run.stderr);
    let lines: Vec<Value> = bench.read("grid.jsonl").lines().map(json).collect();
    assert_eq!((lines.len(), &lines[0]["id"]), (6, &"round,soft=1%,1.profile=arc,lost=1".into()));
    assert_eq!(lines[5]["parameters"], json!({ "soft": 0.2, "1.profile": "chamfer", "lost": 1 }));
    assert_eq!(lines[5]["document"], "round.toml");
    bench.run("grid round.toml --set lost=1 -o strict.jsonl --strict").expect(4);
    assert!(!bench.path("strict.jsonl").exists());
    bench.run("grid round.toml --set soft=1,1 -o g.jsonl").expect(2);
    bench.run("grid round.toml --set soft=1 --set soft=2 -o g.jsonl").expect(2);
    bench.run("grid none.toml --set soft=1 -o g.jsonl").expect(3);
}

#[test]
fn the_page_needs_nothing_but_itself() {
    let bench = Bench::new();
    bench.file("c.off", &cube([3.0, 0.0, 0.0], 1.0));
    let all = [("good".into(), document(0.25)), ("<b>bad</b>".into(), impossible())];
    bench.file("jobs.jsonl", &jobs(&all));
    bench.run("batch jobs.jsonl --results r.jsonl").expect(0);
    let summary = |page: &str| -> Run { bench.run(&format!("summary r.jsonl -o {page}")) };
    summary("page.html").expect(0);
    let page = bench.read("page.html");
    assert!(page.contains("data:image/png;base64,") && page.contains("<svg") && page.contains("&lt;b&gt;bad"));
    assert!(["http:", "https:", "src=\"/", "<link", "@import", "<b>bad"].iter().all(|w| !page.contains(w)));
    assert!(bench.run("summary none.jsonl -o page.html").expect(3).stderr.contains("none.jsonl"));
    summary("none/page.html").expect(6);
}
