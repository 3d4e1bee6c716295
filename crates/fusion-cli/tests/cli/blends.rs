//! What each option of a blend changes.

use crate::support::{Bench, Run, cube, json};
use fusion::mesh_core::shapes;
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_4, PI};
use std::fmt::Write as _;

const RADIUS: f64 = 0.2;

/// A drum of radius 1 and height 2: both rims are closed feature curves.
fn drum() -> String {
    let n = 96;
    let mut text = format!("OFF\n{} {} 0\n0 0 -1\n0 0 1\n", 2 * n + 2, 4 * n);
    for z in [-1, 1] {
        for i in 0..n {
            let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos();
            writeln!(text, "{cos:?} {sin:?} {z}").unwrap();
        }
    }
    for i in 0..n {
        let j = (i + 1) % n;
        let [a, b, c, d] = [2 + i, 2 + j, 2 + n + j, 2 + n + i];
        writeln!(text, "3 {a} {b} {c}\n3 {a} {c} {d}\n3 0 {b} {a}\n3 1 {d} {c}").unwrap();
    }
    text
}

/// A folder with the drum.
fn bench() -> Bench {
    let bench = Bench::new();
    bench.file("drum.off", &drum());
    bench
}

fn blend(bench: &Bench, options: &str) -> Run {
    bench.run(&format!("blend drum.off -o out.off --radius {RADIUS} --report r.json {options}"))
}

fn volume(bench: &Bench, file: &str) -> f64 {
    json(bench.run(&format!("info {file} --json")).expect(0).text())["volume"].as_f64().unwrap()
}

/// What a blend of both rims took away, and how many faces it left.
fn taken(bench: &Bench, options: &str) -> (f64, u64) {
    blend(bench, options).expect(0);
    let faces = json(&bench.read("r.json"))["output"]["faces"].as_u64().unwrap();
    (volume(bench, "drum.off") - volume(bench, "out.off"), faces)
}

/// Pappus: what is taken from a rim is its section's area times the way of the section's centroid. `moment` is the
/// area's moment about the side of the drum, for a radius of 1.
fn pappus(area: f64, moment: f64) -> f64 {
    2.0 * 2.0 * PI * (area * RADIUS.powi(2) - moment * RADIUS.powi(3))
}

/// What is open stays open, by as many loops.
#[test]
fn an_open_box_is_blended() {
    let bench = Bench::new();
    let open: String = cube([0.0; 3], 1.0).replace("8 12 0", "8 10 0").lines().take(20).collect::<Vec<_>>().join("\n");
    bench.file("open.off", &open);
    bench.run("blend open.off -o out.off --radius 0.1 --report r.json").expect(0);
    assert_eq!(json(&bench.read("r.json"))["validity"]["closed"], false);
    let info = json(bench.run("info out.off --json").expect(0).text());
    assert_eq!((info["boundary_loops"].as_array().map(Vec::len), &info["self_intersections"]), (Some(1), &0.into()));
}

#[test]
fn profiles_take_away_what_they_should() {
    let bench = bench();
    let take = |profile: &str| taken(&bench, &format!("--profile {profile}")).0;
    let [chamfer, flat, arc, g2, bulging, sharp] = ["chamfer", "conic=0.5", "arc", "g2", "conic=2", "sharp"].map(take);
    let near = |x: f64, truth: f64| (x / truth - 1.0).abs() < 0.01;
    assert!(near(chamfer, pappus(0.5, 1.0 / 6.0)), "{chamfer}");
    assert!(sharp.abs() < 0.01 * arc, "{sharp}");
    assert!(chamfer > flat && flat > 1.1 * arc && arc > 1.1 * bulging && bulging > sharp, "{flat} {arc} {bulging}");
    assert!(g2 < 0.99 * arc && g2 > bulging, "{g2}");
    assert!((take("conic=1") / arc - 1.0).abs() < 1e-3);
}

/// A chamfer's vertices lie on the cone through both linkages.
#[test]
fn a_chamfer_is_flat_across() {
    let bench = bench();
    let off_the_cone = |profile: &str| {
        blend(&bench, &format!("--profile {profile} --origins o.json")).expect(0);
        let origins = json(&bench.read("o.json"));
        let text = bench.read("out.off");
        let made = text.lines().skip(2).zip(origins["vertices"].as_array().unwrap()).filter(|(_, o)| o[0] == "new");
        let heights = made.map(|(line, _)| {
            let p: Vec<f64> = line.split_whitespace().map(|x| x.parse().unwrap()).collect();
            (p[0].hypot(p[1]) + p[2].abs() - (2.0 - RADIUS)).abs() / 2f64.sqrt()
        });
        heights.fold(0.0, f64::max)
    };
    assert!(off_the_cone("chamfer") < 0.01 * RADIUS);
    // A quarter circle's middle stands 1 − √2 / 2 of the radius off its chord.
    let arc = off_the_cone("arc");
    assert!((arc / RADIUS - (1.0 - 0.5f64.sqrt())).abs() < 0.02, "{arc}");
}

