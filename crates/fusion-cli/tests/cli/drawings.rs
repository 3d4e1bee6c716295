//! What `--debug-geometry` leaves behind.

use crate::support::{Bench, json};
use fusion::mesh_core::shapes;
use glam::{DQuat, DVec3};
use std::collections::BTreeSet;

/// The points of a drawing.
fn points(bench: &Bench, file: &str) -> Vec<[f64; 3]> {
    let text = bench.read(file);
    let point = |line: &str| {
        let x: Vec<f64> = line[2..].split(' ').map(|x| x.parse().unwrap()).collect();
        [x[0], x[1], x[2]]
    };
    text.lines().filter(|l| l.starts_with("v ")).map(point).collect()
}

/// Names in the folder, and in its list.
fn listed(bench: &Bench, folder: &str) -> BTreeSet<String> {
    let found = std::fs::read_dir(bench.path(folder)).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let found: BTreeSet<String> = found.filter(|n| n != "contents.txt").collect();
    let list = bench.read(&format!("{folder}/contents.txt"));
    assert_eq!(list.lines().map(|l| l.split(' ').next().unwrap().to_string()).collect::<BTreeSet<_>>(), found);
    found
}

#[test]
fn a_blend_shows_its_stages_and_is_the_same() {
    let bench = Bench::new();
    bench.run("union a.off b.off -o plain.off --radius 0.1").expect(0);
    bench.run("union a.off b.off -o drawn.off --radius 0.1 --debug-geometry new/folder").expect(0);
    assert_eq!(bench.read("plain.off"), bench.read("drawn.off"));
    let names = ["edges", "linkage-left", "linkage-right", "patch-left", "patch-right", "profiles", "spine", "strip"];
    let expected = names.iter().map(|n| format!("curve-0-{n}.obj")).collect::<BTreeSet<_>>();
    assert_eq!(listed(&bench, "new/folder"), expected);
    // Outside both boxes, and as far from one of them as the ball is large.
    let distance = |p: [f64; 3], center: [f64; 3]| {
        let out = [0, 1, 2].map(|k| ((p[k] - center[k]).abs() - 0.5).max(0.0));
        out.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    for p in points(&bench, "new/folder/curve-0-spine.obj") {
        for center in [[0.0; 3], [0.4, 0.3, 0.2]] {
            assert!((distance(p, center) - 0.1).abs() < 1e-3, "{p:?}");
        }
    }
    let strip = json(bench.run("info new/folder/curve-0-strip.obj --json").expect(0).text());
    assert!(strip["faces"].as_u64().or(strip["triangles"].as_u64()).is_some_and(|n| n > 100), "{strip}");
    let first = points(&bench, "new/folder/curve-0-profiles.obj");
    assert!(first.len() > 100 && bench.read("new/folder/curve-0-profiles.obj").contains("\nl "));
}

#[test]
fn a_refused_blend_shows_how_far_it_came() {
    let bench = Bench::new();
    bench.run("blend a.off -o no.off --radius 0.7 --overlap error --debug-geometry d").expect(4);
    let found = listed(&bench, "d");
    for name in ["curve-11-edges.obj", "curve-3-spine.obj", "curve-3-patch-left.obj", "refused-places.obj"] {
        assert!(found.contains(name), "{name}: {found:?}");
    }
    assert!(!bench.path("no.off").exists());
    // Vertices that are moved have a domain to look at.
    let ball = |z: f64| shapes::posed(shapes::geodesic_sphere(1.0, 20), DQuat::from_rotation_x(0.4 + z), DVec3::Z * z);
    for (name, z) in [("low.ply", -0.6), ("high.ply", 0.6)] {
        mesh_io::write(&ball(z).into(), &bench.path(name)).unwrap();
    }
    bench.run("union low.ply high.ply -o kept.off --radius 0.25 --surface keep --debug-geometry k").expect(0);
    let found = listed(&bench, "k");
    assert!(["curve-0-region.obj", "curve-0-profiles.obj"].iter().all(|n| found.contains(*n)), "{found:?}");
    let domain = points(&bench, "k/curve-0-domain.obj");
    assert!(domain.len() > 100 && domain.iter().all(|p| p[2] == 0.0));
}

#[test]
fn a_folder_that_cannot_be_is_told_before_the_work() {
    let bench = Bench::new();
    bench.file("file", "");
    let run = bench.run("union a.off b.off -o no.off --radius 0.1 --debug-geometry file").expect(6);
    assert!(run.stderr.contains("file") && !bench.path("no.off").exists(), "{}", run.stderr);
    bench.run("union a.off b.off -o no.off --debug-geometry d").expect(2);
    assert!(!bench.path("d").exists());
}
