//! Smoothing and fairing: vertices move, triangles stay.

mod cholesky;
mod fair;
mod flow;
mod held;
mod laplace;
mod taubin;

pub use fair::{Fairing, Fairness, fair};
pub use flow::{Flow, curvature_flow};
pub use taubin::{Taubin, taubin};
