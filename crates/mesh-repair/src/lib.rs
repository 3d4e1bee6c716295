//! Repair of triangle meshes, one kind of defect at a time.
//!
//! Each step takes any mesh and returns a [`Mended`]: the mesh, the origin of every vertex and face, and how much was mended. What a
//! step does not name keeps its bits. Orientation and copies at non-manifold places are in `mesh_core` (`orient`, `split`).
//!
//! ```
//! use mesh_core::{Connected, Watch, shapes, validate};
//! use mesh_repair::fill_holes;
//!
//! // A ball without the faces around its lowest vertex.
//! let mut ball = shapes::icosphere(1.0, 3);
//! ball.faces.retain(|f| f.iter().all(|v| ball.positions[v.index()].z > -0.95));
//! let whole = fill_holes(&Connected::new(ball)?, &Watch::default())?;
//! assert!(validate(&whole.mesh).is_closed());
//! // The surface continues the ball: its volume comes back.
//! assert!((mesh_core::volume(&whole.mesh) / mesh_core::volume(&shapes::icosphere(1.0, 3)) - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `mended.rs` | what every step returns |
//! | `sides.rs` | the faces at every edge of any mesh |
//! | `usable.rs` | faces that name missing vertices or one vertex twice, or have corners nowhere; vertices that no face uses |
//! | `flat.rs` | faces without area |
//! | `duplicate.rs` | faces on the same three vertices |
//! | `speck.rs` | small components |
//! | `crack.rs`, `join.rs` | boundary edges that nearly coincide; which of their vertices become one |
//! | `hole.rs`, `patch.rs` | boundary loops filled one by one; the surface for one of them |

mod crack;
mod duplicate;
mod flat;
mod hole;
mod join;
mod mended;
mod patch;
mod sides;
mod speck;
mod usable;

pub use crack::close_cracks;
pub use duplicate::drop_duplicates;
pub use flat::drop_flat;
pub use hole::{Filled, Unfilled, Why, fill_holes};
pub use mended::Mended;
pub use speck::drop_specks;
pub use usable::{drop_unusable, drop_unused_vertices};
