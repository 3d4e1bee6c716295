//! Geometry detail at the command line.

use crate::support::{Bench, json};
use std::fmt::Write as _;

/// A wavy square of side 2 with a smooth disc of radius `smooth` in its middle.
fn plane(smooth: f64) -> String {
    let n = 60usize;
    let mut text = format!("OFF\n{} {} 0\n", (n + 1) * (n + 1), 2 * n * n);
    for j in 0..=n {
        for i in 0..=n {
            let [x, y] = [i, j].map(|k| 2.0 * k as f64 / n as f64 - 1.0);
            let wave = 0.015 * ((24.0 * x + 3.0 * y).sin() + (22.0 * y - 5.0 * x).sin());
            let z = if x.hypot(y) < smooth { 0.0 } else { wave };
            writeln!(text, "{x:?} {y:?} {z:?}").unwrap();
        }
    }
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            writeln!(text, "3 {a} {} {}\n3 {a} {} {}", a + 1, a + n + 2, a + n + 2, a + n + 1).unwrap();
        }
    }
    text
}

fn bench() -> Bench {
    let bench = Bench::new();
    bench.file("holed.off", &plane(0.4));
    bench.file("whole.off", &plane(0.0));
    bench
}

#[test]
fn a_smooth_region_gets_detail_from_its_own_mesh_or_another() {
    let bench = bench();
    for options in [
        "--source near=0.7,0.7,0,0.6",
        "--source whole.off:near=0,0,0,0.7",
        "--source near=0,0,0,0.95 --along -0.9,0,0 0.9,0,0 --width 0.9 --spacing 0.2",
        "--source near=0.7,0.7,0,0.6 --intensity -1 --fan 0.1 --search exhaustive",
    ] {
        bench
            .run(&format!(
                "detail holed.off -o out.off --target near=0,0,0,0.42 --wavelength 0.6 {options} --report r.json --origins o.json"
            ))
            .expect(0);
        let report = json(&bench.read("r.json"));
        let figure = |name: &str| report["figures"][name].as_f64().unwrap();
        assert!(figure("roughness_before") < figure("roughness"), "{options}");
        let ratio = figure("roughness") / figure("roughness_source");
        assert!((0.4..1.6).contains(&ratio), "{options}: {ratio}");
        assert_eq!(report["validity"]["self_intersections"], 0);
        // All but the moved vertices are there to the last digit.
        let (before, after) = (bench.read("holed.off"), bench.read("out.off"));
        let numbers = |line: &str| line.split(' ').map(|x| x.parse::<f64>().unwrap()).collect::<Vec<_>>();
        let vertices = before.lines().zip(after.lines()).skip(2).take(3721);
        let moved = vertices.filter(|(a, b)| numbers(a) != numbers(b)).count();
        assert!(moved as f64 <= figure("filled") && moved > 100, "{options}: {moved}");
        assert_eq!(report["kept_vertices"].as_f64().unwrap() + figure("filled"), 3721.0);
        assert_eq!(json(&bench.read("o.json"))["vertices"].as_array().unwrap().len(), 3721);
    }
}

#[test]
fn what_cannot_be_done_is_said() {
    let bench = bench();
    let target = "--target near=0,0,0,0.42";
    for (line, code, says) in [
        (format!("detail holed.off -o out.off {target}"), 2, "--source"),
        (format!("detail holed.off -o out.off {target} --source near=1,2"), 2, "near="),
        (format!("detail holed.off -o out.off {target} --source group=skin"), 4, "skin"),
        (format!("detail holed.off -o out.off {target} --source missing.off:near=0,0,0,1"), 3, "missing.off"),
        (format!("detail holed.off -o out.off {target} --source near=0.9,0.9,0,0.1 --fan 1"), 4, "neighbourhood"),
        (
            format!(
                "detail holed.off -o out.off {target} --source near=0.7,0.7,0,0.6 --along 0.6,0.9,0 0.9,0.9,0 --width 0.1"
            ),
            4,
            "anchors",
        ),
    ] {
        let run = bench.run(&line).expect(code);
        assert!(run.stderr.contains(says), "{line}: {}", run.stderr);
        assert!(!bench.path("out.off").exists());
    }
}
