//! What each verb gives, seen from outside.

use crate::support::{Bench, cube, json};
use std::fs;

#[test]
fn info_as_json() {
    let info = json(Bench::new().run("info a.off --json").expect(0).text());
    assert_eq!((&info["vertices"], &info["faces"], &info["genus"]), (&8.into(), &12.into(), &0.into()));
    assert_eq!(info["volume"].as_f64(), Some(1.0));
    assert_eq!(info["self_intersections"], 0);
    assert_eq!(info["defects"].as_array().map(Vec::len), Some(0));
}

#[test]
fn positions_survive_a_round_trip_bit_for_bit() {
    let bench = Bench::new();
    bench.file("a.off", &cube([0.1, 1.0 / 3.0, 1e-17], 1e-3));
    let bits = |text: &str| -> Vec<u64> {
        let points = text.lines().skip(2).take(8).flat_map(str::split_whitespace);
        points.map(|w| w.parse::<f64>().unwrap().to_bits()).collect()
    };
    for through in ["obj", "ply"] {
        bench.run(&format!("convert a.off -o t.{through}")).expect(0);
        bench.run(&format!("convert t.{through} -o back.off")).expect(0);
        assert_eq!(bits(&bench.read("back.off")), bits(&bench.read("a.off")), "{through}");
    }
}

#[test]
fn streams_are_pipes_of_any_format() {
    let bench = Bench::new();
    let ply = bench.run("convert a.off -o - --to ply").expect(0);
    let info = json(bench.run_with("info - --from ply --json", &ply.stdout).expect(0).text());
    assert_eq!(info["faces"], 12);
    assert_eq!(bench.files(), ["a.off", "b.off"]);
}

#[test]
fn features_of_a_box() {
    let bench = Bench::new();
    bench.run("features a.off -o curves.json").expect(0);
    let curves = json(&bench.read("curves.json"));
    assert_eq!(curves["curves"].as_array().map(Vec::len), Some(12));
    assert_eq!(curves["curves"][0]["convexity"], "convex");
    assert_eq!(curves["curves"][3]["id"], 3);
    assert_eq!(bench.run("features a.off").expect(0).text().lines().count(), 13);
    assert_eq!(bench.run("features a.off --angle 95").expect(0).text().lines().count(), 1);
}

#[test]
fn union_reports_and_traces_itself() {
    let bench = Bench::new();
    bench.run("union a.off b.off -o out.ply --report r.json --origins o.json").expect(0);
    let (report, origins) = (json(&bench.read("r.json")), json(&bench.read("o.json")));
    let info = json(bench.run("info out.ply --json").expect(0).text());
    assert_eq!((&info["closed"], &info["self_intersections"]), (&true.into(), &0.into()));
    // Inclusion and exclusion: the overlap of the two unit boxes is 0.6 · 0.7 · 0.8.
    assert!((info["volume"].as_f64().unwrap() - (2.0 - 0.6 * 0.7 * 0.8)).abs() < 1e-12);
    assert_eq!(report["output"]["vertices"], info["vertices"]);
    assert_eq!(report["validity"]["closed"], true);
    assert_eq!(origins["vertices"].as_array().map(Vec::len), info["vertices"].as_u64().map(|n| n as usize));
    let kept = origins["vertices"].as_array().unwrap().iter().filter(|o| o[0] == "input").count();
    assert_eq!((report["kept_vertices"].as_u64(), kept), (Some(14), 14));
}

#[test]
fn difference_and_intersection_obey_the_volumes() {
    let bench = Bench::new();
    let overlap = 0.6 * 0.7 * 0.8;
    for (verb, volume) in [("difference", 1.0 - overlap), ("intersection", overlap)] {
        bench.run(&format!("{verb} a.off b.off -o out.off")).expect(0);
        let info = json(bench.run("info out.off --json").expect(0).text());
        assert!((info["volume"].as_f64().unwrap() - volume).abs() < 1e-12, "{verb}");
    }
}

#[test]
fn threads_do_not_change_a_byte() {
    let bench = Bench::new();
    for threads in [1, 2, 5] {
        bench.run(&format!("union a.off b.off -o out{threads}.ply --threads {threads}")).expect(0);
        assert_eq!(
            fs::read(bench.path("out1.ply")).unwrap(),
            fs::read(bench.path(&format!("out{threads}.ply"))).unwrap()
        );
    }
}

#[test]
fn quiet_is_silent_and_verbose_tells_stages() {
    let bench = Bench::new();
    assert!(bench.run("convert a.off -o out.obj --quiet").expect(0).stderr.is_empty());
    assert!(bench.run("union a.off b.off -o out.obj -v").expect(0).stderr.contains(" ms"));
}

#[test]
fn a_picture_is_a_png() {
    let bench = Bench::new();
    bench.run("render a.off -o a.png --size 64 --wireframe").expect(0);
    let bytes = fs::read(bench.path("a.png")).unwrap();
    assert!(bytes.starts_with(b"\x89PNG") && bytes[16..24] == [0, 0, 0, 64, 0, 0, 0, 64]);
}

