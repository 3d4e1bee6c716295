//! Which curves a blend takes.

use crate::support::{Bench, cube, json};
use fusion::mesh_core::shapes;
use glam::{DQuat, DVec3};
use serde_json::Value;
use std::f64::consts::FRAC_PI_4;
use std::fmt::Write as _;

const RADIUS: f64 = 0.1;

/// Blends the first box with some options, and gives the report.
fn blend(bench: &Bench, options: &str) -> Value {
    bench.run(&format!("blend a.off -o out.off --radius {RADIUS} --report r.json {options}")).expect(0);
    json(&bench.read("r.json"))
}

fn ids(report: &Value) -> Vec<u64> {
    report["curves"].as_array().unwrap().iter().map(|c| c["id"].as_u64().unwrap()).collect()
}

fn volume(bench: &Bench, file: &str) -> f64 {
    json(bench.run(&format!("info {file} --json")).expect(0).text())["volume"].as_f64().unwrap()
}

/// What a ball takes from an edge of 90 degrees, by length.
fn section(radius: f64) -> f64 {
    (1.0 - FRAC_PI_4) * radius * radius
}

#[test]
fn ids_are_those_that_features_lists() {
    let bench = Bench::new();
    let listed = json(bench.run("features a.off --json").expect(0).text());
    let report = blend(&bench, "--ids 7,2");
    assert_eq!(ids(&report), [2, 7]);
    for (curve, id) in report["curves"].as_array().unwrap().iter().zip([2, 7]) {
        assert_eq!((&curve["length"], &curve["method"]), (&listed["curves"][id]["length"], &"strip".into()));
        assert_eq!((&curve["radius"], &curve["source"]), (&RADIUS.into(), &"feature".into()));
    }
    let run = bench.run("blend a.off -o no.off --radius 0.1 --ids 12 --report r.json").expect(4);
    assert!(run.stderr.contains("there are 12"), "{}", run.stderr);
    assert_eq!(json(&bench.read("r.json"))["diagnostics"][0]["code"], "no_such_curve");
}

/// Every corner of a box is on three curves: what the list prints lies on one alone.
#[test]
fn near_copied_from_the_list_takes_the_listed_curve() {
    let bench = Bench::new();
    let table = bench.run("features a.off --no-radii").expect(0);
    for (id, row) in table.text().lines().skip(1).enumerate() {
        let near = row.split_whitespace().last().unwrap();
        let report = blend(&bench, &format!("--near {near}"));
        assert_eq!(ids(&report), [id as u64], "{row}");
        assert_eq!(report["diagnostics"][0]["code"], "curve_taken");
        assert!(report["notes"][0].as_str().unwrap().contains(&format!("is {id},")), "{}", report["notes"]);
    }
    let told = bench.run("blend a.off -o out.off --radius 0.1 --near 0.5,0.5,0 -v").expect(0);
    assert!(told.stderr.contains("the feature curve nearest to [0.5, 0.5, 0] is"), "{}", told.stderr);
    let far = bench.run("blend a.off -o out.off --radius 0.1 --near 0.7,0.6,0 --report r.json").expect(0);
    let report = json(&bench.read("r.json"));
    assert!(far.stderr.contains("the feature curve nearest to [0.7, 0.6, 0] is"), "{}", far.stderr);
    let told = &report["diagnostics"][0];
    let distance = told["numbers"]["distance"].as_f64().unwrap();
    assert!(told["code"] == "curve_far" && told["severity"] == "warning" && (distance - 0.05f64.sqrt()).abs() < 1e-12);
    bench.run("blend a.off -o none.off --radius 0.1 --near 0.7,0.6,0 --strict").expect(4);
    assert!(!bench.path("none.off").exists());
}

