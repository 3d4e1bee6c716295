//! Every exit code, and the promise that any but 0 leaves files as they were.

use crate::support::{Bench, cube};

#[test]
fn code_0_and_a_table() {
    let run = Bench::new().run("info a.off").expect(0);
    assert!(run.text().contains("vertices             8") && run.text().contains("closed, oriented 2-manifold"));
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    Bench::new().run("--help").expect(0);
    Bench::new().run("--version").expect(0);
}

#[test]
fn code_2_for_wrong_usage() {
    let bench = Bench::new();
    for line in [
        "",
        "fly",
        "info",
        "info a.off --threads 0",
        "convert a.off",
        "convert a.off -o out.xyz",
        "convert a.off -o -",
        "convert a.off -o out.off --to stl",
        "convert a.off -o out.off --report out.off",
        "convert a.off -o out.off --report -",
        "convert a.off -o out.off --weld -1",
        "info -",
        "features a.off --angle 200",
        "union a.off -o out.off",
        "union a.off b.off -o out.off --radius nan",
        "union a.off b.off -o out.off --radius 0",
        "union - - --from off -o out.off",
        "render a.off -o a.png --view 0,0,0",
        "cut a.off -o out.off",
        "cut a.off -o out.off --plane 0,0,0,0,0,0",
        "cut a.off -o out.off --plane 0,0,0,0,0,1 --snap 0.5",
        "run",
    ] {
        let run = bench.run(line).expect(2);
        assert!(!run.stderr.is_empty(), "{line}");
        assert_eq!(bench.files(), ["a.off", "b.off"], "{line}");
    }
}

#[test]
fn code_3_names_file_place_and_reason() {
    let bench = Bench::new();
    bench.file("bad.obj", "v 0 0 0\nv 1 0 0\nv zero 1 0\nf 1 2 3\n");
    bench.file("cut.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0");
    bench.file("note.txt", "hello");
    bench.file("out.off", "old");
    for (line, words) in [
        ("info missing.obj", "missing.obj"),
        ("info bad.obj", "line 3"),
        ("info cut.stl", "cut.stl"),
        ("info note.txt", "note.txt"),
        ("convert bad.obj -o out.off", "bad.obj"),
        ("union a.off bad.obj -o out.off", "bad.obj"),
        ("info - --from ply", "ply"),
    ] {
        let run = bench.run(line).expect(3);
        assert!(run.stderr.contains(words), "{line}: {}", run.stderr);
        assert!(run.stdout.is_empty() && bench.read("out.off") == "old", "{line}");
    }
}

#[test]
fn code_4_says_where_and_what_would_work() {
    let bench = Bench::new();
    let open: String = cube([0.0; 3], 1.0).replace("8 12 0", "8 10 0").lines().take(20).collect::<Vec<_>>().join("\n");
    bench.file("open.off", &open);
    bench.file("far.off", &cube([10.0, 0.0, 0.0], 1.0));
    bench.file("three.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 -1 0\n3 0 1 2\n3 0 1 3\n3 0 1 4\n");
    bench.file("out.off", "old");
    for line in [
        "union a.off open.off -o out.off --report r.json --origins o.json",
        "union a.off three.off -o out.off",
        "intersection a.off far.off -o out.off",
        "features three.off",
    ] {
        let run = bench.run(line).expect(4);
        assert!(run.stderr.starts_with("error: ") && run.stderr.len() > 40, "{line}: {}", run.stderr);
        assert!(bench.read("out.off") == "old" && !bench.path("o.json").exists());
    }
}

/// A box so small and far away that 32-bit coordinates cannot hold it.
#[test]
fn code_5_where_the_format_would_break_the_result() {
    let bench = Bench::new();
    bench.file("c.off", &cube([1e6, 0.0, 0.0], 1e-3));
    bench.file("d.off", &cube([1e6 + 4e-4, 3e-4, 2e-4], 1e-3));
    bench.run("union c.off d.off -o out.off").expect(0);
    let run = bench.run("union c.off d.off -o out.stl --report r.json").expect(5);
    assert!(run.stderr.contains("stl"), "{}", run.stderr);
    assert!(!bench.path("out.stl").exists() && bench.read("r.json").contains("\"exit_code\": 5"));
}

#[test]
fn code_6_leaves_everything_as_it_was() {
    let bench = Bench::new();
    bench.file("out.off", "old");
    std::fs::create_dir(bench.path("folder.off")).unwrap();
    let before = bench.files();
    for line in [
        "convert a.off -o nowhere/out.off",
        "convert a.off -o folder.off",
        "convert a.off -o out.off --report nowhere/r.json",
        "convert a.off -o out.off --origins nowhere/o.json --report r.json",
        "union a.off b.off -o out.off --origins nowhere/o.json --report r.json",
        "features a.off -o nowhere/curves.json",
        "info a.off --report nowhere/r.json",
    ] {
        let run = bench.run(line).expect(6);
        assert!(run.stderr.contains("cannot write"), "{line}: {}", run.stderr);
        assert_eq!((bench.files(), bench.read("out.off").as_str()), (before.clone(), "old"), "{line}");
    }
}

#[cfg(unix)]
#[test]
fn code_130_on_ctrl_c() {
    use std::io::Write;
    let bench = Bench::new();
    bench.file("out.off", "old");
    let mut child = bench.command("convert - --from off -o out.off").spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"OFF\n8 12 0\n").unwrap();
    std::thread::sleep(std::time::Duration::from_millis(300));
    // Not every system has a program for it, but every shell.
    std::process::Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    // Its input stays open: the program must stop although it waits for more.
    let output = child.wait_with_output().unwrap();
    drop(input);
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cancelled"));
    assert_eq!((bench.files().len(), bench.read("out.off").as_str()), (3, "old"));
}
