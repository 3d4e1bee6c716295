//! The command line.

use crate::root::PathError;
use crate::server::{Options, Server, StartError};
use clap::Parser;
use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Join and blend triangle meshes in the browser: starts a server on this machine and opens its page
#[derive(Debug, Parser)]
#[command(name = "fusion-studio", version)]
struct Arguments {
    /// Mesh files to start with, or one document (.toml)
    files: Vec<PathBuf>,
    /// Read and write below this folder only [default: the current one, or the one that holds all files]
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Use this port; 0 takes any free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Do not open the browser
    #[arg(long)]
    no_open: bool,
}

/// Runs the program, whose first argument is its name: prints the page's address as the first line, and serves it until Ctrl-C.
/// The exit codes are those of `fusion-cli`.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = Arguments::parse_from(arguments);
    match start(&arguments) {
        Ok(server) => {
            // Whoever started it may have closed the other end; the page is served all the same.
            let mut out = std::io::stdout();
            let _ = writeln!(out, "{}", server.address()).and_then(|()| out.flush());
            if !arguments.no_open && opener::open_browser(server.address()).is_err() {
                let _ = writeln!(std::io::stderr(), "no browser could be opened; open the address above");
            }
            server.wait();
            ExitCode::SUCCESS
        }
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::from(match error {
                StartError::Port(..) | StartError::System(_) => 2,
                StartError::Path(_) | StartError::File(_) => 3,
            })
        }
    }
}

fn start(arguments: &Arguments) -> Result<Server, StartError> {
    let root = match &arguments.root {
        Some(root) => root.clone(),
        None => shared_folder(&arguments.files)?,
    };
    let mut options = Options::default();
    (options.root, options.port, options.files) = (Some(root), arguments.port, arguments.files.clone());
    Server::start(&options)
}

/// The current folder where it holds all files, or else the lowest that does.
fn shared_folder(files: &[PathBuf]) -> Result<PathBuf, PathError> {
    let real = |path: &Path| path.canonicalize().map_err(|e| PathError::Io(path.display().to_string(), e));
    let mut folder = real(Path::new("."))?;
    for file in files {
        let file = real(file)?;
        while !file.starts_with(&folder) && folder.pop() {}
    }
    Ok(folder)
}
