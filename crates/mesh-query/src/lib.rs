//! Closest points, rays and overlapping triangle pairs on triangle meshes.
//!
//! A [`TriBvh`] is a tree of boxes around the triangles of a mesh. It owns no geometry: every query takes the mesh it
//! was built from, so that the mesh stays yours to move around. Boxes are `f32` in a frame centred on the mesh and are
//! rounded outward; what is answered is always decided on the mesh's own `f64` coordinates, so coordinates may be
//! huge, tiny or far from the origin. Answers do not depend on the shape of the tree or on the number of threads.
//!
//! ```
//! use glam::DVec3;
//! use mesh_core::shapes;
//! use mesh_query::TriBvh;
//!
//! let cube = shapes::cuboid(DVec3::splat(2.0));
//! let bvh = TriBvh::build(&cube)?;
//! let near = bvh.closest_point(&cube, DVec3::new(0.2, 0.3, 5.0)).expect("the cube has faces");
//! assert!(near.point.abs_diff_eq(DVec3::new(0.2, 0.3, 1.0), 1e-15));
//! assert_eq!(near.distance, 4.0);
//! let hit = bvh.ray_cast(&cube, DVec3::new(0.2, 0.3, 5.0), DVec3::NEG_Z, f64::INFINITY).expect("it points there");
//! assert_eq!(hit.t, 4.0);
//! # Ok::<(), mesh_query::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `frame.rs` | the box frame: centre, power-of-two scale, outward rounding |
//! | `build.rs` | the tree and its construction, checks of the input |
//! | `order.rs` | triangles along a Morton curve, cut into leaves |
//! | `triangle.rs` | closest point on one triangle |
//! | `closest.rs` | closest point on a mesh |
//! | `ray.rs` | nearest and any hit of a ray, watertight |
//! | `overlap.rs` | triangles that meet a box, pairs whose boxes meet |
//! | `stack.rs` | the traversal stack |

mod build;
mod closest;
mod frame;
mod order;
mod overlap;
mod ray;
mod stack;
mod triangle;

pub use build::{Error, TriBvh};
pub use closest::ClosestPoint;
pub use ray::RayHit;
pub use triangle::closest_point_on_triangle;
