//! The server from outside, by the page's own protocol.

mod client;
mod hostile;
mod session;
