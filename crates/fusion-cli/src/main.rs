//! The program `fusion-cli`: the library of the same name with an allocator.

/// Large meshes come and go from stage to stage: the system's allocator gives their pages back and asks for them again,
/// which costs a third of a blend's time on a million triangles.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> std::process::ExitCode {
    fusion_cli::main(std::env::args_os())
}
