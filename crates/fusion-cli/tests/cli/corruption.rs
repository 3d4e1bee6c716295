//! Broken input to every verb: a valid result or exit code 3, 4 or 5 with a sentence, and no file left behind.

use crate::support::{Bench, Run, json};
use fusion::Info;
use fusion::mesh_core::{Bounds, FaceId, TriMesh, VertexId, Watch, bounds, components, shapes, validate};
use fusion::operation::{Blend, Precision};
use glam::DVec3;
use mesh_io::{Format, Model};
use std::fs;

/// Every verb, IN being the broken file; the others are sound.
const VERBS: [&str; 23] = [
    "info IN",
    "info IN --json",
    "convert IN -o out.ply",
    "convert IN -o out.ply --weld 1% --orient --split",
    "features IN",
    "union IN post.ply -o out.ply",
    "difference post.ply IN -o out.ply",
    "intersection IN post.ply -o out.ply --radius 1%",
    "blend IN -o out.ply --radius 3%",
    "blend IN -o out.ply --profile sharp --near 1,0,1 --radius 3%",
    "blend IN --max-radius",
    "sharpen IN -o out.ply --near 0.912,0,0.912",
    "pose IN -o out.ply --translate 0,0,1",
    "cut IN -o out.ply --plane 0.1,0.05,0.02,1,0.2,0.1",
    "compose IN cap.ply -o out.ply",
    "compose IN cap.ply -o out.ply --method montage",
    "detail IN -o out.ply --target near=1,0,0,0.8 --source near=-1,0,0,0.9",
    "cluster IN -o out.ply",
    "repair IN -o out.ply --holes fill",
    "remesh IN -o out.ply --edge-length 0.3",
    "remesh IN -o out.ply --smooth taubin",
    "render IN -o out.png --size 48",
    "run job.toml -o out.ply",
];

/// Verbs that read no mesh.
const INPUTLESS: [&str; 8] = ["batch", "grid", "summary", "demo", "completions", "schema", "man", "help"];

/// What `run` replays.
const JOB: &str = r#"
version = 2
[[part]]
name = "drum"
mesh = "IN"
[[part]]
name = "post"
mesh = "post.ply"
[[step]]
do = "union"
[[output]]
file = "out.ply"
"#;

/// A drum on which every verb has something to do; without its lid for `compose`, with a rounded rim for `sharpen`.
fn drum(verb: &str) -> TriMesh {
    if verb.starts_with("sharpen") {
        let blend = Blend::default().with_radius(0.3).with_near(vec![DVec3::new(1.0, 0.0, 1.0).into()]);
        let drum = shapes::cylinder(1.0, 2.0, 48, 4).into();
        return blend.run(&drum, Precision::F64, &Watch::default()).unwrap().model.mesh;
    }
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
    bench.file("job.toml", &JOB.replace("IN", input));
    let before = bench.files();
    let run = bench.run(&verb.replace("IN", input));
    if let Some(fault) = fault(bench, verb, input, &run, &before) {
        panic!("{verb} on {what}: {fault}; code {}, {}", run.code, run.stderr);
    }
    for name in bench.files().iter().filter(|n| !before.contains(n)) {
        fs::remove_file(bench.path(name)).unwrap();
    }
    run.code
}

/// What a run should not have done.
fn fault(bench: &Bench, verb: &str, input: &str, run: &Run, before: &[String]) -> Option<String> {
    if run.code != 0 {
        let said = run.stderr.contains("error: ") && run.stderr.len() > 25;
        let clean = run.stdout.is_empty() && bench.files() == before;
        let sound = [3, 4, 5].contains(&run.code) && said && clean;
        return (!sound).then(|| format!("failed otherwise than it should, leaving {:?}", bench.files()));
    }
    if verb.ends_with("--json") {
        return (!json(run.text()).is_object()).then(|| "printed no object".into());
    }
    if verb.contains("out.png") {
        let bytes = fs::read(bench.path("out.png")).unwrap_or_default();
        let whole = bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xae\x42\x60\x82");
        return (!whole).then(|| "wrote no picture".into());
    }
    if !verb.contains("out.ply") {
        return run.stdout.is_empty().then(|| "printed nothing".into());
    }
    let read = |name: &str| mesh_io::read(&bench.path(name)).map(|m| m.mesh);
    let (taken, made) = match (read(input), read("out.ply")) {
        (Ok(taken), Ok(made)) => (taken, made),
        (Err(e), _) | (_, Err(e)) => return Some(format!("what it read or wrote is no mesh: {e}")),
    };
    let defects = validate(&made);
    if verb.starts_with("pose") {
        return (made.faces != taken.faces).then(|| "is not faithful".into());
    }
    if verb == "convert IN -o out.ply" {
        return (made.faces != taken.faces || bits(&made) != bits(&taken)).then(|| "is not faithful".into());
    }
    if !defects.is_manifold() || !defects.non_finite.is_empty() {
        return Some(format!("wrote what is not valid: {defects}"));
    }
    if verb.starts_with("convert") {
        return None;
    }
    // What meets itself away from the work is the input's own, and stays. Beside a whole of 2^100 times its size a piece is a point to
    // the check.
    let whole = bounds(&made).diagonal();
    let size = |piece: &Vec<FaceId>| Bounds::of(piece.iter().flat_map(|&f| made.triangle(f))).diagonal();
    let specks = components(&made).faces().iter().any(|piece| size(piece) < 1e-28 * whole);
    let meetings = |m: &TriMesh| Info::of(m, &Watch::default()).unwrap().self_intersections.unwrap_or(usize::MAX);
    let wrong = made.faces.is_empty() || (!specks && meetings(&made) > 0 && meetings(&taken) == 0);
    wrong.then(|| "wrote an empty or self-intersecting mesh".into())
}

