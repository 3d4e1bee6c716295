//! Procedural shapes for tests and fixtures, all closed and oriented outward unless said otherwise.
//!
//! Lengths are in model units. Counts below the least that makes sense are raised to it.
//!
//! | file | holds |
//! |---|---|
//! | `solids.rs` | boxes and subdivided spheres |
//! | `flat.rs` | plane grids, subdivided boxes, the L-bracket |
//! | `round.rs` | shapes of revolution |

mod flat;
mod round;
mod solids;

pub use flat::{bracket, cuboid_grid, grid};
pub use round::{capsule, cone, cylinder, open_cylinder, torus, truncated_cone, tube, uv_sphere};
pub use solids::{cuboid, icosphere};
