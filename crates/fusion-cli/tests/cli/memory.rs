//! How much memory a job takes at most.
#![cfg(target_os = "linux")]

use crate::support::Bench;
use fusion::mesh_core::shapes;
use glam::{DQuat, DVec3};
use mesh_io::Model;
use std::fs;
use std::time::Duration;

/// What a job may take by docs/limits.md: this whatever its size …
const FIXED: usize = 100_000_000;
/// … and this for each triangle read, in bytes.
const PER_TRIANGLE: usize = 500;

/// The most memory a run ever held, in bytes: the system keeps the highest mark while the program lives.
fn peak(bench: &Bench, line: &str) -> usize {
    let mut child = bench.command(line).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut highest = 0;
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let mark = text.lines().find_map(|l| l.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
        highest = mark.map_or(highest, |kilobytes| kilobytes.parse().unwrap());
        std::thread::sleep(Duration::from_millis(1));
    }
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    1024 * highest
}

#[test]
fn memory_is_a_stated_multiple_of_the_input() {
    let bench = Bench::new();
    let ball = shapes::icosphere(1.0, 6);
    let triangles = 2 * ball.faces.len();
    let moved = shapes::posed(ball.clone(), DQuat::from_rotation_x(0.4), DVec3::new(1.1, 0.2, 0.1));
    for (mesh, name) in [(ball, "one.ply"), (moved, "two.ply")] {
        mesh_io::write(&Model::from(mesh), &bench.path(name)).unwrap();
    }
    for line in [
        "union one.ply two.ply -o out.ply --threads 2",
        "union one.ply two.ply -o out.ply --threads 2 --radius 2%",
        "convert one.ply -o out.ply --threads 2",
        "info one.ply --threads 2",
    ] {
        let read = if line.starts_with("union") { triangles } else { triangles / 2 };
        let taken = peak(&bench, line);
        println!("{line}: {:.1} MB for {read} triangles", taken as f64 / 1e6);
        // Less than the mesh itself would mean that nothing was measured.
        assert!(taken > 100 * read, "{line}: {taken} bytes cannot be all");
        assert!(taken < FIXED + PER_TRIANGLE * read, "{line}: {taken} bytes for {read} triangles");
    }
}
