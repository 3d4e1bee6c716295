#![no_main]
//! The reader of OFF.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fusion_fuzz::read(bytes, mesh_io::Format::Off));