#[test]
fn filters_narrow_what_is_chosen() {
    let bench = Bench::new();
    bench.file("top.off", &cube([0.0, 0.0, 1.0], 1.5));
    assert_eq!(ids(&blend(&bench, "")).len(), 12);
    assert_eq!(ids(&blend(&bench, "--along 1,0,0")).len(), 4);
    assert_eq!(ids(&blend(&bench, "--along 1,0,0 --along 0,0,-1")).len(), 8);
    assert_eq!(ids(&blend(&bench, "--within top.off")).len(), 4);
    assert_eq!(ids(&blend(&bench, "--within top.off --along 0,1,0")).len(), 2);
    assert_eq!(ids(&blend(&bench, "--convex --longer 0.9")).len(), 12);
    for filter in ["--concave", "--longer 1.1", "--along 1,1,1"] {
        let run = bench.run(&format!("blend a.off -o no.off --radius 0.1 {filter} --report r.json")).expect(4);
        assert!(run.stderr.contains("none of the 12 curves passes"), "{}", run.stderr);
        assert_eq!(json(&bench.read("r.json"))["diagnostics"][0]["code"], "nothing_chosen");
    }
    bench.run("blend a.off -o no.off --radius 0.1 --convex --concave").expect(2);
    let open: String = cube([0.0; 3], 1.0).replace("8 12 0", "8 10 0").lines().take(20).collect::<Vec<_>>().join("\n");
    bench.file("open.off", &open);
    let run = bench.run("blend a.off -o no.off --radius 0.1 --within open.off").expect(4);
    assert!(run.stderr.contains("not closed"), "{}", run.stderr);
    // A union of two boxes has valleys and ridges.
    bench.run("union a.off b.off -o joined.off").expect(0);
    let mixed = |options: &str| {
        bench.run(&format!("blend joined.off -o out.off --radius 0.02 --report r.json {options}")).expect(0);
        ids(&json(&bench.read("r.json"))).len()
    };
    assert_eq!(mixed("--convex") + mixed("--concave"), mixed(""));
}

/// A prism whose roof falls by 20 degrees half-way: its upper front edge goes on there by a second curve.
#[test]
fn a_chain_goes_on_where_the_surface_does() {
    let bench = Bench::new();
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0 - 20f64.to_radians().tan()], [1.0, 1.0], [0.0, 1.0]];
    let mut text = String::from("OFF\n10 7 0\n");
    for y in [0.0, 1.0] {
        for [x, z] in outline {
            writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
        }
    }
    text += "5 0 1 2 3 4\n5 9 8 7 6 5\n";
    for i in 0..5 {
        writeln!(text, "4 {i} {} {} {}", 5 + i, 5 + (i + 1) % 5, (i + 1) % 5).unwrap();
    }
    bench.file("roof.off", &text);
    let chosen = |options: &str| {
        let line = "blend roof.off -o out.off --radius 0.05 --angle 15 --near 0.5,0,1 --report r.json";
        bench.run(&format!("{line} {options}")).expect(0);
        json(&bench.read("r.json"))["curves"].as_array().unwrap().iter().map(|c| c["length"].as_f64().unwrap()).sum()
    };
    let (alone, chain): (f64, f64) = (chosen(""), chosen("--chain"));
    assert!(
        (alone - 1.0).abs() < 1e-9 && (chain - 1.0 - 1.0 / 20f64.to_radians().cos()).abs() < 1e-9,
        "{alone} {chain}"
    );
}

/// The seam of a boolean, blended afterwards, is what the boolean blends itself.
#[test]
fn seams_of_an_earlier_boolean() {
    let bench = Bench::new();
    bench.run("union a.off b.off -o joined.off --origins o.json").expect(0);
    bench.run("union a.off b.off -o once.off --radius 0.05").expect(0);
    bench.run("blend joined.off -o twice.off --radius 0.05 --seams o.json --report r.json").expect(0);
    let report = json(&bench.read("r.json"));
    assert_eq!(report["curves"][0]["source"], "seam");
    let [plain, once, twice] = ["joined.off", "once.off", "twice.off"].map(|f| volume(&bench, f));
    assert!(once > plain && ((twice - plain) / (once - plain) - 1.0).abs() < 1e-9, "{plain} {once} {twice}");
    let changed = report["figures"]["volume_changed"].as_f64().unwrap();
    assert!((changed / (twice - plain) - 1.0).abs() < 1e-6, "{changed}");
    let run = bench.run("blend a.off -o no.off --radius 0.05 --seams o.json --report r.json").expect(4);
    assert!(run.stderr.contains("the mesh has 12"), "{}", run.stderr);
    assert_eq!(json(&bench.read("r.json"))["diagnostics"][0]["code"], "no_seams");
}

