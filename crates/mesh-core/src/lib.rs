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
//! | `ids.rs`, `map.rs`, `id_hash.rs` | typed indices, the vectors they index, sets of them |
//! | `traits.rs` | the five traits: faces, adjacency, positions, sink, edit observer |
//! | `mesh.rs` | `TriMesh`, passive positions and faces |
//! | `connected.rs`, `corner_table.rs`, `edge_groups.rs`, `not_manifold.rs` | `Connected`, the one place that decides manifoldness |
//! | `carried.rs` | the same for meshes made from connected ones |
//! | `validate.rs`, `collinear.rs` | every defect of a mesh, by kind |
//! | `loops.rs`, `components.rs` | boundary loops and connected components |
//! | `normal.rs` | normals of faces, vertices, sides and corners |
//! | `measure.rs` | area, volume, edge lengths, dihedral angles, genus |
//! | `geodesic.rs`, `sectors.rs`, `path.rs` | distance floods with barriers, cheapest paths along edges |
//! | `segment.rs` | distances from segments and polylines |
//! | `origin.rs`, `compose.rs` | provenance of vertices and faces, composed across stages |
//! | `surface_point.rs` | a point on a mesh, by vertex, edge or face |
//! | `trace.rs` | straight walks over the surface between two points |
//! | `bounds.rs` | axis-aligned boxes |
//! | `curvature.rs` | mixed areas, mean-curvature vectors |
//! | `orient.rs`, `split.rs` | repair on request: orientation, copies at non-manifold places |
//! | `conformance.rs` | checks for implementors of the traits, behind the feature `conformance` |
//! | `watch.rs`, `stopwatch.rs` | progress and cancellation, time |
//! | `shapes/` | procedural shapes for tests and fixtures |

mod bounds;
mod carried;
mod collinear;
mod components;
mod compose;
#[cfg(any(test, feature = "conformance"))]
pub mod conformance;
mod connected;
mod corner_table;
mod curvature;
mod edge_groups;
mod geodesic;
mod id_hash;
mod ids;
mod loops;
pub mod map;
mod measure;
mod mesh;
mod normal;
mod not_manifold;
mod orient;
mod origin;
mod path;
mod sectors;
mod segment;
pub mod shapes;
mod split;
mod stopwatch;
mod surface_point;
mod trace;
mod traits;
mod validate;
mod watch;

pub use bounds::Bounds;
pub use collinear::collinear;
pub use components::{Components, components};
pub use compose::Stage;
pub use connected::Connected;
pub use curvature::{mean_curvature_vectors, mixed_areas};
pub use geodesic::{Flood, FloodParams, Seed, Source, flood};
pub use id_hash::IdSet;
pub use ids::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use loops::boundary_loops;
pub use map::{CornerMap, FaceMap, IdMap, VertexMap};
pub use measure::{
    EdgeLengths, Topology, area, bounds, centroid, component_topologies, dihedral_angle, edge_lengths, topology, volume,
};
pub use mesh::TriMesh;
pub use normal::{
    area_vector, corner_angle, corner_normals, face_normal, face_normals, one_sided_normal, triangle_normal,
    vertex_normals,
};
pub use not_manifold::NotManifold;
pub use orient::orient;
pub use origin::{FaceOrigin, Origins, VertexOrigin};
pub use path::shortest_path;
pub use segment::{closed_segments, closest_on_segment, distance_to_segment, distance_to_segments, open_segments};
pub use split::split;
pub use stopwatch::Stopwatch;
pub use surface_point::SurfacePoint;
pub use trace::{TraceError, TraceLimits, trace};
pub use traits::{Adjacency, EditObserver, Faces, MeshSink, Positions, Ring};
pub use validate::{Report, validate};
pub use watch::{Cancelled, Watch};
