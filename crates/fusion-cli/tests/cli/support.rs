//! Runs the built program as a user would.

use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// What a run gave.
pub struct Run {
    pub code: i32,
    pub stdout: Vec<u8>,
    pub stderr: String,
}

impl Run {
    /// Standard output as text.
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.stdout).unwrap()
    }

    /// Fails the test unless the code is as expected.
    pub fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout: {}\nstderr: {}", String::from_utf8_lossy(&self.stdout), self.stderr);
        self
    }
}

/// A folder of its own for each test, in which the program runs.
pub struct Bench {
    folder: TempDir,
}

impl Bench {
    /// A folder with two overlapping boxes, `a.off` and `b.off`.
    pub fn new() -> Self {
        let bench = Self { folder: tempfile::tempdir().unwrap() };
        bench.file("a.off", &cube([0.0; 3], 1.0));
        bench.file("b.off", &cube([0.4, 0.3, 0.2], 1.0));
        bench
    }

    /// Writes a file.
    pub fn file(&self, name: &str, text: &str) -> PathBuf {
        fs::write(self.path(name), text).unwrap();
        self.path(name)
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Reads a file.
    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs `fusion-cli` with arguments as typed.
    pub fn run(&self, line: &str) -> Run {
        self.run_with(line, b"")
    }

    /// Runs it with something on standard input.
    pub fn run_with(&self, line: &str, stdin: &[u8]) -> Run {
        let mut child = self.command(line).spawn().unwrap();
        // A program that fails early closes its input.
        let _ = child.stdin.take().unwrap().write_all(stdin);
        let output = child.wait_with_output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        Run {
            code: output.status.code().unwrap_or(-1),
            stdout: output.stdout,
            // Lines of progress come only on machines that are slow or busy.
            stderr: text.lines().filter(|l| !l.ends_with(" %")).fold(String::new(), |all, l| all + l + "\n"),
        }
    }

    /// The program, ready to start.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(Path::new(env!("CARGO_BIN_EXE_fusion-cli")));
        command.args(line.split_whitespace()).current_dir(self.folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }
}

/// A cube as OFF.
pub fn cube(center: [f64; 3], size: f64) -> String {
    let mut text = String::from("OFF\n8 12 0\n");
    for i in 0..8 {
        let p = [0, 1, 2].map(|k| center[k] + size * (f64::from(i >> k & 1) - 0.5));
        writeln!(text, "{:?} {:?} {:?}", p[0], p[1], p[2]).unwrap();
    }
    for [a, b, c, d] in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        writeln!(text, "3 {a} {b} {c}\n3 {a} {c} {d}").unwrap();
    }
    text
}

/// A printed or written report.
pub fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}