#[test]
fn shells_and_manuals_know_every_verb() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = bench.run(&format!("completions {shell}")).expect(0);
        assert!(script.text().contains("fusion-cli") && script.text().contains("max-radius"), "{shell}");
    }
    assert!(bench.run("man").expect(0).text().contains("Exit codes"));
    bench.run("man -o pages").expect(0);
    let blend = bench.read("pages/fusion-cli-blend.1");
    assert!(blend.contains("max\\-radius") && blend.contains("threads"), "{blend}");
    // The program itself, and every verb that help lists.
    let help = bench.run("help").expect(0).text().to_string();
    let verbs = help.lines().skip_while(|l| *l != "Commands:").skip(1).take_while(|l| l.starts_with("  "));
    let verbs = verbs.filter(|l| !l.starts_with("   ") && !l.trim_start().starts_with("help")).count();
    assert_eq!(fs::read_dir(bench.path("pages")).unwrap().count(), verbs + 1);
}

#[cfg(unix)]
#[test]
fn devices_are_written_not_replaced() {
    let bench = Bench::new();
    bench.run("convert a.off -o /dev/null --to ply").expect(0);
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn remesh_smooths_with_or_without_new_triangles() {
    let bench = Bench::new();
    bench.run("remesh a.off -o fine.off --edge-length 0.1").expect(0);
    let report = |name: &str| json(&bench.read(name));
    let all = "remesh fine.off -o round.off --angle 180 --report r.json --smooth";
    bench.run(&format!("{all} flow=0.5")).expect(0);
    let round = json(bench.run("info round.off --json").expect(0).text());
    assert_eq!(report("r.json")["output"]["faces"], round["faces"]);
    assert!(round["volume"].as_f64().unwrap() < 0.95 && report("r.json")["validity"]["closed"] == true);
    bench.run(&format!("{all} taubin=20")).expect(0);
    let kept = json(bench.run("info round.off --json").expect(0).text())["volume"].as_f64().unwrap();
    assert!((kept - 1.0).abs() < 0.02, "{kept}");
    // Creases are held unless asked otherwise, and nothing else of a box bends.
    bench.run("remesh fine.off -o same.off --smooth taubin").expect(0);
    let same = json(bench.run("info same.off --json").expect(0).text())["volume"].as_f64().unwrap();
    assert!((same - 1.0).abs() < 1e-12, "{same}");
    bench
        .run("remesh fine.off -o cap.off --smooth biharmonic --region near=0.5,0.5,1,0.4 --edge-length 0.05")
        .expect(0);
    // A whole surface with nothing held has no fairest shape; a way or a length must be given.
    let failed = bench.run("remesh fine.off -o none.off --smooth harmonic").expect(4);
    assert!(failed.stderr.contains("hold"), "{}", failed.stderr);
    bench.run("remesh fine.off -o none.off").expect(2);
    bench.run("remesh fine.off -o none.off --smooth laplace").expect(2);
    assert!(!bench.files().contains(&"none.off".to_string()));
}

/// Every operation is in the schema, with the defaults that help prints.
#[test]
fn the_schema_lists_operations_with_their_defaults() {
    let bench = Bench::new();
    let schema = json(bench.run("schema").expect(0).text());
    let help = bench.run("blend --help").expect(0);
    let help = help.text().split_whitespace().collect::<Vec<_>>().join(" ");
    for (option, default) in [("alpha", "1.75"), ("tolerance", "0.005"), ("angle", "40")] {
        let told = &schema["$defs"]["Blend"]["properties"][option]["default"];
        assert_eq!(told.as_f64(), default.parse().ok(), "{option}");
        assert!(help.contains(&format!("[default: {default}]")), "{option}: {help}");
    }
    assert!(schema["properties"]["boolean"].is_object(), "{schema}");
}

/// A chamfer is a blend with another default.
#[test]
fn a_chamfer_takes_no_other_profile() {
    let bench = Bench::new();
    bench.run("chamfer a.off -o chamfer.off --radius 0.1").expect(0);
    bench.run("blend a.off -o blend.off --radius 0.1 --profile chamfer").expect(0);
    assert_eq!(bench.read("chamfer.off"), bench.read("blend.off"));
    bench.run("chamfer a.off -o no.off --radius 0.1 --profile arc").expect(2);
}

/// What people type for a length gets an answer that helps.
#[test]
fn lengths_with_units_and_commas_are_explained() {
    let bench = Bench::new();
    for (radius, says) in [("2mm", "write 2;"), ("0,5", "write 0.5"), ("two", "such as 2%")] {
        let run = bench.run(&format!("blend a.off -o no.off --radius {radius}")).expect(2);
        assert!(run.stderr.contains(says), "{radius}: {}", run.stderr);
    }
}
