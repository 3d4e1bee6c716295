//! Variational implicit functions: the smoothest field with given values, and gradients, at given points.
//!
//! A field f(x) = Σ wⱼ φ(|x − cⱼ|) + p(x) with an affine p interpolates constraints and bends as little as its kernel allows
//! (\[TurkOBrien2002\]). Its zero set is a surface through scattered points: negative inside, positive outside, gradients pointing out.
//!
//! ```
//! use glam::DVec3;
//! use rbf_solve::{Constraint, Field, Params};
//!
//! // A ball from the six ends of its axes, with normals.
//! let ends = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
//! let constraints = ends.map(|p| Constraint::with_normal(p, p));
//! let field = Field::fit(&constraints, &Params::default(), &|_| true)?;
//! assert!(field.residual() < 1e-12);
//! assert!(field.value(DVec3::ZERO) < 0.0 && field.value(DVec3::splat(1.0)) > 0.0);
//! assert!(field.gradient(DVec3::Y).distance(DVec3::Y) < 1e-12);
//! # Ok::<(), rbf_solve::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `constraint.rs`, `params.rs`, `error.rs` | what is asked, how, and why not |
//! | `kernel.rs` | the radial functions |
//! | `admit.rs`, `neighbours.rs` | checking, merging, centring and scaling of constraints |
//! | `affine.rs` | the affine part and the four unknowns that carry it |
//! | `sum.rs` | values and gradients of a sum of kernels, by vectors and threads |
//! | `dense.rs` | assembling and factoring the whole system |
//! | `iterate.rs`, `order.rs`, `screen.rs` | conjugate gradients for many constraints, and what makes them converge |
//! | `far.rs`, `translations.rs`, `octree.rs`, `meet.rs`, `chebyshev.rs` | sums over many centres at many points |
//! | `field.rs`, `patches.rs` | `Field`: fit, value, gradient; the same at many points along a surface |
//! | `thin.rs` | fewer constraints far from the boundary |
//! | `wide.rs` | loops for the machine's widest vectors |

#![allow(clippy::inline_always, reason = "only what is inlined is compiled for the widest vectors of the machine")]

mod admit;
mod affine;
mod chebyshev;
mod constraint;
mod dense;
mod error;
mod far;
mod field;
mod iterate;
mod kernel;
mod meet;
mod neighbours;
mod octree;
mod order;
mod params;
mod patches;
mod screen;
mod sum;
mod thin;
mod translations;
mod wide;

pub use constraint::Constraint;
pub use error::Error;
pub use field::{Field, Progress};
pub use kernel::Kernel;
pub use params::{Params, Solver};
pub use patches::Patches;
pub use thin::{Thinning, thin};
