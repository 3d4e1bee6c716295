//! Fillets taken back to edges.

use crate::support::{Bench, json};

#[test]
fn a_rounded_edge_becomes_sharp_again() {
    let bench = Bench::new();
    let volume =
        |file: &str| json(bench.run(&format!("info {file} --json")).expect(0).text())["volume"].as_f64().unwrap();
    bench.run("blend a.off -o round.off --radius 0.2 --near 0.5,0.5,0").expect(0);
    assert!(volume("round.off") < 0.995);
    let line = "blend round.off -o back.off --profile sharp --near 0.45,0.45,0 --report r.json";
    for radius in ["", "--radius 0.2", "--radius 12%"] {
        bench.run(&format!("{line} {radius}")).expect(0);
        assert!((volume("back.off") - 1.0).abs() < 1e-12);
    }
    let report = json(&bench.read("r.json"));
    assert_eq!((report["command"].as_str(), report["figures"]["sharpened"].as_f64()), (Some("blend"), Some(1.0)));
    assert!(report["notes"][0].as_str().unwrap().contains("length 1.000000"), "{}", report["notes"]);
    // On no fillet, a radius means a section along the nearest feature curve; without one there is nothing to do.
    bench.run("blend a.off -o same.off --profile sharp --near 0.5,0.5,0 --radius 0.2").expect(0);
    assert!((volume("same.off") - 1.0).abs() < 1e-12);
    let flat = bench.run("blend a.off -o no.off --profile sharp --near 0.5,0.1,0").expect(4);
    assert!(flat.stderr.contains("not rounded"), "{}", flat.stderr);
}

#[test]
fn what_is_no_band_is_refused() {
    let bench = Bench::new();
    bench.run("blend a.off -o round.off --radius 0.2").expect(0);
    let run = bench.run("blend round.off -o no.off --profile sharp --near 0.45,0.45,0").expect(4);
    assert!(run.stderr.contains("corners") && !bench.path("no.off").exists(), "{}", run.stderr);
    for wrong in ["--profile sharp", "--profile arc --near 0,0,0", "--near 0,0,0", "--max-radius --profile g2"] {
        let run = bench.run(&format!("blend a.off -o no.off {wrong}"));
        assert_eq!(run.code, 2, "{wrong}: {}", run.stderr);
    }
}
