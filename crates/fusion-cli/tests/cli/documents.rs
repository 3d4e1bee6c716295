//! `cut`, `pose` and `run`, seen from outside.

use crate::support::{Bench, json};

const HALVES: &str = r#"
version = 2

[[part]]
name = "a"
mesh = "../a.off"

[[part]]
name = "b"
mesh = "../a.off"
translate = [0.5, 0.25, 0.125]

[[step]]
do = "union"

[[output]]
file = "built/out.off"
"#;

#[test]
fn a_cut_leaves_one_clean_opening() {
    let bench = Bench::new();
    bench.run("cut a.off -o half.off --plane 0,0,0.25,0,0,1 --report r.json --origins o.json").expect(0);
    let info = json(bench.run("info half.off --json").expect(0).text());
    assert_eq!(info["boundary_loops"].as_array().map(Vec::len), Some(1), "{info}");
    assert_eq!(info["self_intersections"], 0);
    let report = json(&bench.read("r.json"));
    assert_eq!((&report["command"], &report["kept_vertices"]), (&"cut".into(), &4.into()));
    assert_eq!((&report["validity"]["closed"], report["figures"]["rims"].as_f64()), (&false.into(), Some(1.0)));
    assert!(json(&bench.read("o.json"))["vertices"].as_array().is_some_and(|v| v.iter().any(|o| o[0] == "edge")));
}

#[test]
fn a_plane_that_misses_says_where_the_mesh_is() {
    let bench = Bench::new();
    let run = bench.run("cut a.off -o out.off --plane 0,0,7,0,0,1").expect(4);
    assert!(run.stderr.contains("from -7.5 to -6.5"), "{}", run.stderr);
    assert_eq!(bench.files(), ["a.off", "b.off"]);
}

#[test]
fn documents_run_relative_to_themselves() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("made/built")).unwrap();
    bench.file("made/job.toml", HALVES);
    bench.run("run made/job.toml --report r.json").expect(0);
    let info = json(bench.run("info made/built/out.off --json").expect(0).text());
    let shared = 0.5 * 0.75 * 0.875;
    assert!((info["volume"].as_f64().unwrap() - (2.0 - shared)).abs() < 1e-12);
    assert_eq!(json(&bench.read("r.json"))["command"], "run");
    bench.run("run made/job.toml -o here.ply").expect(0);
    assert!(bench.path("here.ply").exists());
}

