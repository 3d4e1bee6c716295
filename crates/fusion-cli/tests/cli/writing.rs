//! What is on the disk when writing stops half-way.
#![cfg(unix)]

use crate::support::Bench;
use fusion::mesh_core::shapes;
use mesh_io::Model;
use std::fs;
use std::process::Command;
use std::time::Duration;

/// A folder with a model of some megabytes and an old output.
fn bench() -> Bench {
    let bench = Bench::new();
    mesh_io::write(&Model::from(shapes::icosphere(1.0, 6)), &bench.path("ball.ply")).unwrap();
    bench.file("out.obj", "old");
    bench
}

/// A shell that limits the size of files it writes, to half a megabyte or less, before it becomes the program.
fn limited(bench: &Bench, before: &str, line: &str) -> std::process::Output {
    let program = bench.command("");
    let script = format!("{before} ulimit -f 512; exec \"$0\" {line}");
    let mut shell = Command::new("sh");
    shell.arg("-c").arg(script).arg(program.get_program()).current_dir(bench.path(""));
    shell.output().unwrap()
}

#[test]
fn a_full_disk_is_code_6_and_leaves_the_old_file() {
    let bench = bench();
    let before = bench.files();
    let run = limited(&bench, "trap '' XFSZ;", "convert ball.ply -o out.obj --report r.json --origins o.json");
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code() == Some(6) && said.contains("cannot write"), "{said}");
    assert_eq!((bench.read("out.obj").as_str(), bench.files()), ("old", before));
}

#[test]
fn devices_without_room_are_code_6() {
    if !std::path::Path::new("/dev/full").exists() {
        return;
    }
    let bench = bench();
    bench.run("convert ball.ply -o /dev/full --to ply").expect(6);
    bench.run("convert a.off -o out.ply --report /dev/full").expect(6);
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let run = bench.command("convert ball.ply -o - --to ply").stdout(full).output().unwrap();
    assert_eq!(run.status.code(), Some(6));
}

/// The system ends the program in the middle of a write.
#[test]
fn killed_while_writing_the_old_file_is_whole() {
    let bench = bench();
    let run = limited(&bench, "", "convert ball.ply -o out.obj");
    assert_eq!((run.status.code(), bench.read("out.obj").as_str()), (None, "old"));
}

/// Killed at any moment, the output is the old file or the whole new one.
#[test]
fn killed_at_any_moment_the_output_is_old_or_new() {
    let bench = bench();
    bench.run("convert ball.ply -o new.obj").expect(0);
    let new = bench.read("new.obj");
    for delay in 0..12 {
        bench.file("out.obj", "old");
        let mut child = bench.command("convert ball.ply -o out.obj").spawn().unwrap();
        std::thread::sleep(Duration::from_millis(5 * delay));
        child.kill().unwrap();
        child.wait().unwrap();
        let out = bench.read("out.obj");
        assert!(out == "old" || out == new, "{} bytes after {} ms", out.len(), 5 * delay);
    }
}
