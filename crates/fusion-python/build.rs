//! Lets the extension module find the interpreter's symbols in the process that loads it, which macOS has to be told.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| std::env::var(key).is_ok_and(|found| found == value);
    if is("CARGO_CFG_TARGET_OS", "macos") && std::env::var_os("CARGO_FEATURE_EXTENSION").is_some() {
        println!("cargo:rustc-cdylib-link-arg=-undefined");
        println!("cargo:rustc-cdylib-link-arg=dynamic_lookup");
    }
}