#[test]
fn a_finer_tolerance_gives_more_faces_nearer_to_the_arc() {
    let bench = bench();
    let (coarse, fine) = (taken(&bench, ""), taken(&bench, "--tolerance 2e-4"));
    assert!(fine.1 > 2 * coarse.1, "{coarse:?} {fine:?}");
    // The square less the quarter disc about its inner corner, whose centroid is 4 / 3π from there.
    let truth = pappus(1.0 - FRAC_PI_4, 0.5 - FRAC_PI_4 + 1.0 / 3.0);
    let [coarse, fine] = [coarse.0, fine.0].map(|taken| taken / truth - 1.0);
    assert!((0.01..0.04).contains(&coarse) && fine.abs() < 0.01, "{coarse} {fine}");
}

/// Ten times the reach gives the ball more to look at, and nothing else to touch.
#[test]
fn a_longer_reach_changes_no_byte() {
    let bench = bench();
    blend(&bench, "").expect(0);
    let plain = bench.read("out.off");
    blend(&bench, "--alpha 4 --surface stitch").expect(0);
    assert_eq!(bench.read("out.off"), plain);
}

/// On balls the offset facets are off by their sagitta, and the exact contact is not.
#[test]
fn the_offset_spine_is_near_and_the_contact_spine_exact() {
    let bench = bench();
    for (name, x, radius) in [("big.ply", 0.0, 1.0), ("small.ply", 1.1, 0.6)] {
        let ball = shapes::posed(shapes::icosphere(radius, 4), DQuat::IDENTITY, DVec3::new(x, 0.02, 0.03));
        mesh_io::write(&ball.into(), &bench.path(name)).unwrap();
    }
    let run = |spine: &str| {
        bench
            .run(&format!("union big.ply small.ply -o out.off --radius 0.1 --report r.json --spine {spine}"))
            .expect(0);
        (volume(&bench, "out.off"), json(&bench.read("r.json"))["residuals"]["contact"].as_f64().unwrap())
    };
    let (contact, offset) = (run("contact"), run("offset"));
    assert!(contact.1 <= 1e-9 && (1e-6..0.1).contains(&offset.1), "{contact:?} {offset:?}");
    assert!((contact.0 / offset.0 - 1.0).abs() < 1e-3 && contact.0 != offset.0, "{contact:?} {offset:?}");
}

