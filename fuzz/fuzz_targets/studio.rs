#![no_main]
//! Text frames of a studio's client, one a line: a refused edit leaves the document as it was, a document is always one, and no file
//! appears outside the root.

use std::sync::LazyLock;
use tempfile::TempDir;

/// The root, within a folder of its own.
static OUTER: LazyLock<TempDir> = LazyLock::new(|| {
    let outer = tempfile::tempdir().expect("a folder can be made");
    let root = outer.path().join("root");
    std::fs::create_dir(&root).expect("a folder can be made");
    std::fs::write(root.join("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a file can be written");
    outer
});

libfuzzer_sys::fuzz_target!(|frames: &[u8]| {
    if let Err(told) = fusion_studio::play(&OUTER.path().join("root"), frames) {
        panic!("{told}");
    }
    assert_eq!(std::fs::read_dir(OUTER.path()).expect("the folder is there").count(), 1);
});
