//! Broken meshes made solids, crossings that inputs bring along, and attributes that survive.

use crate::support::{Bench, cube, json};
use std::fmt::Write as _;

/// A cube as OFF, each triangle with corners of its own, those of `left_out` missing.
fn shattered(left_out: &[usize]) -> String {
    let whole = cube([0.0; 3], 1.0);
    let rows: Vec<&str> = whole.lines().skip(2).collect();
    let faces: Vec<Vec<usize>> =
        rows[8..].iter().map(|row| row.split_whitespace().skip(1).map(|n| n.parse().unwrap()).collect()).collect();
    let faces: Vec<_> = faces.iter().enumerate().filter(|(i, _)| !left_out.contains(i)).map(|x| x.1).collect();
    let corners: usize = faces.iter().map(|f| f.len()).sum();
    let mut text = format!("OFF\n{corners} {} 0\n", faces.len());
    faces.iter().flat_map(|f| f.iter()).for_each(|&v| writeln!(text, "{}", rows[v]).unwrap());
    let mut next = 0;
    for face in faces {
        let ids: Vec<String> = (next..next + face.len()).map(|v| v.to_string()).collect();
        writeln!(text, "{} {}", face.len(), ids.join(" ")).unwrap();
        next += face.len();
    }
    text
}

fn both(one: &str, other: &str) -> String {
    let rows = |text: &str| text.lines().skip(2).map(String::from).collect::<Vec<_>>();
    let (one, other) = (rows(one), rows(other));
    let shifted = |row: &String| {
        let words: Vec<usize> = row.split_whitespace().map(|n| n.parse().unwrap()).collect();
        let ids: Vec<String> = words[1..].iter().map(|v| (v + 8).to_string()).collect();
        format!("{} {}", words[0], ids.join(" "))
    };
    let faces: Vec<String> = one[8..].iter().cloned().chain(other[8..].iter().map(shifted)).collect();
    format!("OFF\n16 {} 0\n{}\n{}\n{}\n", faces.len(), one[..8].join("\n"), other[..8].join("\n"), faces.join("\n"))
}

#[test]
fn a_shattered_box_is_a_solid_again_and_each_step_is_counted() {
    let bench = Bench::new();
    bench.file("soup.off", &shattered(&[]));
    let run = bench.run("repair soup.off -o solid.off --report r.json").expect(0);
    assert!(run.stderr.contains("weld: ") && run.stderr.contains("merged vertices"), "{}", run.stderr);
    let info = json(bench.run("info solid.off --json").expect(0).text());
    assert_eq!((info["vertices"].as_u64(), info["closed"].as_bool()), (Some(8), Some(true)));
    assert!((info["volume"].as_f64().unwrap() - 1.0).abs() < 1e-12);
    let report = json(&bench.read("r.json"));
    let codes: Vec<&str> =
        report["diagnostics"].as_array().unwrap().iter().map(|d| d["code"].as_str().unwrap()).collect();
    assert_eq!(codes, ["repaired"]);
    let again = bench.run("repair solid.off -o same.off").expect(0);
    assert!(again.stderr.contains("nothing to repair"), "{}", again.stderr);
    assert_eq!(bench.read("solid.off"), bench.read("same.off"));
}