#[test]
fn malformed_documents_exit_with_3_line_and_key() {
    let bench = Bench::new();
    std::fs::create_dir_all(bench.path("made/built")).unwrap();
    for (from, to, words) in [
        ("do =", "doo =", "line 13, column 1"),
        ("\"union\"", "\"fusion\"", "line 14, column 6, `do`"),
        ("version = 2", "version = 1", "[[step]]"),
        ("mesh = \"../a.off\"", "mesh = \"../none.off\"", "none.off"),
        ("[0.5, 0.25, 0.125]", "[0.5, 0.25]", "line 11, column 13, `translate`"),
    ] {
        bench.file("made/job.toml", &HALVES.replace(from, to));
        let run = bench.run("run made/job.toml").expect(3);
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    let missing = bench.run("run nowhere.toml").expect(3);
    assert!(missing.stderr.contains("nowhere.toml"));
}

/// Both halves of a picked cut, and the picks as the report tells their price.
#[test]
fn a_path_cuts_in_two() {
    let bench = Bench::new();
    // The test models are boxes around 0, 0, 0 and beside it; a path round the first one's middle.
    let picks = "0.6,0.1,0.02 -0.1,0.6,-0.03 -0.6,-0.1,0.01 0.1,-0.6,0.03";
    bench.run(&format!("cut a.off -o large.off --path {picks} --report r.json")).expect(0);
    bench.run(&format!("cut a.off -o small.off --path {picks} --keep smaller")).expect(0);
    let figures = json(&bench.read("r.json"))["figures"].clone();
    assert!(figures["path_cost"].as_f64().unwrap() <= figures["geodesic_cost"].as_f64().unwrap());
    for half in ["large.off", "small.off"] {
        let info = json(bench.run(&format!("info {half} --json")).expect(0).text());
        assert_eq!(info["boundary_loops"].as_array().map(Vec::len), Some(1), "{info}");
    }
    let error = bench.run("cut a.off -o out.off --path 0,0,1").expect(4);
    assert!(error.stderr.contains("two picks"), "{}", error.stderr);
}

/// Every key of a blend does what the option of that name does.
#[test]
fn blends_in_documents_have_the_options_of_the_command_line() {
    let bench = Bench::new();
    let edge = r#"{"curves": [{"points": [[-0.5, 0.5, 0.5], [0.5, 0.5, 0.5]], "closed": false}]}"#;
    bench.file("edge.json", edge);
    for (keys, options) in [
        ("radius = [0.1, 0.2]\nnear = [[0, 0.5, 0.5]]", "--radius 0.1,0.2 --near 0,0.5,0.5"),
        (
            "radius = 0.1\nradius_at = [{ at = [0.5, 0.5, 0.5], radius = 0.2 }]\nprofile_at = [{ at = [0, 0.5, 0.5], profile = \"conic=0.5\" }]\ncurves = \"edge.json\"",
            "--radius 0.1 --radius-at 0.5,0.5,0.5=0.2 --profile-at 0,0.5,0.5=conic=0.5 --curves edge.json",
        ),
        (
            "radius = \"5%\"\nprofile = \"hermite\"\nreach = 1.3\nspine = \"contact\"\nnear = [[0, 0.5, 0.5]]",
            "--radius 5% --profile hermite,reach=1.3 --spine contact --near 0,0.5,0.5",
        ),
    ] {
        let document = format!(
            "version = 2\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[step]]\ndo = \"blend\"\n{keys}\n[[output]]\nfile = \"r.off\"\n"
        );
        bench.file("r.toml", &document);
        bench.run("run r.toml").expect(0);
        bench.run(&format!("blend a.off -o c.off {options}")).expect(0);
        assert_eq!(bench.read("r.off"), bench.read("c.off"), "{keys}");
    }
    for (keys, says) in [
        ("radius = [0.1, 0.0]", "radius"),
        ("radius = 0.1\nradius_at = [{ at = [0, 0, 0], radius = -1 }]", "radius_at"),
        ("radius = 0.1\ncurves = \"none.json\"", "none.json"),
        ("radius = 0.1\nspine = \"paper\"", "offset"),
        ("radius = 0.1\nreach = 0.0", "0.1"),
    ] {
        let document = format!(
            "version = 2\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[step]]\ndo = \"blend\"\n{keys}\n[[output]]\nfile = \"no.off\"\n"
        );
        bench.file("r.toml", &document);
        let run = bench.run("run r.toml").expect(3);
        assert!(run.stderr.contains(says) && run.stderr.contains("line"), "{keys}: {}", run.stderr);
    }
}

/// The report tells of every step and output, and whether a step's result was known.
#[test]
fn several_outputs_come_all_or_none() {
    let bench = Bench::new();
    let document = HALVES.replace("../", "").replace("built/", "") + "[[output]]\nof = \"b\"\nfile = \"tool.stl\"\n";
    bench.file("job.toml", &document.replace("[[output]]\nfile", "[[output]]\nof = \"a\"\nfile"));
    bench.run("run job.toml --report r.json --cache kept").expect(0);
    let report = json(&bench.read("r.json"));
    assert_eq!((&report["command"], &report["steps"][0]["command"]), (&"run".into(), &"union".into()));
    assert_eq!((&report["steps"][0]["step"], &report["steps"][0]["known"]), (&1.into(), &false.into()));
    assert_eq!(report["outputs"].as_array().map(Vec::len), Some(2));
    assert!(report["outputs"][1]["file"].as_str().is_some_and(|file| file.ends_with("tool.stl")), "{report}");
    let first = (bench.read("out.off"), std::fs::read(bench.path("tool.stl")).unwrap());
    bench.run("run job.toml --report r.json --cache kept").expect(0);
    assert_eq!(json(&bench.read("r.json"))["steps"][0]["known"], true);
    assert_eq!((bench.read("out.off"), std::fs::read(bench.path("tool.stl")).unwrap()), first);
    // One that cannot be written takes the other with it.
    bench.file("job.toml", &bench.read("job.toml").replace("tool.stl", "no/tool.stl").replace("out.off", "other.off"));
    let before = bench.files();
    let run = bench.run("run job.toml").expect(6);
    assert!(run.stderr.contains("tool.stl") && bench.files() == before, "{}", run.stderr);
    // A file cannot take two meshes, a folder can.
    bench.run("run job.toml -o one.off").expect(2);
    bench.run("run job.toml --origins o.json").expect(2);
    std::fs::create_dir(bench.path("into")).unwrap();
    bench.run("run job.toml -o into").expect(0);
    assert!(bench.path("into/other.off").exists() && bench.path("into/tool.stl").exists());
}

#[test]
fn values_are_set_on_the_command_line() {
    let bench = Bench::new();
    let document = HALVES.replace("../", "").replace("built/", "").replace("[0.5, 0.25, 0.125]", "\"$shift\"");
    bench.file(
        "job.toml",
        &document.replace("version = 2", "version = 2\n[parameters]\nshift = [0.5, 0.25, 0.125]\nidle = 1"),
    );
    let volume = |bench: &Bench| json(bench.run("info out.off --json").expect(0).text())["volume"].as_f64().unwrap();
    let run = bench.run("run job.toml --set shift=[0.5,0.5,0.5]").expect(0);
    assert!((volume(&bench) - 1.875).abs() < 1e-12);
    assert!(run.stderr.contains("`idle`"), "{}", run.stderr);
    bench.run("run job.toml --set 1.radius=2%").expect(0);
    assert!(volume(&bench) > 2.0 - 0.5 * 0.75 * 0.875 + 1e-5, "the fillet adds to it");
    let wrong = bench.run("run job.toml --set shiftt=1").expect(3);
    assert!(wrong.stderr.contains("did you mean `shift`"), "{}", wrong.stderr);
    bench.run("run job.toml --set shift").expect(2);
}

/// Several processes write one folder at the same time; one of them is killed on its way.
#[test]
fn processes_share_a_folder_of_results() {
    let bench = Bench::new();
    let blend = "[[step]]\ndo = \"blend\"\nradius = 0.1\n[[output]]";
    let document = HALVES.replace("../", "").replace("built/", "").replace("[[output]]", blend);
    bench.file("job.toml", &document);
    bench.run("run job.toml -o fresh.off").expect(0);
    let lines = (0..4).map(|i| format!("run job.toml -o out{i}.off --cache kept"));
    let mut children: Vec<_> = lines.map(|line| bench.command(&line).spawn().unwrap()).collect();
    std::thread::sleep(std::time::Duration::from_millis(30));
    children[3].kill().unwrap();
    for (i, child) in children.iter_mut().enumerate() {
        let code = child.wait().unwrap();
        assert!(i == 3 || code.success());
    }
    for i in 0..3 {
        assert_eq!(bench.read(&format!("out{i}.off")), bench.read("fresh.off"));
    }
    // What the killed one may have begun is no entry, and nothing is taken from it.
    bench.run("run job.toml -o again.off --cache kept --report r.json").expect(0);
    assert_eq!(bench.read("again.off"), bench.read("fresh.off"));
    let known = json(&bench.read("r.json"))["steps"].as_array().unwrap().iter().all(|s| s["known"] == true);
    assert!(known);
    for entry in std::fs::read_dir(bench.path("kept")).unwrap() {
        std::fs::write(entry.unwrap().path(), "no entry").unwrap();
    }
    bench.run("run job.toml -o again.off --cache kept").expect(0);
    assert_eq!(bench.read("again.off"), bench.read("fresh.off"));
}

/// A saved edit is evaluated without being asked.
#[test]
fn a_watched_document_follows_its_saves() {
    let bench = Bench::new();
    let document = HALVES.replace("../", "").replace("built/", "");
    bench.file("job.toml", &document);
    let mut child = bench.command("run job.toml --watch").spawn().unwrap();
    let wait = |wanted: f64| {
        for _ in 0..600 {
            std::thread::sleep(std::time::Duration::from_millis(50));
            let mesh = mesh_io::read(&bench.path("out.off"));
            if mesh.is_ok_and(|m| (fusion::mesh_core::volume(&m.mesh) - wanted).abs() < 1e-9) {
                return true;
            }
        }
        false
    };
    let first = wait(2.0 - 0.5 * 0.75 * 0.875);
    bench.file("job.toml", &document.replace("[0.5, 0.25, 0.125]", "[oops"));
    std::thread::sleep(std::time::Duration::from_millis(300));
    bench.file("job.toml", &document.replace("[0.5, 0.25, 0.125]", "[0.5, 0.5, 0.5]"));
    let second = wait(1.875);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(first && second, "{first} {second}");
}

#[test]
fn a_mesh_is_posed() {
    let bench = Bench::new();
    bench.run("pose a.off -o out.off --scale 2 --rotate 0,0,1,90 --translate -1,0,0.5").expect(0);
    let moved = mesh_io::read(&bench.path("out.off")).unwrap().mesh;
    let before = mesh_io::read(&bench.path("a.off")).unwrap().mesh;
    for (p, q) in before.positions.iter().zip(&moved.positions) {
        let wanted = glam::DVec3::new(-2.0 * p.y - 1.0, 2.0 * p.x, 2.0 * p.z + 0.5);
        assert!(q.distance(wanted) < 1e-12, "{p} {q}");
    }
    bench.run("pose b.off -o out.off --translate 0,0,9 --drop a.off").expect(0);
    let low = |name: &str| {
        mesh_io::read(&bench.path(name)).unwrap().mesh.positions.iter().map(|p| p.z).fold(f64::MAX, f64::min)
    };
    let high = before.positions.iter().map(|p| p.z).fold(f64::MIN, f64::max);
    assert!((low("out.off") - high).abs() < 1e-12);
    let aside = bench.run("pose b.off -o no.off --translate 9,0,0 --drop a.off").expect(4);
    assert!(aside.stderr.contains("shift it"), "{}", aside.stderr);
    bench.run("pose a.off -o no.off --scale 0").expect(2);
    bench.run("pose a.off -o no.off --rotate 0,0,0,9").expect(2);
}
