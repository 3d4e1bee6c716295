//! Rolling-ball blends of feature curves and seams of triangle meshes \[Liu2005\].
//!
//! Strips are swept along curves and sewn in between exactly cut linkages, with patches where they meet; where that fails,
//! the same ball acts as a field or by its envelope.
//!
//! ```
//! use mesh_core::{Connected, Watch, shapes};
//! use rolling_blend::{BlendCurve, Params, blend, features};
//! let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
//! let edges = features::feature_curves(&cube, &features::Params::default());
//! let curves: Vec<_> = edges.into_iter().map(BlendCurve::from).collect();
//! let blended = blend(&cube, &curves, &Params::new(0.1), &Watch::default())?;
//! assert_eq!((blended.strips, blended.corners), (12, 8));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `features.rs` | feature curves: chains of edges across which the surface turns sharply |
//! | `blended.rs` | the result |
//! | `stitch.rs` | a swept blend, and the loop that makes the ball smaller where it does not fit |
//! | `params.rs`, `error.rs` | how curves are blended; why they cannot be |
//! | `vicinity.rs` | the part of a large mesh that the blend is made on |
//! | `crossings.rs` | meshes that meet themselves beside a curve |
//! | `curve_blend.rs`, `measure.rs` | what each curve was blended by; the ball error of the result |
//! | `auto.rs` | which curves are swept and which are blended as a field |
//! | `zones/` | the envelope around places where a sweep fails, strips everywhere else |
//! | `networks.rs` | networks swept in part, with a smaller ball, or not at all |
//! | `so_far.rs` | a mesh on its way through several blends |
//! | `limit.rs`, `width.rs` | the largest radius that fits; how wide the sides of a curve are |
//! | `radii.rs`, `profiles.rs` | how radius and cross-section vary along a curve, and the radius between its sides |
//! | `mends.rs` | what has been done so far to make the blend fit |
//! | `rolling.rs` | a ball rolled along every curve |
//! | `network.rs` | the nodes at which open curves meet or end |
//! | `dwindle.rs` | the ball that dwindles where a curve runs out |
//! | `ending.rs` | rails cut to length there: set back, run out, or stopped at the surface ahead |
//! | `corner.rs` | how far curves that meet are set back, and the ball that touches all sides |
//! | `stretch.rs` | a rail cut to length |
//! | `cap.rs` | cross-sections at which a strip ends because something else goes on |
//! | `linkage.rs` | linkage curves on the surface, cut into the mesh |
//! | `strip.rs` | the swept surface as triangles |
//! | `fill.rs` | corner patches: their rims, and what they are tangent to |
//! | `plate.rs` | a disc of triangles bent onto a ball or into a thin plate |
//! | `sew.rs` | removal of what lies between, sewing |
//! | `field/` | the blend as a field: no spine, cannot fold |
//! | `envelope/` | networks by the envelope of all balls: any corner, consumed faces |
//! | `keep/` | the other surface: vertices slid onto the sweep, connectivity kept |
//! | `sketch.rs` | what the stages draw for whoever wants to look |
//! | `trouble.rs` | what a stage refuses, and where |

mod auto;
mod blended;
mod cap;
mod corner;
mod crossings;
mod curve_blend;
mod dwindle;
mod ending;
mod envelope;
mod error;
pub mod features;
mod field;
mod fill;
pub mod keep;
mod limit;
mod linkage;
pub mod measure;
mod mends;
mod network;
mod networks;
mod params;
mod plate;
mod profiles;
mod radii;
mod rolling;
mod sew;
mod sketch;
mod so_far;
mod stitch;
mod stretch;
mod strip;
mod trouble;
mod vicinity;
mod width;
mod zones;

pub use blended::Blended;
pub use curve_blend::{CurveBlend, LeftSharp, Method};
pub use error::Error;
pub use limit::{Limit, ListedRadius, listed_radius, max_radius};
use mesh_core::{Connected, TriMesh, Watch};
pub use params::{Overlap, Params, Surface};
pub use radii::Radii;
use rolling::affordable;
pub use sketch::{Drawing, Sketch, meaning};
pub use spine::BlendCurve;
use stitch::{ROUNDS, attempt, explained};
use trouble::Trouble;

/// Blends `curves` of `mesh`. Vertices outside the blend keep their bits and their order.
///
/// Where three or more open curves meet they are set back from a corner patch. One that ends alone stops at the surface
/// that bounds both its sides, or runs out where there is none.
///
/// # Errors
/// [`Error::DoesNotFit`] where the radius is the reason, with a place and a radius that works.
pub fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if let Surface::Keep(how) = &params.surface {
        let mut blended = keep::blend(mesh, curves, params, how, watch)?;
        let made = |c: &BlendCurve| CurveBlend::made(Method::Keep, params.radius, c.length(mesh), blended.full_share);
        blended.curves = curves.iter().map(made).collect();
        return Ok(blended);
    }
    affordable(mesh, curves, params)?;
    if let Some(near) = vicinity::vicinity(mesh, curves, params) {
        match blend_whole(&near.mesh, &near.curves, params, watch) {
            Ok(blended) if near.holds(&blended) => return Ok(near.put_back(blended)),
            Err(Error::Cancelled(c)) => return Err(c.into()),
            // It may be the rest of the mesh that was wanted.
            Ok(_) | Err(_) => {}
        }
    }
    blend_whole(mesh, curves, params, watch)
}

fn blend_whole(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if params.surface == Surface::Stitch {
        return attempt(mesh, curves, params, ROUNDS, watch)
            .or_else(|refusal| explained(mesh, curves, params, refusal, watch));
    }
    if let Some(at) = crossings::beside(mesh, curves, watch)? {
        // Where the blend takes the place away, all is well; there is no use in looking for more than that.
        return attempt(mesh, curves, params, ROUNDS, watch).map_err(|trouble| match trouble {
            Trouble::Cancelled(c) => c.into(),
            _ => Error::MeetsItself { at },
        });
    }
    auto::blend(mesh, curves, params, watch)
}
