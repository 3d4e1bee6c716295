//! `cluster` as a user runs it.

use crate::support::{Bench, json};

/// A slab of 3 × 2 × 0.6, as polygons; its short edges are 0-4, 1-5, 2-6, 3-7.
const SLAB: &str = "OFF\n8 6 0\n0 0 0\n3 0 0\n3 2 0\n0 2 0\n0 0 0.6\n3 0 0.6\n3 2 0.6\n0 2 0.6\n\
    4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.file("slab.off", SLAB);
    bench.file(
        "pairs.toml",
        "version = 1\n[[cluster]]\nvertices = [0, 4]\ndegree = [4, 2]\n[[cluster]]\nvertices = [1, 5]\n",
    );
    bench
}

#[test]
fn a_slab_is_rounded_by_four_patches() {
    let bench = bench();
    bench.run("cluster slab.off -o out.ply --report r.json --nets n.json --tolerance 1e-3").expect(0);
    let info = json(bench.run("info out.ply --json").expect(0).text());
    assert_eq!((&info["closed"], &info["self_intersections"], &info["genus"]), (&true.into(), &0.into(), &0.into()));
    let volume = info["volume"].as_f64().unwrap();
    assert!(volume > 0.6 * 3.6 && volume < 3.6, "{volume}");
    let (report, nets) = (json(&bench.read("r.json")), json(&bench.read("n.json")));
    assert_eq!((&report["figures"]["patches"], &report["figures"]["strips"]), (&4.0.into(), &8.0.into()));
    assert!(report["figures"]["contact_slope"].as_f64().unwrap() > 1.95);
    assert!(report["notes"].as_array().unwrap().len() >= 2);
    assert_eq!(nets["patches"].as_array().map(Vec::len), Some(4));
    assert_eq!(nets["patches"][0]["points"].as_array().map(Vec::len), Some(16));
}

/// Clusters from a file: vertices in none stay where they are, bit for bit.
#[test]
fn named_clusters_leave_other_vertices() {
    let bench = bench();
    bench.run("cluster slab.off -o out.ply --clusters pairs.toml --report r.json --origins o.json").expect(0);
    let (report, origins) = (json(&bench.read("r.json")), json(&bench.read("o.json")));
    assert_eq!((&report["figures"]["patches"], &report["kept_vertices"]), (&2.0.into(), &4.into()));
    let kept = origins["vertices"].as_array().unwrap().iter().filter(|o| o[0] == "input").map(|o| o[2].as_u64());
    assert_eq!(kept.collect::<Vec<_>>(), [Some(2), Some(3), Some(6), Some(7)]);
}

#[test]
fn groups_name_patches_strips_and_faces() {
    let bench = bench();
    bench.run("cluster slab.off -o out.obj --tolerance 0.01 --sharp 0-1").expect(0);
    let text = bench.read("out.obj");
    let count = |what: &str| text.lines().filter(|l| l.starts_with(&format!("g {what}_"))).count();
    assert_eq!((count("face"), count("patch"), count("strip")), (6, 4, 7));
}

#[test]
fn threads_do_not_change_a_byte() {
    let bench = bench();
    for threads in [1, 3] {
        bench.run(&format!("cluster slab.off -o out{threads}.ply --threads {threads} --continuity 2")).expect(0);
    }
    assert!(std::fs::read(bench.path("out1.ply")).unwrap() == std::fs::read(bench.path("out3.ply")).unwrap());
}

#[test]
fn what_cannot_be_is_refused_and_leaves_no_file() {
    let bench = bench();
    bench.run("info a.off").expect(0);
    bench.file("twice.toml", "version = 1\n[[cluster]]\nvertices = [0]\n[[cluster]]\nvertices = [0]\n");
    bench.file("apart.toml", "version = 1\n[[cluster]]\nvertices = [0, 6]\n");
    bench.file("ring.toml", "version = 1\n[[cluster]]\nvertices = [0, 1, 2, 3]\n");
    bench.file("bent.off", &SLAB.replace("3 2 0.6", "3 2 0.9"));
    bench.file("bad.toml", "version = 1\n[[cluster]]\nvertex = 3\n");
    let before = bench.files();
    for (line, code, words) in [
        ("cluster slab.off -o out.ply --degree 2", 4, "degree 3,2 works"),
        ("cluster slab.off -o out.ply --continuity 2 --degree 4,4", 4, "works"),
        ("cluster slab.off -o out.ply --clusters twice.toml", 4, "two clusters"),
        ("cluster slab.off -o out.ply --clusters apart.toml", 4, "tree"),
        ("cluster slab.off -o out.ply --clusters ring.toml", 4, "ring"),
        ("cluster slab.off -o out.ply --sharp 0-6", 4, "no edge"),
        ("cluster bent.off -o out.ply", 4, "not planar"),
        ("cluster slab.off -o out.ply --clusters bad.toml", 3, "bad.toml"),
        ("cluster slab.off -o out.ply --clusters none.toml", 3, "none.toml"),
        ("cluster slab.off -o out.ply --extent 1.5", 2, "(0, 1]"),
        ("cluster slab.off -o out.ply --degree x", 2, "whole number"),
        ("cluster slab.off -o out.ply --mu 1", 2, "(0, 1)"),
        ("cluster slab.off -o out.ply --nets out.ply", 2, "nets"),
        ("cluster slab.off -o out.ply --continuity 0", 2, "1 to 8"),
    ] {
        let run = bench.run(line).expect(code);
        assert!(run.stderr.contains(words), "{line}: {}", run.stderr);
        assert_eq!(bench.files(), before, "{line}");
    }
}
