//! Names the build, so that results kept by one are never taken for those of another: `FUSION_BUILD` is a hash of the sources of
//! this crate and of those beside it that it depends on, of the compiler, and of the target.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let mut hash = DefaultHasher::new();
    for name in
        ["TARGET", "OPT_LEVEL", "PROFILE", "RUSTC", "CARGO_CFG_TARGET_FEATURE", "CARGO_ENCODED_RUSTFLAGS", "DEBUG"]
    {
        env::var(name).unwrap_or_default().hash(&mut hash);
    }
    let mut files = vec![];
    for folder in sources() {
        println!("cargo::rerun-if-changed={}", folder.display());
        list(&folder, &mut files);
    }
    files.sort();
    for file in files {
        if let (Some(name), Ok(bytes)) = (file.file_name(), fs::read(&file)) {
            (name, bytes).hash(&mut hash);
        }
    }
    println!("cargo::rustc-env=FUSION_BUILD={:016x}", hash.finish());
}

/// The sources of this crate and of those beside it that it depends on, with the versions of all others where they are known.
fn sources() -> Vec<PathBuf> {
    let mut crates = vec![PathBuf::from(".")];
    let mut next = 0;
    while let Some(folder) = crates.get(next) {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        for name in
            manifest.lines().filter_map(|line| line.split(['.', ' ', '=']).next()).filter(|name| !name.is_empty())
        {
            let beside = Path::new("..").join(name);
            if beside.join("src").is_dir() && !crates.contains(&beside) {
                crates.push(beside);
            }
        }
        next += 1;
    }
    let lock = PathBuf::from("../../Cargo.lock");
    let files = crates.iter().flat_map(|folder| ["src", "build.rs", "Cargo.toml"].map(|name| folder.join(name)));
    files.chain([lock]).filter(|path| path.exists()).collect()
}

fn list(path: &Path, files: &mut Vec<PathBuf>) {
    match fs::read_dir(path) {
        Ok(entries) => entries.flatten().for_each(|entry| list(&entry.path(), files)),
        Err(_) => files.push(path.into()),
    }
}
