//! Smoothing and fairing: vertices move, triangles stay.

mod fair;
mod flow;
mod held;
mod taubin;

pub use fair::{Fairing, Fairness, fair};
pub use flow::{Flow, curvature_flow};
pub use taubin::{Taubin, taubin};