#[test]
fn a_hole_is_refused_filled_or_kept() {
    let bench = Bench::new();
    bench.file("open.off", &shattered(&[0]));
    let refused = bench.run("repair open.off -o no.off --report r.json").expect(4);
    assert!(refused.stderr.contains("not closed") && refused.stderr.contains("near ["), "{}", refused.stderr);
    assert!(!bench.path("no.off").exists());
    let told = &json(&bench.read("r.json"))["diagnostics"][0];
    assert_eq!((told["code"].as_str(), told["numbers"]["loops"].as_f64()), (Some("holes"), Some(1.0)));
    assert!(told["remedy"].as_str().unwrap().contains("fill"));
    bench.run("repair open.off -o kept.off --holes keep").expect(0);
    let filled = bench.run("repair open.off -o filled.off --holes fill").expect(0);
    assert!(filled.stderr.contains("holes: 1 holes filled"), "{}", filled.stderr);
    let info = json(bench.run("info filled.off --json").expect(0).text());
    assert_eq!((info["closed"].as_bool(), info["self_intersections"].as_u64()), (Some(true), Some(0)));
    // A single triangle bounds nothing.
    bench.file("sheet.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    let sheet = bench.run("repair sheet.off -o no.off --holes fill").expect(4);
    assert!(sheet.stderr.contains("no surface fills 1 of them"), "{}", sheet.stderr);
    bench.run("repair open.off -o no.off --gap -1").expect(2);
    bench.run("repair open.off -o no.off --holes drill").expect(2);
}

/// Two boxes in one file cross each other, far from where a third one is joined.
#[test]
fn crossings_that_an_input_brings_along_are_counted_and_named() {
    let bench = Bench::new();
    bench.file("two.off", &both(&cube([0.0; 3], 1.0), &cube([0.7, 0.6, 0.55], 1.0)));
    bench.file("far.off", &cube([-0.4, -0.3, -0.45], 0.4));
    let info = json(bench.run("info two.off --json").expect(0).text());
    let count = info["self_intersections"].as_u64().unwrap();
    assert!(count > 0);
    for line in
        ["union two.off far.off -o out.off", "remesh two.off -o out.off --edge-length 0.9", "repair two.off -o out.off"]
    {
        let run = bench.run(&format!("{line} --report r.json"));
        if line.starts_with("remesh") && run.code == 5 {
            continue;
        }
        let run = run.expect(0);
        let report = json(&bench.read("r.json"));
        let own = json(bench.run("info out.off --json").expect(0).text());
        assert_eq!(report["validity"]["self_intersections"], own["self_intersections"], "{line}");
        let inherited = &report["inherited"][0];
        assert_eq!(
            (inherited["part"].as_u64(), inherited["count"].as_u64()),
            (Some(0), own["self_intersections"].as_u64())
        );
        assert!(!inherited["places"].as_array().unwrap().is_empty());
        assert!(run.stderr.contains("two.off crosses itself"), "{line}: {}", run.stderr);
        bench.run(&format!("{line} --strict")).expect(4);
    }
    // Without crossings there is nothing to tell.
    bench.run("union a.off b.off -o out.off --report r.json --strict").expect(0);
    assert_eq!(json(&bench.read("r.json"))["inherited"].as_array().unwrap().len(), 0);
}

/// Red and blue boxes keep their colours through a blended union, in every format that has colours.
#[test]
fn colours_survive_into_obj_and_ply() {
    let bench = Bench::new();
    let painted = |off: &str, color: &str| {
        let rows: Vec<&str> = off.lines().skip(2).collect();
        let head = format!(
            "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
            rows.len() - 8
        );
        let vertices: Vec<String> = rows[..8].iter().map(|row| format!("{row} {color}")).collect();
        format!("{head}{}\n{}\n", vertices.join("\n"), rows[8..].join("\n"))
    };
    bench.file("red.ply", &painted(&cube([0.0; 3], 1.0), "255 0 0"));
    bench.file("blue.ply", &painted(&cube([0.4, 0.3, 0.2], 1.0), "0 0 255"));
    for verb in ["union red.ply blue.ply", "union red.ply blue.ply --radius 0.05", "blend red.ply --radius 0.1"] {
        bench.run(&format!("{verb} -o out.obj")).expect(0);
        let text = bench.read("out.obj");
        let colors: Vec<Vec<f64>> = text
            .lines()
            .filter(|line| line.starts_with("v "))
            .map(|line| line.split_whitespace().skip(4).map(|x| x.parse().unwrap()).collect())
            .collect();
        let mixes = |c: &Vec<f64>| c.len() == 3 && c[1].abs() < 1e-9 && (c[0] + c[2] - 1.0).abs() < 1e-9;
        assert!(colors.iter().all(mixes), "{verb}: {:?}", colors.iter().find(|c| !mixes(c)));
        bench.run(&format!("{verb} -o out.ply")).expect(0);
        bench.run("convert out.ply -o back.obj").expect(0);
        assert!(bench.read("back.obj").lines().filter(|l| l.starts_with("v ")).all(|l| l.split(' ').count() == 7));
    }
}

#[test]
fn a_scan_is_no_polyhedron_to_cluster() {
    let bench = Bench::new();
    // A torus of 24 × 48 quadrilaterals, bent enough that none of them is planar with the next.
    let at = |i: usize, j: usize| {
        let turn = std::f64::consts::TAU;
        let (u, v) = (i as f64 / 48.0 * turn, j as f64 / 24.0 * turn);
        [(2.0 + v.cos()) * u.cos(), (2.0 + v.cos()) * u.sin(), v.sin()]
    };
    let mut text = String::from("OFF\n1152 2304 0\n");
    (0..48).flat_map(|i| (0..24).map(move |j| at(i, j))).for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").unwrap());
    for (i, j) in (0..48).flat_map(|i| (0..24).map(move |j| (i, j))) {
        let id = |i: usize, j: usize| i % 48 * 24 + j % 24;
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        writeln!(text, "3 {a} {b} {c}\n3 {a} {c} {d}").unwrap();
    }
    bench.file("torus.off", &text);
    let start = std::time::Instant::now();
    let run = bench.run("cluster torus.off -o no.off").expect(4);
    assert!(run.stderr.contains("1152 vertices") && run.stderr.contains("`blend`"), "{}", run.stderr);
    assert!(start.elapsed().as_secs() < 10);
}
