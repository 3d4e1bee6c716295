//! Discrete Laplacians, sparse systems and submeshes: the numeric layer that remeshing, maps, detail and clusters share.
//!
//! ```
//! use mesh_core::{Connected, shapes};
//! use mesh_operators::{HeldSystem, Laplacian, Unknowns};
//! // A harmonic function between two values that are held at opposite corners of a square.
//! let square = Connected::new(shapes::grid(1.0, 1.0, 8, 8))?;
//! let laplacian = Laplacian::cotangent(&square);
//! let unknowns = Unknowns::new(81, |v| v != 0 && v != 80);
//! let system = HeldSystem::new(unknowns, |v, row| laplacian.add_row(v, 1.0, row))?;
//! let mut x = vec![glam::DVec3::ZERO; 81];
//! x[80] = glam::DVec3::ONE;
//! system.solve(&mut x, &[], 1);
//! assert!((x[40].x - 0.5).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Degenerate faces.** One rule serves every operator: a triangle narrower than [`NARROWEST`] of its longest side counts as that wide. Its
//! cotangents shrink by one factor, so that its energy stays non-negative and no weight is beyond about 10⁴; a triangle whose corners
//! coincide has no weights at all. No vertex counts for less than [`LEAST_AREA`] of the mean.
//!
//! | file | holds |
//! |---|---|
//! | `cotangent.rs` | corner cotangents, edge weights, vertex areas, the rule for degenerate faces |
//! | `mean_value.rs` | mean value weights |
//! | `laplacian.rs` | Laplacians row by row |
//! | `sparse.rs` | rows and lower triangles of sparse matrices |
//! | `cholesky.rs` | prepared sparse Cholesky factors, the same bits for any thread count |
//! | `unknowns.rs`, `held.rs` | systems in which some values are held |
//! | `conjugate.rs` | conjugate gradients |
//! | `eigen.rs` | small symmetric eigenvectors and singular values |
//! | `submesh.rs` | some faces of a mesh as a mesh, with maps back |
//! | `error.rs` | what cannot be solved, and at which unknown |

mod cholesky;
mod conjugate;
mod cotangent;
mod eigen;
mod error;
mod held;
mod laplacian;
mod mean_value;
mod sparse;
mod submesh;
mod unknowns;

pub use cholesky::{Cholesky, HermitianCholesky};
pub use conjugate::{Converged, Stop, Vector, conjugate_gradients};
pub use cotangent::{LEAST_AREA, NARROWEST, cotangent_weight, cotangents, vertex_areas};
pub use eigen::{Svd, eigen3, eigenvectors, svd3};
pub use error::NotPositiveDefinite;
pub use held::HeldSystem;
pub use laplacian::Laplacian;
pub use sparse::{LowerTriangle, SparseRows};
pub use submesh::Submesh;
pub use unknowns::Unknowns;
