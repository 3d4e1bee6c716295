//! Conformal maps of rings and discs of triangles into the plane.
//!
//! With a fixed boundary the map is *harmonic* with cotangent weights (\[PinkallPolthier1993\]): the discrete conformal
//! map where the boundary is that of one. A ring, which has two boundary loops, is cut along a path from one to the other
//! ([`Ring`]) and laid onto a rectangle, its ends meeting as on a cylinder or pinned to the rectangle's sides
//! ([`Seam`]). With a free boundary the map is the *spectral conformal* one (\[MullenTongAlliezDesbrun2008\]).
//!
//! ```
//! use mesh_core::{Connected, Faces, shapes};
//! use param_conformal::{Outline, Ring, Seam, map_ring};
//! let tube = Connected::new(shapes::open_cylinder(1.0, 2.0, 24, 6))?;
//! let ring = Ring::new(&tube)?;
//! let [from, to] = [0, 1].map(|side: usize| tube.tail(ring.loops()[side][0]));
//! let cut = ring.cut(&tube, ring.seam(&tube, from, to)?)?;
//! let map = map_ring(&tube, &cut, &Outline::by_length(&tube, &cut, 2.0), Seam::Periodic)?;
//! assert!(map.distortion(&tube).flipped.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Every map either has no flipped triangle or is refused with an error that names one.
//!
//! | file | holds |
//! |---|---|
//! | `ring.rs` | rings, and the seam that opens one into a rectangle |
//! | `rectangle.rs` | a ring on a rectangle with given boundary values |
//! | `harmonic.rs` | the cotangent Laplacian with fixed vertices, factorised for many right-hand sides |
//! | `free.rs` | discs with a free boundary |
//! | `relax.rs` | smoothing in the plane for better triangles elsewhere |
//! | `distortion.rs` | angles, areas and flips of a map |
//! | `error.rs` | what cannot be mapped, and where |

mod distortion;
mod error;
mod free;
mod harmonic;
mod rectangle;
mod relax;
mod ring;

pub use distortion::Distortion;
pub use error::Error;
pub use free::map_free;
pub use harmonic::{Harmonic, Weights, map_fixed};
pub use rectangle::{Outline, RingMap, Seam, map_ring, map_ring_with};
pub use relax::{RelaxParams, relax};
pub use ring::{CutRing, Ring};
