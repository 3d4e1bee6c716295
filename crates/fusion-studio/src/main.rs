//! The program `fusion-studio`: the library of the same name with an allocator.

/// See `fusion-cli`: large meshes come and go, and the system's allocator asks for their pages again and again.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> std::process::ExitCode {
    fusion_studio::main(std::env::args_os())
}
