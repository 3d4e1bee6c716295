//! Procedural shapes for tests and fixtures, all closed and oriented outward unless said otherwise.
//!
//! Lengths are in model units. Counts below the least that makes sense are raised to it.
//!
//! | file | holds |
//! |---|---|
//! | `solids.rs` | boxes and subdivided spheres |
//! | `flat.rs` | plane grids, subdivided boxes, the L-bracket |
//! | `round.rs` | shapes of revolution |
//! | `teapot.rs` | the Newell teapot, open and closed |
//! | `organic.rs` | bumpy blobs, and the placing of shapes |

mod flat;
mod organic;
mod round;
mod solids;
mod teapot;

pub use flat::{bracket, cuboid_grid, grid};
pub use organic::{blob, posed};
pub use round::{capsule, cone, cylinder, open_cylinder, torus, truncated_cone, tube, uv_sphere};
pub use solids::{cuboid, geodesic_sphere, icosphere};
pub use teapot::{Teapot, closed_teapot, teapot};
