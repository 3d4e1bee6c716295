//! Broken input to every verb: a valid result or exit code 3, 4 or 5 with a sentence, and no file left behind.

use crate::support::Bench;
use fusion::mesh_core::{TriMesh, VertexId, shapes, validate};
use glam::DVec3;
use mesh_io::{Format, Model};
use std::fs;

/// Every verb, IN being the broken file; the others are sound.
const VERBS: [&str; 17] = [
    "info IN",
    "info IN --json",
    "convert IN -o out.ply",
    "convert IN -o out.ply --weld 1% --orient --split",
    "features IN",
    "union IN post.ply -o out.ply",
    "difference post.ply IN -o out.ply",
    "intersection IN post.ply -o out.ply --radius 1%",
    "blend IN -o out.ply --radius 3%",
    "blend IN --max-radius",
    "cut IN -o out.ply --plane 0.1,0.05,0.02,1,0.2,0.1",
    "compose IN cap.ply -o out.ply",
    "detail IN -o out.ply --target near=1,0,0,0.8 --source near=-1,0,0,0.9",
    "cluster IN -o out.ply",
    "remesh IN -o out.ply --edge-length 0.3",
    "remesh IN -o out.ply --smooth taubin",
    "render IN -o out.png --size 48",
];

/// A drum on which every verb has something to do; without its lid for `compose`.
fn drum(verb: &str) -> TriMesh {
    let mut mesh = shapes::cylinder(1.0, 2.0, 16, 4);
    if verb.starts_with("compose") {
        let below = |v: &VertexId| mesh.positions[v.index()].z < 0.99;
        mesh.faces.retain(|f| f.iter().any(below));
    }
    mesh
}

/// The folder with the sound partners.
fn bench() -> Bench {
    let bench = Bench::new();
    let write = |mesh: TriMesh, name: &str| mesh_io::write(&Model::from(mesh), &bench.path(name)).map(drop).unwrap();
    let raised = |mut mesh: TriMesh, by: f64| {
        mesh.positions.iter_mut().for_each(|p| p.z += by);
        mesh
    };
    write(raised(shapes::cylinder(0.4, 3.0, 12, 3), 1.0), "post.ply");
    let mut cap = raised(drum("compose"), -4.5);
    cap.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x, -p.y, -p.z));
    write(cap, "cap.ply");
    bench
}

/// Runs one verb on one broken file and judges how it ended.
fn judge(bench: &Bench, verb: &str, input: &str, what: &str) -> i32 {
    let before = bench.files();
    let run = bench.run(&verb.replace("IN", input));
    let case = format!("{verb} on {what}: code {}, {}", run.code, run.stderr);
    if run.code == 0 {
        let expects_mesh = verb.contains("out.ply");
        if expects_mesh && !verb.starts_with("convert") {
            let mesh = mesh_io::read(&bench.path("out.ply")).unwrap().mesh;
            let defects = validate(&mesh);
            assert!(defects.is_manifold() && defects.non_finite.is_empty() && !mesh.faces.is_empty(), "{case}");
        }
    } else {
        assert!([3, 4, 5].contains(&run.code), "{case}");
        assert!(run.stderr.contains("error: ") && run.stderr.len() > 25, "{case}");
        assert!(run.stdout.is_empty() && bench.files() == before, "{case}");
    }
    for name in bench.files().iter().filter(|n| !before.contains(n)) {
        fs::remove_file(bench.path(name)).unwrap();
    }
    run.code
}

/// A change that makes a mesh worse.
type Harm = fn(&mut TriMesh);

const HARMS: [(&str, Harm); 12] = [
    ("duplicated faces", |m| m.faces.extend_from_within(..5)),
    ("the whole twice", |m| m.faces.extend_from_within(..)),
    ("a NaN", |m| m.positions[7].y = f64::NAN),
    ("an infinity", |m| m.positions[7].x = f64::NEG_INFINITY),
    ("one coordinate of 1e300", |m| m.positions[7].y = 1e300),
    ("all scaled by 1e300", |m| m.positions.iter_mut().for_each(|p| *p *= 1e300)),
    ("one coordinate of 1e-300", |m| m.positions[7].y = 1e-300),
    ("all scaled by 1e-300", |m| m.positions.iter_mut().for_each(|p| *p *= 1e-300)),
    ("some faces reversed", |m| m.faces.iter_mut().step_by(3).for_each(|f| f.swap(0, 1))),
    ("all faces reversed", |m| m.faces.iter_mut().for_each(|f| f.swap(0, 1))),
    ("missing faces", |m| drop(m.faces.drain(20..23))),
    ("all in one point", |m| m.positions.fill(DVec3::ONE)),
];

