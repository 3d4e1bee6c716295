//! Geometry detail taken from one surface and continued on another (\[Lin2008\] §4.2).
//!
//! A surface is taken apart into a smooth *base* and the *detail* on it: at every vertex, by how much its Laplacian differs from the base's and how
//! far it stands off, in a local frame. Detail moves from vertex to vertex as plain numbers; a sparse least-squares system, prepared once, makes a
//! surface of base and detail again.
//!
//! ```
//! use detail_transfer::{Exemplar, Params, transfer};
//! use mesh_core::{Connected, Faces, Watch, shapes};
//! // A wavy plane with a flat hole in its middle, to be filled from around it.
//! let mut plane = shapes::grid(4.0, 4.0, 64, 64);
//! for p in &mut plane.positions {
//!     p.z = if p.truncate().length() < 0.6 { 0.0 } else { 0.02 * (9.0 * p.x).sin() * (9.0 * p.y).sin() };
//! }
//! let mesh = Connected::new(plane)?;
//! let middle = |f| mesh.mesh().triangle(f).iter().sum::<glam::DVec3>() / 3.0;
//! let hole = mesh.face_ids().map(|f| middle(f).length() < 0.6).collect::<Vec<_>>().into();
//! let rest = mesh.face_ids().map(|f| middle(f).length() > 0.7).collect::<Vec<_>>().into();
//! let source = Exemplar { mesh: &mesh, inside: &rest };
//! let params = Params { wavelength: Some(1.0), ..Params::default() };
//! let done = transfer(&mesh, &hole, &[source], &params, &Watch::default())?;
//! assert!(done.moved.iter().any(|v| done.mesh.positions[v.index()].z > 0.01));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `transfer.rs` | the whole way |
//! | `relief.rs` | bases, details, frames |
//! | `patch.rs` | a region and its surroundings as a mesh of its own |
//! | `operator.rs` | the cotangent Laplacian of a patch, diffusion |
//! | `reconstruct.rs` | base and detail to surface |
//! | `unstructured.rs` | vertex by vertex, by similar surroundings |
//! | `coherence.rs` | copying on beside what a neighbour copied |
//! | `fan.rs` | surroundings: geodesic fans |
//! | `library.rs`, `tree.rs` | the most similar fan, by looking at all or by a tree |
//! | `structured.rs`, `rectangle.rs` | patch by patch along a curve |
//! | `spectrum.rs` | the source's strength at every scale |
//! | `roughness.rs` | how rough a surface is, at which scales |
//! | `error.rs` | what cannot be taken or given, and where |

mod coherence;
mod error;
mod fan;
mod library;
mod operator;
mod patch;
mod reconstruct;
mod rectangle;
mod relief;
mod roughness;
mod spectrum;
mod structured;
mod transfer;
mod tree;
mod unstructured;

pub use error::Error;
pub use reconstruct::Reconstruction;
pub use relief::{BaseParams, Detail, Frame, Relief};
pub use roughness::{Roughness, roughness};
pub use structured::{Banded, Ribbon, fill_structured};
pub use transfer::{Exemplar, FanLength, Params, Transferred, Warning, transfer};
pub use unstructured::{Choice, Filled, Search, fill_unstructured, similarity};