#[test]
fn each_curve_may_have_its_radius() {
    let bench = Bench::new();
    let near = "--near 0.5,0.5,0=0.2 --near -0.5,-0.5,0=0.1";
    bench.run(&format!("blend a.off -o out.off --report r.json --tolerance 1e-4 {near}")).expect(0);
    let taken = 1.0 - volume(&bench, "out.off");
    assert!((taken / (section(0.2) + section(0.1)) - 1.0).abs() < 1e-3, "{taken}");
    let report = json(&bench.read("r.json"));
    let mut radii: Vec<f64> =
        report["curves"].as_array().unwrap().iter().map(|c| c["radius"].as_f64().unwrap()).collect();
    radii.sort_by(f64::total_cmp);
    assert_eq!(radii, [0.1, 0.2]);
    for curve in report["curves"].as_array().unwrap() {
        assert!(curve["full_share"].as_f64().unwrap() > 0.99, "{curve}");
    }
    // One radius for all that are named needs no --radius either; a curve without one does.
    bench.run("blend a.off -o out.off --near 0.5,0.5,0=20%").expect(0);
    bench.run("blend a.off -o no.off --near 0.5,0.5,0=0.2 --near -0.5,-0.5,0").expect(2);
}

/// A plate with two posts.
fn posts() -> Bench {
    let bench = Bench::new();
    let mut plate = shapes::cuboid(DVec3::new(6.0, 3.0, 1.0));
    mesh_io::write(&plate.clone().into(), &bench.path("plate.ply")).unwrap();
    for (name, x, radius) in [("thin.ply", -1.5, 0.4), ("thick.ply", 1.5, 0.8)] {
        plate = shapes::posed(shapes::cylinder(radius, 2.0, 48, 12), DQuat::IDENTITY, DVec3::new(x, 0.03, 0.9));
        mesh_io::write(&plate.clone().into(), &bench.path(name)).unwrap();
    }
    bench
}

#[test]
fn booleans_choose_among_their_seams() {
    let bench = posts();
    let union = |options: &str| {
        let line = "union plate.ply thin.ply thick.ply -o out.ply --radius 0.1 --report r.json";
        bench.run(&format!("{line} {options}")).expect(0);
        json(&bench.read("r.json"))["curves"].as_array().unwrap().iter().map(|c| c["id"].as_u64().unwrap()).collect()
    };
    let [all, thin, thick, long]: [Vec<u64>; 4] =
        ["", "--near -1.1,0,0.5", "--near 2.3,0,0.5", "--longer 4"].map(union);
    assert_eq!((all, thin, thick, long), (vec![0, 1], vec![0], vec![1], vec![1]));
    let limit = |options: &str| {
        let run = bench.run(&format!("union plate.ply thin.ply thick.ply --max-radius --json {options}")).expect(0);
        json(run.text())["max_radius"].as_f64().unwrap()
    };
    let [all, thick] = ["", "--near 2.3,0,0.5"].map(limit);
    assert!((0.2..2.0).contains(&all) && thick >= 0.99 * all, "{all} {thick}");
    bench
        .run(&format!("union plate.ply thin.ply thick.ply -o out.ply --overlap error --radius {}", 0.95 * all))
        .expect(0);
    bench.run("union plate.ply thin.ply -o no.ply --near 0,0,0").expect(2);
    bench.run("union plate.ply thin.ply").expect(2);
    let run = bench.run("union plate.ply thin.ply -o no.ply --radius 0.1 --longer 100").expect(4);
    assert!(run.stderr.contains("passes"), "{}", run.stderr);
}

#[test]
fn a_smooth_mesh_has_no_edges() {
    let bench = Bench::new();
    mesh_io::write(&shapes::icosphere(1.0, 3).into(), &bench.path("ball.ply")).unwrap();
    let run = bench.run("blend ball.ply -o no.ply --radius 0.1 --report r.json").expect(4);
    assert!(run.stderr.contains("40 degrees"), "{}", run.stderr);
    let report = json(&bench.read("r.json"));
    let told = &report["diagnostics"][0];
    assert_eq!((&told["code"], &report["exit_code"]), (&"no_edges".into(), &4.into()));
    let sharpest = told["numbers"]["sharpest"].as_f64().unwrap();
    assert!((5.0..40.0).contains(&sharpest) && told["remedy"].as_str().is_some_and(|r| r.contains("below")), "{told}");
}

#[test]
fn other_names_for_a_blend() {
    let bench = Bench::new();
    blend(&bench, "");
    let rounded = bench.read("out.off");
    bench.run("fillet a.off -o out.off --radius 0.1").expect(0);
    assert_eq!(bench.read("out.off"), rounded);
    blend(&bench, "--profile chamfer");
    let chamfered = bench.read("out.off");
    bench.run("chamfer a.off -o out.off --radius 0.1").expect(0);
    assert_eq!(bench.read("out.off"), chamfered);
    bench.run("chamfer a.off -o out.off --radius 0.1 --profile g2").expect(2);
}
