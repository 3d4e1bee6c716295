//! `cut` and `run`, seen from outside.

use crate::support::{Bench, json};

const HALVES: &str = r#"
version = 1
output = "built/out.off"

[[part]]
name = "a"
mesh = "../a.off"

[[part]]
name = "b"
mesh = "../a.off"
translate = [0.5, 0.25, 0.125]

[[boolean]]
operation = "union"
"#;

#[test]
fn a_cut_leaves_one_clean_opening() {
    let bench = Bench::new();
    bench.run("cut a.off -o half.off --plane 0,0,0.25,0,0,1 --report r.json --origins o.json").expect(0);
    let info = json(bench.run("info half.off --json").expect(0).text());
    assert_eq!(info["boundary_loops"].as_array().map(Vec::len), Some(1), "{info}");
    assert_eq!(info["self_intersections"], 0);
    let report = json(&bench.read("r.json"));
    assert_eq!((&report["command"], &report["kept_vertices"]), (&"cut".into(), &4.into()));
    assert_eq!((&report["validity"]["closed"], report["figures"]["rims"].as_f64()), (&false.into(), Some(1.0)));
    assert!(json(&bench.read("o.json"))["vertices"].as_array().is_some_and(|v| v.iter().any(|o| o[0] == "edge")));
}

#[test]
fn a_plane_that_misses_says_where_the_mesh_is() {
    let bench = Bench::new();
    let run = bench.run("cut a.off -o out.off --plane 0,0,7,0,0,1").expect(4);
    assert!(run.stderr.contains("from -7.5 to -6.5"), "{}", run.stderr);
    assert_eq!(bench.files(), ["a.off", "b.off"]);
}

#[test]
fn recipes_run_relative_to_themselves() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("made/built")).unwrap();
    bench.file("made/recipe.toml", HALVES);
    bench.run("run made/recipe.toml --report r.json").expect(0);
    let info = json(bench.run("info made/built/out.off --json").expect(0).text());
    let shared = 0.5 * 0.75 * 0.875;
    assert!((info["volume"].as_f64().unwrap() - (2.0 - shared)).abs() < 1e-12);
    assert_eq!(json(&bench.read("r.json"))["command"], "run");
    bench.run("run made/recipe.toml -o here.ply").expect(0);
    assert!(bench.path("here.ply").exists());
}

#[test]
fn malformed_recipes_exit_with_3_line_and_key() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("made/built")).unwrap();
    for (from, to, words) in [
        ("operation", "opperation", "line 15, `opperation`"),
        ("\"union\"", "\"fusion\"", "line 15, `operation`"),
        ("version = 1", "version = 3", "line 2, `version`"),
        ("mesh = \"../a.off\"", "mesh = \"../none.off\"", "none.off"),
        ("[0.5, 0.25, 0.125]", "[0.5, 0.25]", "line 12, `translate`"),
    ] {
        bench.file("made/recipe.toml", &HALVES.replace(from, to));
        let run = bench.run("run made/recipe.toml").expect(3);
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    let missing = bench.run("run nowhere.toml").expect(3);
    assert!(missing.stderr.contains("nowhere.toml"));
}

/// Both halves of a picked cut, and the picks as the report tells their price.
#[test]
fn a_path_cuts_in_two() {
    let bench = Bench::new();
    // The test models are boxes around 0, 0, 0 and beside it; a path round the first one's middle.
    let picks = "0.6,0.1,0.02 -0.1,0.6,-0.03 -0.6,-0.1,0.01 0.1,-0.6,0.03";
    bench.run(&format!("cut a.off -o large.off --path {picks} --report r.json")).expect(0);
    bench.run(&format!("cut a.off -o small.off --path {picks} --keep smaller")).expect(0);
    let figures = json(&bench.read("r.json"))["figures"].clone();
    assert!(figures["path_cost"].as_f64().unwrap() <= figures["geodesic_cost"].as_f64().unwrap());
    for half in ["large.off", "small.off"] {
        let info = json(bench.run(&format!("info {half} --json")).expect(0).text());
        assert_eq!(info["boundary_loops"].as_array().map(Vec::len), Some(1), "{info}");
    }
    let error = bench.run("cut a.off -o out.off --path 0,0,1").expect(4);
    assert!(error.stderr.contains("two picks"), "{}", error.stderr);
}

/// Every key of a blend does what the option of that name does.
#[test]
fn blends_in_recipes_have_the_options_of_the_command_line() {
    let bench = Bench::new();
    let edge = r#"{"curves": [{"points": [[-0.5, 0.5, 0.5], [0.5, 0.5, 0.5]], "closed": false}]}"#;
    bench.file("edge.json", edge);
    for (keys, options) in [
        ("radius = [0.1, 0.2]\nnear = [[0, 0.5, 0.5]]", "--radius 0.1,0.2 --near 0,0.5,0.5"),
        (
            "radius = 0.1\nradius_at = [{ at = [0.5, 0.5, 0.5], radius = 0.2 }]\nprofile_at = [{ at = [0, 0.5, 0.5], profile = \"conic=0.5\" }]\ncurves = \"edge.json\"",
            "--radius 0.1 --radius-at 0.5,0.5,0.5=0.2 --profile-at 0,0.5,0.5=conic=0.5 --curves edge.json",
        ),
        (
            "radius = \"5%\"\nprofile = \"hermite\"\nreach = 1.3\nspine = \"contact\"\nnear = [[0, 0.5, 0.5]]",
            "--radius 5% --profile hermite,reach=1.3 --spine contact --near 0,0.5,0.5",
        ),
    ] {
        let recipe =
            format!("version = 1\noutput = \"r.off\"\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[blend]]\n{keys}\n");
        bench.file("r.toml", &recipe);
        bench.run("run r.toml").expect(0);
        bench.run(&format!("blend a.off -o c.off {options}")).expect(0);
        assert_eq!(bench.read("r.off"), bench.read("c.off"), "{keys}");
    }
    for (keys, says) in [
        ("radius = [0.1, 0.0]", "radius"),
        ("radius = 0.1\nradius_at = [{ at = [0, 0, 0], radius = -1 }]", "radius_at"),
        ("radius = 0.1\ncurves = \"none.json\"", "none.json"),
        ("radius = 0.1\nspine = \"paper\"", "offset"),
        ("radius = 0.1\nreach = 0.0", "0.1"),
    ] {
        let recipe =
            format!("version = 1\noutput = \"no.off\"\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[blend]]\n{keys}\n");
        bench.file("r.toml", &recipe);
        let run = bench.run("run r.toml").expect(3);
        assert!(run.stderr.contains(says) && run.stderr.contains("line"), "{keys}: {}", run.stderr);
    }
}
