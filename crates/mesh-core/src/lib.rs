//! Triangle-mesh data, connectivity, measures and validation: the room every other crate stands on.
//!
//! ```
//! use mesh_core::{Adjacency, Connected, Faces, VertexId, shapes};
//! let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
//! assert_eq!(cube.face_count(), 12);
//! assert!(cube.ring(VertexId(0)).count() >= 3);
//! # Ok::<(), mesh_core::NotManifold>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `ids.rs`, `map.rs` | typed indices and the vectors they index |
//! | `traits.rs` | the five traits: faces, adjacency, positions, sink, edit observer |
//! | `mesh.rs` | `TriMesh`, passive positions and faces |
//! | `connected.rs`, `corner_table.rs` | `Connected`, the one place that decides manifoldness |
//! | `origin.rs` | provenance of vertices and faces |
//! | `surface_point.rs` | a point on a mesh, by vertex, edge or face |
//! | `bounds.rs` | axis-aligned boxes |
//! | `watch.rs` | progress and cancellation |
//! | `shapes/` | procedural shapes for tests and fixtures |

mod bounds;
mod connected;
mod corner_table;
mod ids;
pub mod map;
mod mesh;
mod origin;
pub mod shapes;
mod surface_point;
mod traits;
mod watch;

pub use bounds::Bounds;
pub use connected::{Connected, NotManifold};
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use map::{CornerMap, EdgeMap, FaceMap, IdMap, VertexMap};
pub use mesh::TriMesh;
pub use origin::{FaceOrigin, Origins, VertexOrigin};
pub use surface_point::SurfacePoint;
pub use traits::{Adjacency, EditObserver, Faces, MeshSink, Positions, Ring};
pub use watch::{Cancelled, Watch};
