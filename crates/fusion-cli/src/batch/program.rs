//! The program that workers run.

use std::path::PathBuf;

const NAME: &str = "fusion-cli";

/// This program, where it is `fusion-cli`; else, as under Python, the one beside it; else the one on the search path.
pub fn program() -> PathBuf {
    let Ok(running) = std::env::current_exe() else { return NAME.into() };
    if running.file_stem().is_some_and(|stem| stem.to_string_lossy().starts_with(NAME)) {
        return running;
    }
    let beside = running.with_file_name(NAME).with_extension(std::env::consts::EXE_EXTENSION);
    if beside.is_file() { beside } else { NAME.into() }
}
