//! Open parts joined at the command line.

use crate::support::{Bench, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// A cup along the z axis: open at height `rim`, closed by a point at height `bottom`, `n` around.
fn cup(radius: f64, rim: f64, bottom: f64, n: usize, flipped: bool) -> String {
    let rows = 8;
    let mut text = format!("OFF\n{} {} 0\n", rows * n + 1, (2 * rows - 1) * n);
    for row in 0..rows {
        let z = rim + (bottom - rim) * row as f64 / rows as f64;
        for i in 0..n {
            let (sin, cos) = (TAU * i as f64 / n as f64).sin_cos();
            writeln!(text, "{:?} {:?} {z:?}", radius * cos, radius * sin).unwrap();
        }
    }
    writeln!(text, "0 0 {bottom:?}").unwrap();
    let up = (bottom > rim) != flipped;
    let mut face = |a: usize, b: usize, c: usize| {
        let [b, c] = if up { [b, c] } else { [c, b] };
        writeln!(text, "3 {a} {b} {c}").unwrap();
    };
    for i in 0..n {
        let j = (i + 1) % n;
        for row in 0..rows - 1 {
            let (low, high) = (row * n, (row + 1) * n);
            face(low + i, low + j, high + j);
            face(low + i, high + j, high + i);
        }
        face((rows - 1) * n + i, (rows - 1) * n + j, rows * n);
    }
    text
}

fn bench() -> Bench {
    let bench = Bench::new();
    bench.file("low.off", &cup(1.0, -0.6, -2.0, 48, false));
    bench.file("high.off", &cup(0.8, 0.6, 2.0, 40, false));
    bench
}

/// The lines of an OFF file's vertices.
fn vertices(text: &str) -> Vec<&str> {
    let count = text.lines().nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    text.lines().skip(2).take(count).collect()
}

#[test]
fn two_cups_become_one_closed_surface_and_keep_every_bit() {
    let bench = bench();
    for options in
        ["", "--kernel hermite", "--kernel biharmonic", "--method montage", "--cell 0.5", "--edge-length 0.2"]
    {
        bench.run(&format!("compose low.off high.off -o out.off --report r.json {options}")).expect(0);
        let info = json(bench.run("info out.off --json").expect(0).text());
        assert_eq!(
            (&info["genus"], &info["components"], &info["closed"]),
            (&0.into(), &1.into(), &true.into()),
            "{options}"
        );
        let (low, high, out) = (bench.read("low.off"), bench.read("high.off"), bench.read("out.off"));
        let kept: Vec<f64> =
            [vertices(&low), vertices(&high)].concat().join(" ").split(' ').map(|x| x.parse().unwrap()).collect();
        let made: Vec<f64> = vertices(&out).join(" ").split(' ').take(kept.len()).map(|x| x.parse().unwrap()).collect();
        assert_eq!(kept, made, "{options}");
        let report = json(&bench.read("r.json"));
        assert_eq!(report["kept_vertices"], kept.len() / 3);
        assert_eq!(report["quality"]["slivers"], 0, "{options}");
        assert!(report["residuals"]["field"].as_f64().unwrap() < 1e-8);
    }
}

#[test]
fn what_cannot_work_is_named() {
    let bench = bench();
    bench.file("flipped.off", &cup(0.8, 0.6, 2.0, 40, true));
    bench.file("inside.off", &cup(0.4, -1.0, -1.6, 40, false));
    bench.file("across.off", &cup(0.8, -1.0, 2.0, 40, false));
    bench.file("far.off", &cup(0.8, 40.0, 42.0, 40, false));
    for (parts, code, words) in [
        ("a.off b.off", 4, "no part has an opening"),
        ("low.off flipped.off", 4, "flipped.off is inside out"),
        ("low.off across.off --loop 0:3", 4, "there is no loop 3"),
    ] {
        let run = bench.run(&format!("compose {parts} -o none.off")).expect(code);
        assert!(run.stderr.contains(words), "{parts}: {}", run.stderr);
        assert!(!bench.path("none.off").exists());
    }
    // Far apart, a neck that would break by itself is led from opening to opening, and said to be.
    bench.run("compose low.off far.off -o far_joined.off --report far.json").expect(0);
    assert!(bench.read("far.json").contains("is led by"));
    for parts in ["low.off inside.off", "low.off across.off"] {
        let run = bench.run(&format!("compose {parts} -o none.off"));
        assert!([4, 5].contains(&run.code) && !bench.path("none.off").exists(), "{parts}: {} {}", run.code, run.stderr);
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let bench = bench();
    bench.run("compose low.off high.off -o one.off --threads 1").expect(0);
    bench.run("compose low.off high.off -o two.off --threads 2").expect(0);
    assert_eq!(bench.read("one.off"), bench.read("two.off"));
}