/// A ball of 0.3 reaches beyond the boxes' short sides.
#[test]
fn a_ball_that_does_not_fit_shrinks_or_stops() {
    let bench = bench();
    let line = "union a.off b.off -o out.off --radius 0.3 --report r.json";
    let run = bench.run(&format!("{line} --overlap shrink")).expect(0);
    let report = json(&bench.read("r.json"));
    let figure = |name: &str| report["figures"][name].as_f64().unwrap();
    let warnings: Vec<&str> = report["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
    let shrunk = warnings.iter().filter(|w| w.contains("a ball of radius 0.3 does not fit near")).count();
    assert!(shrunk > 0 && figure("shrunk_places") == shrunk as f64, "{warnings:?}");
    assert!(warnings.iter().all(|w| run.stderr.contains(w)));
    assert!((0.03..0.3).contains(&figure("smallest_radius")), "{}", figure("smallest_radius"));
    // The smallest along the seam is where two such places overlap.
    let told = report["diagnostics"].as_array().unwrap().iter().filter(|d| d["code"] == "radius_reduced");
    let least = told.map(|d| d["numbers"]["used"].as_f64().unwrap()).fold(f64::INFINITY, f64::min);
    assert!((0.8..=1.0).contains(&(figure("smallest_radius") / least)), "{least} {}", report["figures"]);
    assert!((0.0..1.0).contains(&figure("full_share")), "{}", figure("full_share"));

    let bench = self::bench();
    let run = bench.run(&format!("{line} --overlap error")).expect(4);
    assert!(run.stderr.contains("with radius 0.3; a radius of 0.15 works"), "{}", run.stderr);
    assert!(!bench.path("out.off").exists());
    // What fits has nothing to say.
    bench.run("union a.off b.off -o out.off --radius 0.1 --overlap error --report r.json").expect(0);
    let figures = &json(&bench.read("r.json"))["figures"];
    let values = ["full_share", "smallest_radius", "shrunk_places"].map(|f| figures[f].as_f64().unwrap());
    assert_eq!(values, [1.0, 0.1, 0.0]);
}

/// Of many places with one trouble three are printed, and how many more there are; the report has all.
#[test]
fn many_warnings_of_one_kind_are_counted() {
    let bench = Bench::new();
    let row = |shift: [f64; 3]| {
        let cubes: Vec<String> =
            (0..4).map(|i| cube([shift[0] + 3.0 * f64::from(i), shift[1], shift[2]], 1.0)).collect();
        let lines = |from: usize, to: usize| cubes.iter().map(move |c| c.lines().skip(from).take(to - from));
        let points: Vec<&str> = lines(2, 10).flatten().collect();
        let mut text = format!("OFF\n32 48 0\n{}\n", points.join("\n"));
        for (i, faces) in lines(10, 22).enumerate() {
            for face in faces {
                let ids = face.split(' ').skip(1).map(|v| (v.parse::<usize>().unwrap() + 8 * i).to_string());
                writeln!(text, "3 {}", ids.collect::<Vec<_>>().join(" ")).unwrap();
            }
        }
        text
    };
    bench.file("row.off", &row([0.0; 3]));
    bench.file("beside.off", &row([0.4, 0.3, 0.2]));
    let line = "union row.off beside.off -o out.off --radius 0.3 --overlap shrink --report r.json";
    let run = bench.run(line).expect(0);
    let report = json(&bench.read("r.json"));
    let warnings: Vec<&str> = report["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
    let said: Vec<&str> = run.stderr.lines().collect();
    assert!(warnings.len() > 4 && said.len() == 4, "{warnings:?} {said:?}");
    for (said, warning) in said.iter().zip(&warnings).take(3) {
        assert_eq!(*said, format!("warning: {warning}"));
    }
    let more = warnings.len() - 3;
    assert_eq!(
        said[3],
        format!("warning: a ball of radius 0.3 does not fit at {more} more places, which --report lists")
    );
    assert!(bench.run(&format!("{line} --quiet")).expect(0).stderr.is_empty());
}

#[test]
fn wrong_options_say_what_is_right() {
    let bench = bench();
    for (options, words) in [
        ("--profile round", "conic=W"),
        ("--profile conic=-1", "conic=W"),
        ("--surface wrap", "a surface is"),
        ("--spine paper", "offset"),
        ("--overlap cut", "shrink"),
        ("--alpha 0", "from 1 to 16"),
        ("--tolerance 0", "from 1e-6 to 0.5"),
        ("--tolerance nan", "from 1e-6 to 0.5"),
    ] {
        let run = blend(&bench, options).expect(2);
        assert!(run.stderr.contains(words), "{options}: {}", run.stderr);
        assert!(!bench.path("out.off").exists());
    }
}

#[test]
fn blend_options_need_a_radius() {
    let bench = bench();
    for options in
        ["--profile arc", "--overlap shrink", "--spine offset", "--surface stitch", "--alpha 2", "--tolerance 0.01"]
    {
        for verb in ["union", "difference", "intersection"] {
            let run = bench.run(&format!("{verb} a.off b.off -o out.off {options}")).expect(2);
            assert!(run.stderr.contains("--radius"), "{options}: {}", run.stderr);
        }
    }
}

/// Vertices slide onto the blend: the faces are those of the input, in order, and the section is the file's.
#[test]
fn keep_moves_vertices_alone() {
    let bench = Bench::new();
    let off = |mesh: &fusion::mesh_core::TriMesh| {
        let mut text = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.faces.len());
        mesh.positions.iter().for_each(|p| writeln!(text, "{:?} {:?} {:?}", p.x, p.y, p.z).unwrap());
        mesh.faces.iter().for_each(|f| writeln!(text, "3 {} {} {}", f[0], f[1], f[2]).unwrap());
        text
    };
    let ball = |z: f64| shapes::posed(shapes::geodesic_sphere(1.0, 20), DQuat::from_rotation_x(0.4 + z), DVec3::Z * z);
    bench.file("a.off", &off(&ball(-0.6)));
    bench.file("b.off", &off(&ball(0.6)));
    bench.file("line.toml", "degree = 1\npoints = [[1, 0], [0, 1]]");
    bench.run("union a.off b.off -o joined.off").expect(0);
    let faces =
        |name: &str| bench.read(name).lines().filter(|l| l.starts_with("3 ")).map(String::from).collect::<Vec<_>>();
    let seam = "--near 0.8,0,0 --angle 25";
    for options in ["", "--profile line.toml", "--profile conic=2,reach=1.5"] {
        bench.run(&format!("blend joined.off -o kept.off --radius 0.25 --surface keep {seam} {options}")).expect(0);
        assert_eq!(faces("kept.off"), faces("joined.off"));
    }
    bench.run("union a.off b.off -o once.off --radius 0.25 --surface keep").expect(0);
    assert!(volume(&bench, "once.off") > volume(&bench, "joined.off"));
    // The drum has no vertices between its rims and the middles of its caps.
    bench.file("drum.off", &drum());
    let refused = blend(&bench, "--surface keep").expect(4);
    assert!(refused.stderr.contains("ring") && refused.stderr.contains("stitch"), "{}", refused.stderr);
    let missing = bench.run(&format!("blend joined.off -o no.off --radius 0.2 {seam} --profile none.json")).expect(3);
    assert!(missing.stderr.contains("none.json"));
}

/// A drum of radius 1 and height 2 with even triangles, on its caps, too.
fn even_drum() -> String {
    let (around, caps, rows) = (160, 30, 60);
    let cap = |z: f64| (1..caps).map(move |k| (f64::from(k) / f64::from(caps), z));
    let wall = (0..=rows).map(|k| (1.0, 2.0 * f64::from(k) / f64::from(rows) - 1.0));
    let rings: Vec<(f64, f64)> = cap(-1.0).chain(wall).chain(cap(1.0).rev()).collect();
    let last = around * (2 * (caps - 1) + rows);
    let faces = 2 * (last + around);
    let mut text = format!("OFF\n{} {faces} 0\n", last + around + 2);
    for &(r, z) in &rings {
        for i in 0..around {
            let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(around)).sin_cos();
            writeln!(text, "{:?} {:?} {z:?}", r * cos, r * sin).unwrap();
        }
    }
    text += "0 0 -1\n0 0 1\n";
    for i in 0..around {
        let j = (i + 1) % around;
        for a in (0..last).step_by(around as usize) {
            let b = a + around;
            writeln!(text, "3 {} {} {}\n3 {} {} {}", a + i, a + j, b + j, a + i, b + j, b + i).unwrap();
        }
        let [low, high] = [last + around, last + around + 1];
        writeln!(text, "3 {low} {j} {i}\n3 {high} {} {}", last + i, last + j).unwrap();
    }
    text
}

