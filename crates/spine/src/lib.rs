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

mod bend;
mod contact;
mod curve;
mod fair;
mod law;
mod march;
mod offset;
mod patch;
mod radius;
mod regress;

pub use contact::Contact;
pub use curve::{BlendCurve, Convexity};
pub use fair::{Sample, Softening};
pub use law::Law;
pub use offset::{OffsetKeep, OffsetParams};
pub use patch::{Patch, Side};
pub use radius::{Dip, RadiusField};

use glam::DVec3;
use march::Footing;
use mesh_core::{Adjacency, EdgeId, HalfedgeId, IdSet, Positions, VertexId};
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

/// Why a ball could not be rolled. Every variant names a place in model units.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Two consecutive vertices of a curve are not joined by an inner edge.
    #[error(
        "vertices {from} and {to} at {at} are not joined by an edge with two faces; a blend curve runs along mesh edges"
    )]
    NotAnEdge {
        /// First vertex.
        from: VertexId,
        /// Second vertex.
        to: VertexId,
        /// Where the first vertex is.
        at: DVec3,
    },
    /// The curve is partly a ridge and partly a valley.
    #[error("the curve changes between ridge and valley near {at} ({:.0}% of its length differs); split it there", 100.0 * .share)]
    MixedConvexity {
        /// Where the first edge of the lesser kind is.
        at: DVec3,
        /// Share of the length that is of the lesser kind.
        share: f64,
    },
    /// The radius is not a positive finite number.
    #[error("a radius of {radius} is not a positive length")]
    BadRadius {
        /// The radius given.
        radius: f64,
    },
    /// No ball can be seated anywhere on the curve.
    #[error("a ball of radius {radius} touches both sides nowhere along the curve at {at}; try a smaller radius")]
    NoStart {
        /// A point of the curve.
        at: DVec3,
        /// The radius tried.
        radius: f64,
    },
    /// The ball cannot go on.
    #[error("the ball cannot roll on at {at} with radius {radius}; a smaller radius (or a dip there) may pass")]
    Stuck {
        /// The ball's centre.
        at: DVec3,
        /// Its radius there.
        radius: f64,
        /// The radius away from dips.
        wanted: f64,
    },
    /// The spine does not close.
    #[error(
        "the spine has not come back after {travelled}, at {at}, on a curve of length {curve}; try a smaller radius"
    )]
    Astray {
        /// Where the trace was given up.
        at: DVec3,
        /// How far it had gone.
        travelled: f64,
        /// Length of the blend curve.
        curve: f64,
    },
    /// The offset patches do not cross in a closed curve.
    #[error(
        "the patches moved by {radius} cross in no closed curve near {at}; try a smaller radius or the contact solver"
    )]
    NoLoop {
        /// Where the longest open crossing ends, or else a point of the curve.
        at: DVec3,
        /// The radius there.
        radius: f64,
    },
    /// The offset patches cross where they are folded, farther than can be bridged.
    #[error(
        "a patch moved by {radius} folds over at {at}, so no ball fits; try a smaller radius or the contact solver"
    )]
    Folded {
        /// The middle of the fold.
        at: DVec3,
        /// The radius there.
        radius: f64,
    },
    /// The step is lost beside the length of the spine.
    #[error("a spine of length {length} at {at} cannot be walked in steps of {step}; take a larger radius or step")]
    TooFine {
        /// A point of the spine.
        at: DVec3,
        /// Its length.
        length: f64,
        /// The step asked for.
        step: f64,
    },
    /// The patch has coordinates that boxes cannot hold.
    #[error(transparent)]
    Query(#[from] mesh_query::Error),
}

impl Error {
    /// Where it happened, if it happened somewhere.
    pub fn place(&self) -> Option<DVec3> {
        match *self {
            Self::NotAnEdge { at, .. }
            | Self::MixedConvexity { at, .. }
            | Self::NoStart { at, .. }
            | Self::Stuck { at, .. }
            | Self::Astray { at, .. }
            | Self::NoLoop { at, .. }
            | Self::TooFine { at, .. }
            | Self::Folded { at, .. } => Some(at),
            Self::BadRadius { .. } | Self::Query(_) => None,
        }
    }
}

