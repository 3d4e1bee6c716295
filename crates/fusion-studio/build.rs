//! Tells where the page's bundle is: `studio` in the target folder, where `cargo xtask studio` puts it.

use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-env-changed=CARGO_TARGET_DIR");
    println!("cargo::rerun-if-env-changed=FUSION_STUDIO_BUNDLE");
    let given = std::env::var_os("FUSION_STUDIO_BUNDLE").map(PathBuf::from);
    let target = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    let package = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let folder = given.unwrap_or_else(|| target.unwrap_or_else(|| package.join("../../target")).join("studio"));
    println!("cargo::rerun-if-changed=build.rs");
    if folder.exists() {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    println!("cargo::rustc-env=FUSION_STUDIO_PAGE={}", folder.display());
}
