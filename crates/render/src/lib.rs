//! Still pictures of triangle meshes by ray casting.
//!
//! Three soft lights that move with the camera, ambient occlusion, crease-aware smooth shading, anti-aliased edges,
//! and colour that shows what one wants to judge: curvature, origin, triangle quality, reflection lines. Any mesh with
//! finite corners can be drawn, manifold or not; back faces get a tint of their own, so that holes and flipped
//! triangles show. The same input gives the same bytes for any number of threads.
//!
//! ```
//! use mesh_core::{Watch, shapes};
//! use render::{Color, Params};
//!
//! let sphere = shapes::icosphere(1.0, 3);
//! let params = Params { width: 64, height: 64, color: Color::Curvature, ..Params::default() };
//! let picture = render::picture(&sphere, &params, &Watch::default())?;
//! assert_eq!(picture.dimensions(), (64, 64));
//! # Ok::<(), render::Error>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `params.rs` | what to draw and how, and what can go wrong |
//! | `camera.rs` | framing, rays and projection |
//! | `scene.rs` | the mesh in a unit frame, its tree, what a ray sees |
//! | `normals.rs` | corner normals, averaged up to creases |
//! | `curvature.rs` | mean curvature by cotangent weights |
//! | `color.rs` | the colour of a surface point |
//! | `light.rs` | lights, tone and sRGB |
//! | `ambient.rs` | ambient occlusion, interleaved and filtered |
//! | `wire.rs` | triangle edges of constant width on the picture |
//! | `picture.rs` | the picture, pass by pass |
//! | `raster.rs` | its pixels, and PNG files of them |

mod ambient;
mod camera;
mod color;
mod curvature;
mod light;
mod normals;
mod params;
mod picture;
mod raster;
mod scene;
mod wire;

pub use color::shape_quality;
pub use params::{Color, Error, Ground, Params, Projection, Shading, Wireframe};
pub use picture::picture;
pub use raster::{Picture, save};
