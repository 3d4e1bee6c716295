//! Procedural shapes for tests and fixtures, all closed and oriented outward unless said otherwise.
//!
//! | file | holds |
//! |---|---|
//! | `solids.rs` | boxes and subdivided spheres |

mod solids;

pub use solids::{cuboid, icosphere};
