//! Localized marching cubes: the part of a zero set that lies between given rims, welded to them.
//!
//! Parts of a model end in boundary loops, their *rims*. A scalar field, negative inside, vanishes there. [`tessellate`]
//! follows its zero set outward from the rims through a sparse grid, triangulates it with the topology of the trilinear
//! field in every cell, leaves out what lies behind the rims, and bridges the gap to the rims' own vertices
//! (\[Lin2008\] §3).
//!
//! ```
//! use glam::DVec3;
//! use lmc_tessellate::{Params, Rim, suggested_cell, tessellate};
//! use mesh_core::{Connected, TriMesh, Watch, boundary_loops, shapes};
//!
//! // A ball without its middle: two caps, two rims.
//! let ball = shapes::uv_sphere(1.0, 48, 24);
//! let height = |f: &[mesh_core::VertexId; 3]| f.iter().map(|v| ball.positions[v.index()].z).sum::<f64>() / 3.0;
//! let faces = ball.faces.iter().filter(|f| height(f).abs() > 0.5).copied().collect();
//! let caps = Connected::new(TriMesh { positions: ball.positions.clone(), faces })?;
//! let rims: Vec<Rim> = boundary_loops(&caps).iter().map(|walk| Rim::of(&caps, walk)).collect();
//!
//! let field = |points: &[DVec3], values: &mut [f64]| {
//!     values.iter_mut().zip(points).for_each(|(v, p)| *v = p.length() - 1.0);
//! };
//! let params = Params { cell: suggested_cell(&rims), ..Params::default() };
//! let made = tessellate(&rims, &field, &params, &Watch::default())?;
//! assert_eq!(made.mesh.positions[..48], rims[0].points);
//! assert!(made.mesh.positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-4));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `tessellate.rs` | the stages in order, the parameters, the check of the result |
//! | `rim.rs` | rims, their samples on the zero set, and how near a point is to them |
//! | `grid.rs` | the sparse grid and its exploration along the zero set |
//! | `cell.rs` | which surfaces a cell holds: face and interior tests |
//! | `tile.rs` | triangles for them |
//! | `extract.rs` | the mesh of all cells, vertices placed by root finding |
//! | `isosurface.rs` | the zero set of a dense grid of samples |
//! | `trim.rs`, `border.rs` | what lies beyond the rims, and its smoothed border |
//! | `gap.rs`, `bridge.rs` | curves that share a gap; strips and polygons of least cost |
//! | `error.rs` | what can go wrong, and where |

mod border;
mod bridge;
mod cell;
mod error;
mod extract;
mod gap;
mod grid;
mod isosurface;
mod rim;
mod tessellate;
mod tile;
mod trim;

pub use bridge::polygon;
pub use error::Error;
pub use grid::Field;
pub use isosurface::isosurface;
pub use rim::Rim;
pub use tessellate::{Params, Transition, suggested_cell, tessellate};