/// A ball that did not come all the way: why, and what there is to look at.
#[derive(Clone, Debug)]
pub struct Halt {
    /// Why.
    pub error: Error,
    /// The base patches, if they had been flooded.
    pub patches: Option<Arc<[Patch; 2]>>,
    /// Centres of the balls on the way so far, in order.
    pub balls: Vec<DVec3>,
}

impl From<Error> for Box<Halt> {
    fn from(error: Error) -> Self {
        Self::new(Halt { error, patches: None, balls: Vec::new() })
    }
}

impl From<mesh_query::Error> for Box<Halt> {
    fn from(error: mesh_query::Error) -> Self {
        Error::from(error).into()
    }
}

/// Rolls a ball along `curve`. `all_curves` are the curves being blended together: no patch floods across any of them.
///
/// Cost grows with the faces within reach and the samples along the curve, not with the mesh.
///
/// # Errors
/// Every [`Error`]; those with a place may pass with a smaller radius there.
pub fn roll<M: Adjacency + Positions + Sync>(
    mesh: &M,
    curve: &BlendCurve,
    all_curves: &[BlendCurve],
    params: &Params,
) -> Result<Rail, Error> {
    roll_or_halt(mesh, curve, all_curves, params).map_err(|halt| halt.error)
}

/// [`roll`], with what there is to look at where the ball halts.
///
/// # Errors
/// [`Halt`].
pub fn roll_or_halt<M: Adjacency + Positions + Sync>(
    mesh: &M,
    curve: &BlendCurve,
    all_curves: &[BlendCurve],
    params: &Params,
) -> Result<Rail, Box<Halt>> {
    let radius = &params.radius;
    if !(radius.base > 0.0 && radius.base.is_finite()) {
        return Err(Error::BadRadius { radius: radius.base }.into());
    }
    let convexity = curve.convexity(mesh)?;
    let edges = all_curves.iter().flat_map(|c| &c.halfedges).map(|&h| mesh.edge(h));
    let barriers: IdSet<EdgeId> = edges.chain(params.walls.iter().copied()).collect();
    let own: IdSet<EdgeId> = curve.halfedges.iter().map(|&h| mesh.edge(h)).collect();
    let ends = curve.ends(mesh);
    let mut alpha = params.alpha.max(wedge_alpha(mesh, curve));
    loop {
        let patch = |side| Patch::flood(mesh, curve, side, &barriers, alpha * radius.base, 0.5 * radius.base);
        let patches = [patch(Side::Left)?, patch(Side::Right)?];
        let footing = |c: &Contact| {
            let at_end = |e| !curve.closed && barriers.contains(&e) && !own.contains(&e);
            let on_curve = |e| barriers.contains(&e);
            // Beyond the plane square to an end; a curve that bends back comes there too, but farther off.
            let near = |at: DVec3| c.center.distance(at) < 3.0 * alpha * radius.base;
            let beyond = |(at, out): &(DVec3, DVec3)| near(*at).then(|| (c.center - *at).dot(*out));
            let past = ends.iter().filter_map(beyond).fold(f64::NEG_INFINITY, f64::max);
            let at_rim = |s: usize| on_rim(mesh, &patches[s], &barriers, &c.feet[s]);
            if past > alpha * radius.base
                || (0..2).any(|s| on_edge(mesh, &c.feet[s], at_end) || past > 0.0 && at_rim(s))
            {
                Footing::Over
            } else if (0..2).any(|s| on_edge(mesh, &c.feet[s], on_curve) && tips(mesh, convexity, c, s)) {
                Footing::Tipping
            } else if alpha < MAX_ALPHA && (0..2).any(at_rim) {
                Footing::AtRim
            } else {
                Footing::Firm
            }
        };
        let mut way = Vec::new();
        let traced = match &params.solver {
            Solver::Contact => march::trace(mesh, curve, convexity, &patches, params, footing, &mut way),
            Solver::Offset(offset) => {
                let base = offset::Base { patches: &patches, barriers: &barriers, alpha };
                offset::trace(mesh, curve, convexity, base, radius, params.step, offset)
            }
        };
        let traced = match traced {
            Ok(traced) => traced,
            Err(error) => {
                let balls = way.iter().map(|c| c.center).collect();
                return Err(Box::new(Halt { error, patches: Some(Arc::new(patches)), balls }));
            }
        };
        let (contacts, closed) = match traced {
            march::Trace::Closed(contacts) => (contacts, true),
            march::Trace::Open(contacts) => (contacts, false),
            march::Trace::RanOff => {
                alpha *= 1.6;
                continue;
            }
        };
        if let [only] = contacts[..] {
            let error = Error::Stuck { at: only.center, radius: only.radius, wanted: radius.base };
            return Err(Box::new(Halt { error, patches: Some(Arc::new(patches)), balls: vec![only.center] }));
        }
        let gaps = [1.5 * params.step, if params.longest > params.step { params.longest } else { 0.0 }];
        let fairing = fair::Fairing {
            fairness: params.fairness,
            gaps,
            softenings: &params.softenings,
            closed,
            ends: &ends,
            reach: 3.0 * alpha * radius.base,
        };
        let (samples, filled) = fair::fair(mesh, &patches, radius, &contacts, fairing);
        let fair = samples.len();
        let samples = regress::regress(&samples, closed, convexity, params.bridge * radius.base);
        let bridged = fair - samples.len();
        let samples = fair::fill_gaps(mesh, &patches, &samples, closed, gaps);
        let residual = contacts.iter().map(|c| c.residual).fold(filled, f64::max);
        return Ok(Rail { samples, closed, convexity, residual, bridged, alpha, patches: Arc::new(patches) });
    }
}