/// On a coarser level the same triangles come out, with those away from the blend untouched, and about the same shape.
#[test]
fn multiresolution_keeps_triangles_and_details() {
    let bench = Bench::new();
    bench.file("drum.off", &even_drum());
    let line = "blend drum.off --radius 0.4 --surface keep --near 1,0,1 --report r.json";
    bench.run(&format!("{line} -o fine.off")).expect(0);
    bench.run(&format!("{line} -o coarse.off --multiresolution")).expect(0);
    let report = json(&bench.read("r.json"));
    assert!(report["figures"]["levels"].as_f64().is_some_and(|n| n >= 1.0), "{}", report["figures"]);
    let rows = |name: &str| bench.read(name).lines().skip(2).map(String::from).collect::<Vec<_>>();
    let point = |row: &String| row.split(' ').map(|x| x.parse::<f64>().unwrap()).collect::<Vec<_>>();
    let [before, after] = ["drum.off", "coarse.off"].map(rows);
    let mut moved = 0;
    for (a, b) in before.iter().zip(&after) {
        if a.starts_with("3 ") {
            assert_eq!(a, b);
        } else if point(a) != point(b) {
            moved += 1;
            let [x, y, z] = [0, 1, 2].map(|k| point(a)[k]);
            assert!(z > 0.4 && (x.hypot(y) > 0.4 || z < 1.0), "{a}");
        }
    }
    assert!(moved > 1000 && before.len() == after.len(), "{moved}");
    let [plain, fine, coarse] = ["drum.off", "fine.off", "coarse.off"].map(|f| volume(&bench, f));
    assert!(((coarse - plain) / (fine - plain) - 1.0).abs() < 0.05, "{plain} {fine} {coarse}");
    let wrong = bench.run("blend drum.off -o no.off --radius 0.3 --multiresolution --surface stitch").expect(2);
    assert!(wrong.stderr.contains("keep"), "{}", wrong.stderr);
}
