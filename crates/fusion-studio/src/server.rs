//! A studio on an address of this machine.

use crate::gate::Gate;
use crate::http::{Site, router};
use crate::refusal::Refusal;
use crate::request::Edit;
use crate::root::{PathError, Root};
use crate::studio::Studio;
use serde_json::Map;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio::runtime::Runtime;

/// What a studio starts with.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Options {
    /// What everything is read and written below; the current folder where left out.
    pub root: Option<PathBuf>,
    /// The port; 0 takes any free one.
    pub port: u16,
    /// Meshes, or one document, below the root.
    pub files: Vec<PathBuf>,
}

/// Why a studio does not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The root is no folder, or a file is not below it.
    #[error(transparent)]
    Path(#[from] PathError),
    /// The port is taken.
    #[error("port {0} of this machine cannot be used: {1}; --port 0 takes any free one")]
    Port(u16, #[source] io::Error),
    /// The system gives no threads or no random numbers.
    #[error("the server cannot start: {0}")]
    System(String),
    /// A file cannot be taken.
    #[error("{}", .0.sentence)]
    File(Refusal),
}

/// A running studio; it ends with this.
#[derive(Debug)]
pub struct Server {
    address: String,
    studio: Arc<Studio>,
    runtime: Option<Runtime>,
}

impl Server {
    /// Starts a studio.
    ///
    /// # Errors
    /// [`StartError`].
    pub fn start(options: &Options) -> Result<Self, StartError> {
        let root = Root::new(options.root.as_deref().unwrap_or(Path::new(".")))?;
        let system = |e: &dyn std::fmt::Display| StartError::System(e.to_string());
        let bind = || {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, options.port))?;
            listener.set_nonblocking(true)?;
            Ok((listener.local_addr()?.port(), listener))
        };
        let (port, listener) = bind().map_err(|e| StartError::Port(options.port, e))?;
        let gate = Gate::new(port).map_err(|e| system(&e))?;
        let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build();
        let runtime = runtime.map_err(|e| system(&e))?;
        let studio = Studio::start(root).map_err(|e| system(&e))?;
        open(&studio, &options.files)?;
        let address = gate.address();
        let app = router(Site { gate: Arc::new(gate), studio: Arc::clone(&studio) });
        let listener =
            runtime.block_on(async { tokio::net::TcpListener::from_std(listener) }).map_err(|e| system(&e))?;
        runtime.spawn(async move {
            // It ends with the runtime; a connection that fails does not end it.
            let _ = axum::serve(listener, app).await;
        });
        Ok(Self { address, studio, runtime: Some(runtime) })
    }

    /// The address of the page, with its token.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Waits for ever.
    pub fn wait(&self) {
        loop {
            std::thread::park();
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.studio.stop();
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

/// Puts files onto the desk: one document, or meshes as parts.
fn open(studio: &Studio, files: &[PathBuf]) -> Result<(), StartError> {
    for file in files {
        let real = file.canonicalize().map_err(|e| PathError::Io(file.display().to_string(), e))?;
        let path = studio.root.relative(&real).ok_or_else(|| PathError::Outside(file.display().to_string()))?;
        let is_document = real.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"));
        let edit = if is_document {
            Edit::Open { path }
        } else {
            Edit::AddPart { mesh: path, name: None, options: Map::new() }
        };
        studio.edit(edit).map_err(StartError::File)?;
    }
    Ok(())
}
