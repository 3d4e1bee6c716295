//! Area-equalizing remeshing, smoothing and fairing of surfaces, with frozen boundaries and features.
//!
//! ```
//! use mesh_core::{Connected, Watch, shapes};
//! use remesh::{Frozen, Params, Projection, Sizing, remesh};
//!
//! let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
//! let params = Params::new(0.1);
//! let fine = remesh(&cube, &Frozen::default(), Sizing::Uniform, &params, Projection::Input, &Watch::default())?;
//! // Edges and corners are features, so the cube is still exactly a cube.
//! assert!((mesh_core::volume(&fine.mesh) - 1.0).abs() < 1e-12);
//! assert!(fine.mesh.faces.len() > 1000);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `isotropic/mod.rs`, `isotropic/params.rs` | the rounds of a remeshing, and what is wanted of it |
//! | `isotropic/grade.rs` | wanted edge lengths between boundaries of different fineness |
//! | `isotropic/refine.rs` | long edges split, and nothing else |
//! | `isotropic/table.rs`, `isotropic/state.rs` | the editable surface; split, collapse and flip |
//! | `isotropic/features.rs`, `isotropic/lines.rs` | feature polylines, and vertices that slide along them |
//! | `isotropic/relax.rs` | tangential relaxation; taking back what folds |
//! | `isotropic/seat.rs` | points put back onto the input |
//! | `smooth/taubin.rs`, `smooth/flow.rs` | smoothing that keeps the volume, and by implicit curvature flow |
//! | `smooth/fair.rs` | harmonic, biharmonic and triharmonic fairing |
//! | `smooth/held.rs` | what may move, and systems in it |
//! | `hierarchy.rs` | decimation level by level, and details put back |
//! | `error.rs` | why there is no result |

mod error;
mod hierarchy;
mod isotropic;
mod smooth;

pub use error::Error;
pub use hierarchy::Hierarchy;
pub use isotropic::{Frozen, Params, Projection, Remeshed, Sizing, graded_sizes, refine, remesh, remesh_observed};
pub use smooth::{Fairing, Fairness, Flow, Taubin, curvature_flow, fair, taubin};