fn bits(mesh: &TriMesh) -> Vec<[u64; 3]> {
    mesh.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

/// Each way to go wrong is seen.
#[test]
fn the_judge_finds_fault() {
    let bench = bench();
    let write = |mesh: TriMesh, name: &str| mesh_io::write(&Model::from(mesh), &bench.path(name)).map(drop).unwrap();
    write(shapes::cuboid(DVec3::ONE), "in.ply");
    let before = bench.files();
    let run = |code, stdout: &str, stderr: &str| Run { code, stdout: stdout.into(), stderr: stderr.into() };
    let faulty = |verb: &str, run: Run| fault(&bench, verb, "in.ply", &run, &before).is_some();
    let sentence = "error: in.ply is not closed near [0, 0, 0]";
    assert!(!faulty("union", run(4, "", sentence)));
    assert!([0, 1, 2, 6, 101, -1].into_iter().all(|code| faulty("info IN", run(code, "", sentence))));
    assert!(faulty("union", run(4, "", "error: no")) && faulty("union", run(4, "half a mesh", sentence)));
    assert!(faulty("info IN --json", run(0, "[]", "")) && faulty("render IN -o out.png", run(0, "", "")));
    let (convert, union) = ("convert IN -o out.ply", "union IN post.ply -o out.ply");
    assert!(faulty(union, run(0, "", "")), "no file at all");
    let cube = shapes::cuboid(DVec3::ONE);
    write(cube.clone(), "out.ply");
    assert!(!faulty(convert, run(0, "", "")) && !faulty(union, run(0, "", "")));
    assert!(faulty(union, run(4, "", sentence)), "a file left behind");
    let mut moved = cube.clone();
    moved.positions[3].x = moved.positions[3].x.next_up();
    write(moved, "out.ply");
    assert!(faulty(convert, run(0, "", "")));
    let mut twice = cube.clone();
    twice.faces.extend_from_within(..1);
    let mut through = cube.clone();
    through.positions.extend(cube.positions.iter().map(|p| *p + 0.5));
    through.faces.extend(cube.faces.iter().map(|f| f.map(|v| VertexId(v.0 + 8))));
    for (what, broken) in [("a face twice", twice), ("crossing faces", through), ("nothing", TriMesh::default())] {
        write(broken, "out.ply");
        assert!(faulty(union, run(0, "", "")), "{what}");
    }
}

/// The suite knows every verb that the program offers.
#[test]
fn no_verb_is_left_out() {
    let help = Bench::new().run("--help").expect(0);
    let (_, verbs) = help.text().split_once("Commands:\n").unwrap();
    // What a sentence has beyond the first line is indented further.
    let begins = |l: &&str| !l.starts_with("   ");
    let offered =
        verbs.lines().take_while(|l| !l.is_empty()).filter(begins).filter_map(|l| l.split_whitespace().next());
    let offered: Vec<&str> = offered.collect();
    assert!(offered.len() >= 17, "{offered:?}");
    for verb in offered {
        let tried = VERBS.iter().any(|line| line.split(' ').next() == Some(verb));
        assert!(tried != INPUTLESS.contains(&verb), "{verb}");
    }
}

/// A change that makes a mesh worse.
type Harm = fn(&mut TriMesh);

const HARMS: [(&str, Harm); 13] = [
    ("no face at all", |m| m.faces.clear()),
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
                assert!(same.faces == mesh.faces && bits(&same) == bits(&mesh), "{what}");
                fs::remove_file(bench.path("out.ply")).unwrap();
            }
        }
    }
}

/// The order of faces and vertices is no property of a solid: sizes agree to rounding, or to what triangles may differ by.
#[test]
fn shuffled_order() {
    let bench = bench();
    for verb in VERBS {
        let mut mesh = drum(verb);
        let n = mesh.positions.len();
        let size = |mesh: &TriMesh| {
            mesh_io::write(&Model::from(mesh.clone()), &bench.path("in.ply")).unwrap();
            assert_eq!(judge(&bench, verb, "in.ply", "a shuffled drum"), 0, "{verb}");
            if !verb.contains("out.ply") {
                return 0.0;
            }
            bench.run(&verb.replace("IN", "in.ply")).expect(0);
            let made = mesh_io::read(&bench.path("out.ply")).unwrap().mesh;
            fs::remove_file(bench.path("out.ply")).unwrap();
            fusion::mesh_core::volume(&made)
        };
        let ordered = size(&mesh);
        // Multiplication by a number prime to the count is a permutation.
        let prime = [37, 41, 43, 47].into_iter().find(|p| !n.is_multiple_of(*p)).unwrap();
        let moved = |v: usize| v * prime % n;
        let old = mesh.positions.clone();
        (0..n).for_each(|v| mesh.positions[moved(v)] = old[v]);
        mesh.faces.iter_mut().for_each(|f| *f = [1, 2, 0].map(|k| VertexId::from(moved(f[k].index()))));
        mesh.faces.reverse();
        mesh.faces.rotate_left(11);
        let shuffled = size(&mesh);
        assert!((ordered - shuffled).abs() <= 1e-3 * ordered.abs(), "{verb}: {ordered} and {shuffled}");
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