/// Beyond this reach the wedge is so sharp that a ball rolls half a dozen diameters away from the curve.
const MAX_ALPHA: f64 = 16.0;

/// A ball between planes that meet at normals φ apart touches them r·tan(φ/2) from the edge. The nineteenth
/// twentieth of the edges sets the reach, the rest is left to the check that no foot ran off.
fn wedge_alpha<M: Adjacency + Positions>(mesh: &M, curve: &BlendCurve) -> f64 {
    let mut tangents: Vec<f64> = curve
        .halfedges
        .iter()
        .filter_map(|&h| {
            let cosine = curve::face_normal(mesh, h).dot(curve::face_normal(mesh, mesh.twin(h)?));
            Some(((1.0 - cosine) / (1.0 + cosine).max(1e-3)).sqrt())
        })
        .collect();
    tangents.sort_by(f64::total_cmp);
    let typical = tangents.get(tangents.len() * 19 / 20).copied().unwrap_or(1.0);
    (1.3 * typical + 0.75).min(MAX_ALPHA)
}

/// Whether a foot lies on an edge beyond which the patch was cut off.
fn on_rim<M: Adjacency>(mesh: &M, patch: &Patch, barriers: &IdSet<EdgeId>, foot: &mesh_query::ClosestPoint) -> bool {
    (0..3).any(|corner| {
        let h = HalfedgeId::new(foot.face, corner);
        foot.barycentric[(corner + 2) % 3] == 0.0
            && !barriers.contains(&mesh.edge(h))
            && mesh.twin(h).is_some_and(|t| patch.faces.binary_search(&t.face()).is_err())
    })
}

/// Whether a foot lies on an edge of a kind.
fn on_edge<M: Adjacency>(mesh: &M, foot: &mesh_query::ClosestPoint, kind: impl Fn(EdgeId) -> bool) -> bool {
    (0..3)
        .any(|corner| foot.barycentric[(corner + 2) % 3] == 0.0 && kind(mesh.edge(HalfedgeId::new(foot.face, corner))))
}

/// Whether the ball has left the side that a patch faces: with its foot on a blend curve, it tips over that.
fn tips<M: Adjacency + Positions>(mesh: &M, convexity: Convexity, ball: &Contact, side: usize) -> bool {
    let foot = &ball.feet[side];
    let facing = curve::face_normal(mesh, HalfedgeId::new(foot.face, 0)).dot(ball.normals()[side]);
    TIPPING > if convexity == Convexity::Concave { facing } else { -facing }
}

/// Cosine of the angle between a patch's normal and the ball at which a ball that touches only the patch's edge is
/// taken to be leaving it: 60 degrees.
const TIPPING: f64 = 0.5;
