//! Rolling-ball spine and linkage curves on triangle meshes.
//!
//! A ball kept in contact with the two sides of a blend curve traces a *spine curve* with its centre and a *linkage
//! curve* on each side with its feet (\[Liu2005\] §3).
//!
//! ```
//! use mesh_core::{Connected, VertexId, shapes};
//! use spine::{BlendCurve, Params, roll};
//! let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
//! let rim = BlendCurve::from_vertices(&cube, &[4, 5, 7, 6].map(VertexId))?;
//! let rail = roll(&cube, &rim, std::slice::from_ref(&rim), &Params::new(0.1))?;
//! assert!(rail.residual <= 1e-9 * 0.1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `roll.rs` | the way from a curve to a rail: patches wide enough, the spine, fair linkages |
//! | `curve.rs` | blend curves: chains of edges, ridge or valley |
//! | `radius.rs` | the ball's radius as a field in space |
//! | `law.rs` | how it varies along the curve |
//! | `patch.rs` | the two sides of a curve, flooded to α·r |
//! | `contact.rs` | one ball at rest against both, by Newton on closest points |
//! | `march.rs` | the ball along the whole curve |
//! | `offset.rs`, `offset/` | the other solver: the crossing of the two offset patches |
//! | `fair.rs` | feet smoothed into fair linkages |
//! | `regress.rs` | folds of the sweep cut out and bridged |
//! | `bend.rs` | how the sides bend across the curve |
//! | `error.rs` | why a ball cannot be rolled, and how far it came |

mod bend;
mod contact;
mod curve;
mod error;
mod fair;
mod law;
mod march;
mod offset;
mod patch;
mod radius;
mod regress;
mod roll;

pub use contact::Contact;
pub use curve::{BlendCurve, Convexity};
pub use error::{Error, Halt};
pub use fair::{Sample, Softening};
pub use law::Law;
pub use offset::{OffsetKeep, OffsetParams};
pub use patch::{Patch, Side};
pub use radius::{Dip, RadiusField};
pub use roll::{roll, roll_or_halt};

use mesh_core::EdgeId;
use std::sync::Arc;

/// How the ball rolls.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Ball radius in model units, positive and finite, with its dips.
    pub radius: RadiusField,
    /// Least reach of the base patches, as a multiple of the radius. The paper uses 1.75; sharp wedges need more and
    /// get it by themselves, so that a larger value costs time and gains nothing.
    pub alpha: f64,
    /// Step along the spine, in model units.
    pub step: f64,
    /// Longest step, taken where the spine is straight; anything up to `step` means that none is longer.
    pub longest: f64,
    /// Largest sagitta of a step longer than `step`, as a share of the radius.
    pub sagitta: f64,
    /// Standard deviation of the kernel that fairs each linkage, in mean lengths of the facets it crosses. It is never
    /// taken beyond half the radius, and is zero on planes and across creases.
    pub fairness: f64,
    /// Longest gap that is bridged where profiles fall behind their predecessors, in radii; 0 leaves folds as they are.
    pub bridge: f64,
    /// Where the linkages are smoothed more.
    pub softenings: Vec<Softening>,
    /// What finds the spine.
    pub solver: Solver,
    /// Edges that no patch floods across, beside the curves themselves: creases at which an open curve ends.
    pub walls: Vec<EdgeId>,
}

/// Which solver finds the spine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Solver {
    /// Newton on closest points, step by step: exact on the mesh.
    #[default]
    Contact,
    /// The crossing of the offset patches, as in \[Liu2005\] §3: off by the sagitta of the facets, with feet that do not
    /// stick, and for patches that do not fold when moved by the radius.
    Offset(OffsetParams),
}

impl Params {
    /// A constant radius, steps of r/5, fairing by 0.6 facets.
    pub fn new(radius: f64) -> Self {
        Self {
            radius: RadiusField::constant(radius),
            alpha: 1.75, // [Liu2005] §3
            step: 0.2 * radius,
            longest: 0.0,
            sagitta: 1e-3,
            fairness: 0.6,
            bridge: 3.0,
            softenings: Vec::new(),
            solver: Solver::Contact,
            walls: Vec::new(),
        }
    }
}

/// A ball's way along a blend curve.
#[derive(Clone, Debug)]
pub struct Rail {
    /// Balls in order, running the same way as the blend curve. Along a closed one the last is next to the first; along
    /// an open one they begin and end past its ends, as far as the patches carry the ball.
    pub samples: Vec<Sample>,
    /// Whether the ball comes back to where it began.
    pub closed: bool,
    /// Ridge or valley.
    pub convexity: Convexity,
    /// Largest | distance from a traced centre to a patch − radius |, in model units; at most 1e-9 of the radius from
    /// [`Solver::Contact`].
    pub residual: f64,
    /// How many balls stood where the sweep folds, and gave way to a bridge.
    pub bridged: usize,
    /// Reach of the base patches that was needed, as a multiple of the radius.
    pub alpha: f64,
    /// The left and the right base patch.
    pub patches: Arc<[Patch; 2]>,
}
