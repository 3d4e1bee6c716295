//! Edge clusters of polyhedra blended by tensor-product and S-patches (\[EdgeCluster2019\]).
//!
//! An edge cluster {n+m} is a tree of n vertices with m open edges around it. One m-sided patch rounds all of it, and
//! keeps contact of order g with the m faces around: the control points that decide on contact with a face are put into
//! its plane. Where two patches end on one edge, a strip runs between them.
//!
//! ```
//! use edge_cluster::{Params, Polyhedron, PolyhedronParams, Spec, blend};
//! let cube = mesh_core::shapes::cuboid(glam::DVec3::ONE);
//! let cube = Polyhedron::new(&cube, None, &PolyhedronParams::default())?;
//! let corners: Vec<Spec> = cube.vertices().map(|v| Spec { vertices: vec![v], ..Spec::default() }).collect();
//! let round = blend(&cube, &corners, &Params::default(), 1e-2, 1.0, &mesh_core::Watch::default())?;
//! assert_eq!((round.layout.patches.len(), round.layout.strips.len()), (8, 12));
//! assert!(mesh_core::validate(&round.woven.mesh).is_closed());
//! # Ok::<(), edge_cluster::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `polyhedron.rs`, `plane.rs` | planar faces with holes, read off a mesh; planes and where they meet |
//! | `cluster.rs` | a cluster: its backbone, open edges and sides |
//! | `cover.rs`, `symmetry.rs` | clusters chosen automatically, as symmetric as the polyhedron is |
//! | `budget.rs` | what is too large to be covered |
//! | `control.rs` | control points by index, and the sides whose contact they decide |
//! | `net.rs`, `fair.rs` | control nets: every point in its planes, and in a fair place there |
//! | `embedding.rs`, `spatch.rs`, `patch.rs` | evaluation with derivatives |
//! | `contact.rs` | the order of contact, measured |
//! | `hartmann.rs` | strips along open edges |
//! | `layout.rs`, `blend.rs` | how far each blend reaches, and the whole |
//! | `sample.rs`, `rings.rs`, `planar.rs`, `weave.rs` | one watertight mesh of it all |
//! | `step.rs` | STEP files |
//! | `solids.rs` | polyhedra for tests and fixtures |
//! | `error.rs` | why there is no blend |

mod blend;
mod budget;
mod cluster;
mod contact;
mod control;
mod cover;
mod embedding;
mod error;
mod fair;
mod hartmann;
mod layout;
mod net;
mod patch;
mod planar;
mod plane;
mod polyhedron;
mod rings;
mod sample;
pub mod solids;
mod spatch;
mod step;
mod symmetry;
mod weave;

pub use blend::{Blend, blend};
pub use budget::check_budget;
pub use cluster::Cluster;
pub use contact::contact_slopes;
pub use control::Shape;
pub use cover::{Cover, Params as CoverParams, cover};
pub use embedding::Polygon;
pub use error::Error;
pub use hartmann::{Params as StripParams, Strip};
pub use layout::{Degree, Layout, Params, Spec};
pub use net::{Move, Net, Params as NetParams};
pub use patch::Patch;
pub use plane::{Flat, Plane};
pub use polyhedron::{Face, Halfedge, Params as PolyhedronParams, Polyhedron, Turn};
pub use profile_nurbs::SurfaceJet;
pub use spatch::SPatch;
pub use step::{Step, to_step};
pub use symmetry::symmetries;
pub use weave::{Part, Place, Woven, weave};
