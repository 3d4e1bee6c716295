//! A local web studio that joins and blends triangle meshes: a server on this machine, and a page in the browser that shows what it
//! makes. The page holds no geometry code: it sends documents and picks, and draws arrays.
//!
//! ```no_run
//! use fusion_studio::{Options, Server};
//! let server = Server::start(&Options::default())?;
//! println!("{}", server.address());
//! server.wait();
//! # Ok::<(), fusion_studio::StartError>(())
//! ```
//!
//! PROTOCOL.md says what page and server tell each other.
//!
//! | file | holds |
//! |---|---|
//! | `args.rs`, `server.rs` | what can be typed; a running server |
//! | `gate.rs`, `root.rs` | who is let in; which files are read and written |
//! | `http.rs`, `bundle.rs`, `upload.rs` | addresses, the page, files from the page |
//! | `socket.rs`, `request.rs`, `answer.rs`, `refusal.rs` | one client: what it asks, what it is told |
//! | `studio.rs`, `audience.rs`, `outbox.rs` | what all clients share, who they are, what waits for each |
//! | `desk.rs`, `history.rs`, `edit.rs`, `rename.rs`, `rebase.rs`, `value.rs` | the document, its past, changes of its text |
//! | `play.rs` | requests without a server, for tests |
//! | `autosave.rs` | the document kept while it is not saved |
//! | `evaluator.rs`, `sources.rs`, `scene.rs` | one evaluation at a time, its files, what came of it |
//! | `event.rs`, `frame.rs`, `remedy.rs` | what the server says by itself: JSON, arrays, buttons |
//! | `questions.rs`, `edges.rs`, `limits.rs` | questions about shapes, their curves, the largest radius |
//! | `export.rs`, `listing.rs` | files written, files there are |

mod answer;
mod args;
mod audience;
mod autosave;
mod bundle;
mod desk;
mod edges;
mod edit;
mod evaluator;
mod event;
mod export;
mod frame;
mod gate;
mod history;
mod http;
mod limits;
mod listing;
mod outbox;
mod play;
mod questions;
mod rebase;
mod refusal;
mod remedy;
mod rename;
mod request;
mod root;
mod scene;
mod server;
mod socket;
mod sources;
mod studio;
mod upload;
mod value;

pub use args::main;
pub use play::play;
pub use refusal::Refusal;
pub use root::PathError;
pub use server::{Options, Server, StartError};