#[test]
fn every_verb_does_its_work_on_the_sound_drum() {
    let bench = bench();
    for verb in VERBS {
        mesh_io::write(&Model::from(drum(verb)), &bench.path("in.ply")).unwrap();
        assert_eq!(judge(&bench, verb, "in.ply", "a drum"), 0, "{verb}");
    }
}

#[test]
fn harmed_geometry() {
    let bench = bench();
    for verb in VERBS {
        for (what, harm) in HARMS {
            let mut mesh = drum(verb);
            harm(&mut mesh);
            // By hand: the writer refuses what is not finite.
            let points = mesh.positions.iter().map(|p| format!("{:?} {:?} {:?}\n", p.x, p.y, p.z));
            let faces = mesh.faces.iter().map(|f| format!("3 {} {} {}\n", f[0].0, f[1].0, f[2].0));
            let counts = format!("OFF\n{} {} 0\n", mesh.positions.len(), mesh.faces.len());
            bench.file("in.off", &[counts].into_iter().chain(points).chain(faces).collect::<String>());
            let code = judge(&bench, verb, "in.off", what);
            if verb == "convert IN -o out.ply" && code == 0 {
                bench.run("convert in.off -o out.ply").expect(0);
                let same = mesh_io::read(&bench.path("out.ply")).unwrap().mesh;
                let bits =
                    |m: &TriMesh| -> Vec<_> { m.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect() };
                assert!(same.faces == mesh.faces && bits(&same) == bits(&mesh), "{what}");
                fs::remove_file(bench.path("out.ply")).unwrap();
            }
        }
    }
}

/// The order of faces and vertices is no property of a solid: sizes agree to rounding.
#[test]
fn shuffled_order() {
    let bench = bench();
    let volume = |verb: &str| {
        bench.run(&verb.replace("IN", "in.ply")).expect(0);
        fusion::mesh_core::volume(&mesh_io::read(&bench.path("out.ply")).unwrap().mesh)
    };
    for verb in ["union IN post.ply -o out.ply", "blend IN -o out.ply --radius 3%", "cluster IN -o out.ply"] {
        let mut mesh = drum(verb);
        let n = mesh.positions.len();
        mesh_io::write(&Model::from(mesh.clone()), &bench.path("in.ply")).unwrap();
        let ordered = volume(verb);
        // Multiplication by a number prime to the count is a permutation.
        let prime = [37, 41, 43, 47].into_iter().find(|p| !n.is_multiple_of(*p)).unwrap();
        let moved = |v: usize| v * prime % n;
        let old = mesh.positions.clone();
        (0..n).for_each(|v| mesh.positions[moved(v)] = old[v]);
        mesh.faces.iter_mut().for_each(|f| *f = [1, 2, 0].map(|k| VertexId::from(moved(f[k].index()))));
        mesh.faces.reverse();
        mesh.faces.rotate_left(11);
        mesh_io::write(&Model::from(mesh), &bench.path("in.ply")).unwrap();
        let shuffled = volume(verb);
        assert!((ordered - shuffled).abs() < 1e-3 * ordered, "{verb}: {ordered} and {shuffled}");
    }
}

/// Every verb with every format in turn, cut short and with bytes changed.
#[test]
fn harmed_bytes() {
    let bench = bench();
    for (i, verb) in VERBS.into_iter().enumerate() {
        for (j, format) in Format::ALL.into_iter().enumerate() {
            let sound = mesh_io::to_bytes(&Model::from(drum(verb)), format).unwrap();
            let name = format!("in.{format}");
            let mut seed = (i * 7 + j) as u64;
            let mut random = |below: usize| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 33) as usize % below
            };
            // All verbs read alike: two formats each, in turn, cover every pair of reader and harm.
            if (i + j) % 4 > 1 {
                continue;
            }
            let cut = &sound[..random(sound.len())];
            let mut flipped = sound.clone();
            for _ in 0..3 {
                let at = random(flipped.len());
                flipped[at] ^= 1 << random(8);
            }
            let mut head = sound.clone();
            let at = random(100.min(head.len()));
            head[at] = 0xff;
            for (what, bytes) in [("cut short", cut), ("flipped bits", &flipped), ("a changed head", &head)] {
                fs::write(bench.path(&name), bytes).unwrap();
                judge(&bench, verb, &name, &format!("{what} of {name}"));
            }
            fs::remove_file(bench.path(&name)).unwrap();
        }
    }
}
